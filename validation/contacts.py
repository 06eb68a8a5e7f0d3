"""Contact: impacts, and the journal's strip in its bore."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import gamma

from ..bearings import angular_cageless, catalogue
from ..bearings.contact.laws import ContactLaw, elastic_and_damping, elastic_force
from ..bearings.contact.line import FROM_GEOMETRY, BoreContact, bore_approach
from ..bearings.contact.pair import damped_normal
from ..command.api.run import load, run
from ..master.scene.file import parse_scene
from ..master.scene.scene import Scene
from ..modelkit.instance import Instance
from ..modelkit.model import Model
from ..modelkit.variables import as_record
from .case import Row

Settings = dict[str, Any]
MASS = 1.65  # kg, of the dissertation's disk
SPEED = math.sqrt(2.0 * 9.81 * 0.3e-3)  # m/s, after a fall through its clearance
STIFFNESS = 2.4e9  # N/m^1.5


def started(model: Model, parameters: Mapping[str, float], inputs: Mapping[str, float]) -> Instance:
    """A bearing or a mount that is moved from outside, started; both by the names of its variables."""
    instance = Instance(model)
    for part, values in (("p", parameters), ("u", inputs)):
        for name, value in values.items():
            place: Any = instance.memory[part]
            *above, last = name.split(".")
            for group in above:
                place = place[group]
            place[last] = value
    instance.start(0.0)
    return instance


def rotor_on(bearing: str, rotor: Settings, settings: Settings, run: Settings) -> Scene:
    """A scene of a rigid rotor on a bearing."""
    parts = {"rotor": {"fmu": "rigid_rotor", "set": rotor}, "bearing": {"fmu": bearing, "set": settings}}
    title = f"a rotor on {bearing}"
    tables = {"attach": [["bearing.journal", "rotor.A"]], "run": run, "components": parts}
    return parse_scene({"title": title, **tables}, title, Path())


class _Impact(NamedTuple):
    """Deepest indentation (m), elastic force there (N), time in contact (s), speed out over speed in."""

    indentation: float
    force: float
    duration: float
    restitution: float


def _impact(law: ContactLaw, speed: float = SPEED) -> _Impact:
    """`MASS` lands at `speed` (m/s) on a rigid wall of a contact `law`, without its weight."""
    record = as_record(law)

    def motion(_: float, y: Any) -> list[float]:
        elastic, damping = elastic_and_damping(y[0], record)
        return [y[1], -damped_normal(elastic, damping, y[1], 0.0, 0.0) / MASS]

    def turns(_: float, y: Any) -> float:
        return y[1]

    def leaves(_: float, y: Any) -> float:
        return y[0]

    leaves.terminal, leaves.direction = True, -1.0  # type: ignore[attr-defined]
    run = solve_ivp(
        motion, (0.0, 0.1), [0.0, speed], method="DOP853", events=(turns, leaves),
        rtol=1e-12, atol=[1e-16, 1e-12], max_step=2e-5,
    )  # fmt: skip
    deepest = float(run.y_events[0][0][0])
    leaving = -float(run.y_events[1][0][1])
    return _Impact(deepest, elastic_force(deepest, record), float(run.t_events[1][0]), leaving / speed)


def hertz_impact() -> list[Row]:
    """The disk of 1.65 kg lands after a fall of 0.3 mm on k d^1.5, k = 2.4e9 N/m^1.5, by the contact law's
    kernel. Energy gives the depth, a beta function the duration."""
    found = _impact(ContactLaw(stiffness=STIFFNESS))
    depth = (5.0 * MASS * SPEED**2 / (4.0 * STIFFNESS)) ** 0.4
    factor = 2.0 * math.sqrt(math.pi) * gamma(1.4) / gamma(0.9)
    return [
        Row("largest force", "N", STIFFNESS * depth**1.5, found.force),
        Row("deepest indentation", "um", 1e6 * depth, 1e6 * found.indentation),
        Row("time in contact", "ms", 1e3 * factor * depth / SPEED, 1e3 * found.duration),
    ]


def restitution() -> list[Row]:
    """A body loses 2/3 e v of its speed on k d^n (1 + e d'), d' the speed of indentation, to first order,
    for any exponent n; e v = 1e-3."""
    lost, rows = 1e-3, []
    for name, n in (("10/9", 10.0 / 9.0), ("3/2", 1.5)):
        found = _impact(ContactLaw(stiffness=STIFFNESS, exponent=n, dissipation=lost / SPEED))
        rows.append(
            Row(f"loss of speed, n = {name}", "%", 200.0 / 3.0 * lost, 100.0 * (1.0 - found.restitution))
        )
    return rows


BORES = {name: catalogue.bearing(name) for name in ("6904", "6004")}
JOURNAL, CLEARANCE = 9.7e-3, 0.3e-3  # m


def bore_strip() -> list[Row]:
    """Half the width of the strip in which a journal of 9.7 mm radius, 350 N on 9 mm, touches a bore with
    0.3 mm of play: b^2 = 4 q R/(pi E*)."""
    relative = JOURNAL * (JOURNAL + CLEARANCE) / CLEARANCE
    modulus = 207e9 / (2.0 * (1.0 - 0.3**2))
    exact = math.sqrt(4.0 * 350.0 / 9e-3 * relative / (math.pi * modulus))
    law = BoreContact(length=BORES["6904"].width, depth=BORES["6904"].depth, load=350.0, law=FROM_GEOMETRY)
    found = bore_approach(350.0, as_record(law), JOURNAL, CLEARANCE)
    return [Row("half width of the strip", "mm", 1e3 * exact, 1e3 * found.half_width)]


GAP, DEPTH, TILT, SPIN = 0.15e-3, 20e-6, 1e-3, 1000.0  # m, m, rad, rad/s
FACE_RADIUS, FACE_STIFFNESS = 11.2e-3, 5e8  # m, N/m
THRUST: dict[str, object] = {  # on a lying shaft that is dropped at once; the bore touches in the middle
    "inclination": 0.0,
    "amb.shutdown_time": 0.0,
    "bearing.land": 0.0,
    "rotor.axial_load": -8.0,
    "rotor.bearing_position": 0.01,
    "run.duration": 0.12,
}


def _load_on_face(dissipation: float) -> Any:
    """Load on a rotor that spins, tilted about x, on a face without friction; dissipation: s/m."""
    face = {
        "gap_minus": GAP,
        "dissipation": dissipation,
        "radius": FACE_RADIUS,
        "stiffness": FACE_STIFFNESS,
    }
    parameters = {"gravity": 0.0, **{f"shoulder.{name}": value for name, value in face.items()}}
    parameters |= dict.fromkeys(("friction.static", "friction.dynamic", "friction.g6"), 0.0)
    journal = {"journal.z": -GAP - DEPTH, "journal.rx": TILT, "journal.omega": SPIN}
    instance = started(angular_cageless.MODEL, parameters, journal)
    m = instance.record
    q = m["q"][: int(m["n"])].copy()
    angular_cageless.instant(0.0, q, np.zeros_like(q), instance.words)
    return m["o"]["journal"]


def tilted_face() -> list[Row]:
    """Pressed in by d = 20 um and tilted by a = 1 mrad at 1000 rad/s on 5e8 N/m around 11.2 mm, 0.15 mm
    from the seat: k d along the shaft, k a (R^2/2 - 0.15 mm d) against the tilt. Then a disk lands on a
    pair without a cage, 10 mm off its centre, under 8 N of thrust: energy balance within 0.12 s."""
    moment = FACE_STIFFNESS * TILT * (0.5 * FACE_RADIUS**2 - GAP * DEPTH)
    plain, damped = _load_on_face(0.0), _load_on_face(5.0)
    result = run(load("disk-upright-cageless").set(THRUST), in_process=True)
    parts = (f"energy.{part}" for part in ("kinetic", "potential", "dissipated"))
    crossed = (f"{end}.{part}" for end in ("journal", "housing") for part in ("work", "jump"))
    energy = np.sum([result.data[f"bearing.{name}"] for name in (*parts, *crossed)], axis=0)
    heat = float(result.data["bearing.energy.dissipated"][-1])
    energy_error = float(np.max(np.abs(energy - energy[0]))) / (result.summary["energy_turnover"] + heat)
    return [
        Row("force along the shaft", "N", FACE_STIFFNESS * DEPTH, float(plain["fz"])),
        Row("moment", "N m", moment, math.hypot(plain["mx"], plain["my"])),
        Row("moment, dissipation 5 s/m", "N m", moment, math.hypot(damped["mx"], damped["my"])),
        Row("energy within 0.12 s", "1", 1.0, 1.0 + energy_error, tolerance=1e-4),
    ]
