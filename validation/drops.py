"""Drops: in another program for many bodies, and along the wall of a bore by closed form."""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ..bearings import detailed_cageless
from ..command.api.run import run
from ..master.common.errors import Ended
from ..master.scene.file import load_scene
from .case import Row
from .contacts import rotor_on, started

DISSERTATION_FITS = 1  # balls.hertz: elliptic integrals by the dissertation's approximation


def exudyn_drop() -> list[Row]:
    """1.65 kg at 9000 rpm, 1 um before it touches, on the detailed cageless bearing: peaks within 20 ms and
    speeds then, in one macro step that carries disk and housing."""
    journal = {"y": -0.299e-3, "vy": -0.0766, "omega": 942.478, "ay_free": -9.81}
    journal |= {"inv_m": 1.0 / 1.65, "inv_I": 2000.0}
    housing = {"inv_m": 1 / 5.02, "k_over_m": 2.5e8 / 5.02, "c_over_m": 2500 / 5.02, "ay_free": -9.81}
    inputs = {f"journal.{name}": value for name, value in journal.items()}
    inputs |= {f"housing.{name}": value for name, value in housing.items()}
    instance = started(detailed_cageless.MODEL, {"balls.hertz": DISSERTATION_FITS}, inputs)
    instance.step(0.0, 0.02)
    o: Any = instance.record["o"]
    return [
        Row("disk on ring, peak force", "N", 354.71, float(o["contact"]["peak_force"])),
        Row("disk on ring, indentation", "um", 27.937, 1e6 * float(o["contact"]["peak_indentation"])),
        Row("ball on inner race", "um", 2.748, 1e6 * float(o["inner"]["peak_indentation"])),
        Row("ball on outer race", "um", 2.678, 1e6 * float(o["outer"]["peak_indentation"])),
        Row("ball on ball", "um", 28.336, 1e6 * float(o["neighbours"]["peak_indentation"]), tolerance=0.04),
        Row("disk's speed, 20 ms", "rad/s", 941.57, float(o["ring"]["journal_speed"]) / 9.7e-3),
        Row("ring's speed, 20 ms", "rad/s", 318.03, float(o["ring"]["omega"]), tolerance=0.03),
    ]


CLEARANCE, FRICTION, GRAVITY = 0.3e-3, 0.15, 9.81  # m, 1, m/s2
WALL = 1e12  # N/m^1.5, so hard that the wall hardly gives


def _along_the_wall(rate: float, gravity: float, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and backward angle from the bottom (rad) of a disk that starts there at a rate (rad/s)."""
    rotor = {"speed": "90000 rpm", "gravity": gravity, "y": -CLEARANCE, "vx": -rate * CLEARANCE}
    hard = {"contact.stiffness": WALL, "contact.damping": 0.0, "contact.dissipation": 1.0}
    hard |= {"clearance": CLEARANCE, "friction.kind": "coulomb", "friction.slope": 1e3}
    hard |= dict.fromkeys(("friction.static", "friction.dynamic"), FRICTION)
    steps = {"duration": duration, "macro_step": 2e-5, "record_every": 1}
    scene = rotor_on("bushing", rotor, hard, steps)
    data = run(scene, in_process=True).data
    x, y = (np.asarray(data[f"rotor.A.{axis}"]) for axis in "xy")
    return np.asarray(data["time"]), np.unwrap(np.arctan2(-x, -y))


def _turning_angle() -> float:
    """Where a disk that slides up a bore from rest at its bottom turns back (rad)."""
    over = 1.0 + 4.0 * FRICTION**2
    a, b = 2.0 * (1.0 - 2.0 * FRICTION**2) / over, 6.0 * FRICTION / over

    def climb(phi: float) -> float:
        return a * math.cos(phi) + b * math.sin(phi) - a * math.exp(2.0 * FRICTION * phi)

    found: Any = brentq(climb, 0.1, 1.0)
    return float(found)


def bore_climb() -> list[Row]:
    """A disk slides at 90 000 rpm on the bottom of a bore, clearance 0.3 mm, friction 0.15, from rest: how
    far up it turns back, in a drop on `bushing`."""
    _, angle = _along_the_wall(0.0, GRAVITY, 0.02)
    return [Row("turns back at", "deg", math.degrees(_turning_angle()), math.degrees(float(angle.max())))]


def bore_whirl() -> list[Row]:
    """The same without gravity, going round at 200 rad/s at first: a backward whirl that its own force
    drives. Angle after 10 and 20 ms."""
    start = 200.0
    time, angle = _along_the_wall(start, 0.0, 0.02)
    rows = []
    for when in (0.01, 0.02):
        exact = -math.log(1.0 - FRICTION * start * when) / FRICTION
        rows.append(
            Row(f"gone round in {1e3 * when:g} ms", "rad", exact, float(np.interp(when, time, angle)))
        )
    return rows


def _landed(arrangement: str, towards: float) -> tuple[bool, float]:
    """Whether an upright disk that falls towards +z or -z stops its run, and the rows' thrust (N)."""
    scene = load_scene("disk-upright-pair").set(
        {
            "bearing.arrangement": arrangement, "bearing.preload": 0.0, "run.duration": "12 ms",
            "bearing.balls.rows": 1 if "single" in arrangement else 2,
            "inclination": f"{-90.0 * towards:g} deg",
            "bearing.shoulder.gap_minus": "0.15 mm" if towards < 0.0 else 0.0,
            "bearing.shoulder.gap_plus": "0.15 mm" if towards > 0.0 else 0.0,
        }
    )  # fmt: skip
    result = run(scene, in_process=True)
    return result.ended is Ended.STOPPED, float(np.abs(result.data["bearing.along.force"]).max())


def open_side() -> list[Row]:
    """The disk of `disk-upright-pair` falls on a single row and on a tandem pair, each either way round,
    towards either side: only a run whose row comes off stops."""
    found = {way: _landed(*way) for way in product(("single", "tandem"), (1.0, -1.0))}
    turned = {way: _landed(f"{way[0]} reversed", way[1]) for way in found}
    wrong = [found[kind, -1.0] for kind in ("single", "tandem")]
    wrong += [turned[kind, 1.0] for kind in ("single", "tandem")]
    stops = sum(stopped for stopped, _ in (*found.values(), *turned.values()))
    return [
        Row("stops, of eight landings", "1", 4, stops),
        Row("stops, of four on the open side", "1", 4, sum(stopped for stopped, _ in wrong)),
        Row("largest thrust, single", "N", found["single", 1.0][1], turned["single", -1.0][1]),
        Row("largest thrust, tandem", "N", found["tandem", 1.0][1], turned["tandem", -1.0][1]),
    ]
