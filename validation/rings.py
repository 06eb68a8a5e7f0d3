"""Rings that bend, that grow by their spin, and that heat clamps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..bearings import angular_simplified, catalogue
from ..bearings.angular import hoop
from ..bearings.angular.angular_row import BallRow, outwards_at_rest
from ..bearings.catalogue.load_sharing import ball_loads, inner_groove
from ..bearings.catalogue.spinning import spun
from ..bearings.contact.materials import STEEL_NUMBERS
from ..bearings.heat import warm_parts
from ..bearings.rolling.ball_set import BallSet, RaceStiffness, set_stiffness
from ..bearings.rolling.bending import Groove, compliance, frequency, section_of
from ..command.api.run import run
from ..master.results.result import Result
from ..master.scene.scene import Scene
from ..modelkit.variables import as_record
from .case import Row
from .contacts import rotor_on

MODULUS, POISSON, DENSITY = 207e9, 0.3, 7830.0
WIDTH, HEIGHT = 5e-3, 2e-3  # m
THIN = section_of(Groove(0.099, 0.1, 0.101, WIDTH, 1.0, 0))


def ring_two_loads() -> list[Row]:
    """A rectangle of 5 mm by 2 mm at a radius of 0.1 m: how the diameter changes under the loads and
    across."""
    unit = THIN.radius**3 / (MODULUS * WIDTH * HEIGHT**3 / 12.0)
    terms = {n: 4.0 * compliance(THIN, n, MODULUS, POISSON) / unit for n in range(2, 60, 2)}
    across = sum(-((-1.0) ** (n // 2)) * c for n, c in terms.items())
    return [
        Row("under the loads", "P R^3/(E I)", math.pi / 4.0 - 2.0 / math.pi, sum(terms.values())),
        Row("across", "P R^3/(E I)", 2.0 / math.pi - 0.5, across),
    ]


def ring_frequencies() -> list[Row]:
    """In-plane bending of the same ring with 2, 3 and 4 waves around it."""
    inertia, area = WIDTH * HEIGHT**3 / 12.0, WIDTH * HEIGHT
    unit = MODULUS * inertia / (DENSITY * area * THIN.radius**4)
    return [
        Row(
            f"{n} waves",
            "Hz",
            math.sqrt(unit * n**2 * (n**2 - 1) ** 2 / (n**2 + 1)) / (2.0 * math.pi),
            frequency(THIN, n, MODULUS, POISSON, DENSITY) / (2.0 * math.pi),
        )
        for n in (2, 3, 4)
    ]


def ring_elements() -> list[Row]:
    """Lowest frequency of the 6904's and 6004's inner rings, and the load of the most loaded ball under
    350 N, 40 harmonics."""
    rows = []
    for name, kilohertz, load in (("6904", 12.88, 133.03), ("6004", 15.24, 222.96)):
        bearing = catalogue.bearing(name)
        section = section_of(inner_groove(bearing))
        found = frequency(section, 2, MODULUS, POISSON, DENSITY) / (2e3 * math.pi)
        rows += [
            Row(f"{name}, lowest frequency", "kHz", kilohertz, found),
            Row(f"{name}, most loaded ball", "N", load, float(ball_loads(bearing, 350.0, 40, 0.0).max())),
        ]
    return rows


def ring_growth() -> list[Row]:
    """Of the 6904's and the 6014's inner rings, bore and race on radius, at 18 000 rpm."""
    rows, speed = [], 18000.0 * math.pi / 30.0
    for name, bore, race in (("6904", 10e-3, 11.85e-3), ("6014", 35e-3, None)):
        bearing = catalogue.bearing(name)
        edge = race or 0.5 * (bearing.balls.pitch_diameter - bearing.balls.diameter)
        found = spun(bearing, speed)
        for what, r, s, ours in (("bore", bore, edge, found.bore), ("race", edge, bore, found.race)):
            grown = (3.0 + POISSON) * s * s + (1.0 - POISSON) * r * r
            exact = DENSITY * speed**2 * r / (4.0 * MODULUS) * grown
            rows.append(Row(f"{name}, {what}", "um", 1e6 * exact, 1e6 * ours))
    return rows


COUNT, ANGLE, PRESS = 22, math.radians(25.0), 1000.0  # balls of a 71909's size; rad; N
BORE, RACE, FAR, RIM, WIDE = 22.5e-3, 25.1e-3, 31.6e-3, 34e-3, 12e-3  # m, of its rings


def _hooped(seat: int) -> Any:
    """Parameters of a bearing with these rings, the outer one in its `seat`."""
    p = as_record(angular_simplified.Parameters())
    p["journal_radius"], p["clearance"], p["ring"]["width"] = BORE - 1e-4, 1e-4, WIDE
    p["balls"]["count"], p["balls"]["diameter"], p["balls"]["pitch_diameter"] = (
        COUNT,
        FAR - RACE,
        FAR + RACE,
    )
    p["outer_ring"]["seat"], p["outer_ring"]["thickness"] = seat, RIM - FAR
    return p


def _lame(inside: float, outside: float, sign: float) -> float:
    """(b^2 + a^2)/(b^2 - a^2) -+ nu."""
    return (outside**2 + inside**2) / (outside**2 - inside**2) + sign * POISSON


def ring_hoop() -> list[Row]:
    """22 balls of 1000 N at 25 deg press an inner ring of 45 mm by 50.2 mm together, 12 mm wide, and a
    loose outer ring of 63.2 mm by 68 mm apart."""
    push = COUNT * PRESS * math.cos(ANGLE)
    inner, outer = push / (2.0 * math.pi * RACE * WIDE), push / (2.0 * math.pi * FAR * WIDE)
    held, loose = (hoop.hoop_compliance(_hooped(seat)).race for seat in (hoop.HELD, hoop.LOOSE))
    closed = inner * RACE / MODULUS * _lame(BORE, RACE, -1.0)
    opened = outer * FAR / MODULUS * _lame(FAR, RIM, 1.0)
    stress, ours = inner * (1.0 + _lame(BORE, RACE, 0.0)), -hoop.bore_stress(BORE, RACE, inner)
    ratio = 2.0 * BORE * RACE / (RACE**2 - BORE**2) / _lame(BORE, RACE, -1.0)  # of both radii's ways
    share = closed / (closed + opened)
    ours_bore = [hoop.hoop_compliance(_hooped(seat)).bore for seat in (hoop.HELD, hoop.LOOSE)]
    return [
        Row("bore over race, outer ring held", "1", ratio, ours_bore[0]),
        Row("the same, outer ring loose", "1", ratio * share, ours_bore[1]),
        Row("inner race, radius", "um", 1e6 * closed, 1e6 * held * push),
        Row("outer race", "um", 1e6 * opened, 1e6 * (loose - held) * push),
        Row("hoop stress at the bore", "MPa", 1e-6 * stress, 1e-6 * ours),
    ]


def ring_interference() -> list[Row]:
    """Load of a ball between these rings, pressed over the balls by a radial interference; the stiffness of
    both contacts is 5e9 N/m^1.5, the angle is held at 25 deg."""
    theirs = {
        "stiff rings": (136.422, 385.859, 1434.65),
        "inner ring gives": (111.394, 293.593, 970.492),
        "both give": (87.577, 217.486, 661.984),
    }
    compliances = (0.0, *(hoop.hoop_compliance(_hooped(seat)).race for seat in (hoop.HELD, hoop.LOOSE)))
    rows, along = [], math.cos(ANGLE)
    for (label, loads), give in zip(theirs.items(), compliances, strict=True):
        # a deep groove's row closes as this one does where its way and load are those outwards
        for micrometres, load in zip((10.0, 20.0, 48.0), loads, strict=True):
            row = BallRow(1e-6 * micrometres, 0.0, 0.0, 0.0, 0.0, 5e9 * along**2.5, *(0.0,) * 4)
            closed = hoop.closed_at_rest((row,), COUNT, give)
            found = outwards_at_rest(row, closed) / along
            rows.append(Row(f"{micrometres:g} um, {label}", "N", load, found))
    return rows


MASS, GRAVITY, SPUN = 8.0, 9.81, 1200.0 * math.pi  # kg, m/s2, rad/s
CLEARANCE, JOURNAL, FRICTION, RESISTANCE = 0.3e-3, 9.7e-3, 0.1, 0.004
LIGHT, RING_INERTIA = 800.0, 1e-7  # kg/m3 of the balls, kg m2
GEOMETRY = (
    *("journal_radius", "clearance", "contact.length", "balls.pitch_diameter", "balls.diameter"),
    *("balls.count", "balls.density", "ring.mass"),
)


def seizing_scene() -> Scene:
    """A rotor of 8 kg on a bearing clamped by 3 um, whose parts are so light that heat closes it fast."""
    bearing: dict[str, Any] = {
        "balls.play": -3e-6, "balls.density": LIGHT, "ring.mass": 6e-3, "ring.inertia": RING_INERTIA,
        "rolling.f1": 0.0, "rolling.resistance": RESISTANCE, "thermal": 1,
        "friction.kind": 0, "friction.dynamic": FRICTION, "clearance": CLEARANCE,
        "journal_radius": JOURNAL, "contact.dissipation": 1.0,
    }  # fmt: skip
    rotor = {"mass": MASS, "inertia": 0.02, "speed": SPUN, "y": -CLEARANCE}
    recorded = {"duration": 0.6, "macro_step": 5e-5, "record_every": 10, "record_also": ["bearing.gaps"]}
    return rotor_on("simplified_caged", rotor, bearing, recorded)


def _preload_at_seizure(result: Result) -> float:
    """Preload (m) at which the balls' drag has slowed the ring by a tenth, in closed form.

    The ring lets go of the journal where the drag is the most that friction can hold, M = mu m g R. From
    there on heat at the power M w goes on closing the balls, so that M grows evenly in time, and the ring
    with what turns with it falls behind with the square of time.
    """
    b = BallSet(density=LIGHT)
    stiffness, pitch = as_record(RaceStiffness()), 0.5 * b.pitch_diameter
    set_stiffness(stiffness, as_record(b), STEEL_NUMBERS)
    orbit = 0.5 * (1.0 - b.diameter / b.pitch_diameter)  # of the balls, over the ring's spin
    balls = b.count * LIGHT * math.pi / 6.0 * b.diameter**3
    inertia = RING_INERTIA + 1.4 * balls * (pitch * orbit) ** 2  # 7/5 m v^2/2 of a ball that rolls
    bore = JOURNAL + CLEARANCE
    speed, held = SPUN * JOURNAL / bore, FRICTION * MASS * GRAVITY * bore
    load = 0.5 * (held / (RESISTANCE * pitch * orbit) - balls * pitch * (orbit * speed) ** 2)
    preload = (load / (b.count * float(stiffness["series"]))) ** (2.0 / 3.0)
    values = {name: result.ending.value(f"bearing.{name}") for name in GEOMETRY}
    parts, inverse = warm_parts.bodies_by(values), np.zeros(warm_parts.NODES)
    warm_parts.set_inverse_capacities(parts, inverse)
    shares = np.array([0.0, 0.25, 0.5, 0.25, 0.0])
    closing = -warm_parts.play_change(parts, held * speed * shares * inverse)  # m/s
    growing = 1.5 * held * closing / preload  # N m/s
    lag = math.sqrt(2.0 * 0.1 * speed * inertia / growing)
    return preload + closing * lag


def ring_seizure() -> list[Row]:
    """A rotor lies on a bearing whose drag and heat drive each other until its ring seizes: preload then,
    and heat in the bore from its standstill on."""
    result = run(seizing_scene(), in_process=True)
    time, seat = result.recording.time, result.summary["seats"]["A"]
    seized, stopped = seat["seized_time"], seat["ring_stop_time"]
    preload = -np.interp(seized, time, result.recording["bearing.gaps.play"])
    standing = time >= stopped
    heat = 2.0 * np.ptp(result.recording["bearing.heat.journal"][standing])
    way = JOURNAL * float(np.trapezoid(result.recording["rotor.A.omega"][standing], time[standing]))
    return [
        Row("preload as it seizes", "um", 1e6 * _preload_at_seizure(result), 1e6 * float(preload)),
        Row("heat of sliding in the ring at rest", "J", FRICTION * MASS * GRAVITY * way, float(heat)),
    ]
