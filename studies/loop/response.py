"""What the unbalance makes of closed loops over the rotor's speed, beside the room that is there.

At a place the orbit is an ellipse; its size is its larger half-axis. Zones of vibration at the sensors as
they are quoted of ISO 14839-2:2004, of the least radial clearance: A below 0.3, B to 0.4, C to 0.5, D
above. The text of the standard was not at hand. Stators are fixed in space; currents and voltages are those
right after a sample, where the voltage is largest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize_scalar

from ...master.coupling.simulation import opened
from ...master.scene.scene import Scene
from .linear_loops import Loops, Sampled, growing

if TYPE_CHECKING:
    import pandas

UP_TO = 1.5  # of the scene's speed
COUNT = 150  # speeds, before those at resonances
BESIDE = (-3.0, -1.0, -0.3, 0.3, 1.0, 3.0)  # damping ratios that speeds stand beside a resonance
ZONES = ((0.3, "A"), (0.4, "B"), (0.5, "C"))
WORST = "D"
CLEARANCE = "clearance"  # m, a parameter of touchdown bearings
GAP = "magnet.gap"  # m, a parameter of magnetic bearings with coils


@dataclass(frozen=True)
class Place:
    """Where an orbit is looked at."""

    name: str
    shape: np.ndarray  # (n,), 1/kg^0.5, of the rotor there
    room: float  # m, that the rotor has there; 0: not known
    is_sensor: bool = False


@dataclass(frozen=True)
class UnbalanceResponse:
    """Amplitudes over the speed, nan where the loops are unstable; orbits by their larger half-axis."""

    speeds: np.ndarray  # (n,), rad/s, rising; the rotor turns as the scene has it, either way
    places: tuple[Place, ...]
    orbits: np.ndarray  # (n, places), m
    axes: tuple[str, ...]  # none of loops without coils
    currents: np.ndarray  # (n, axes), A, of the control current
    voltages: np.ndarray  # (n, axes), V, of the coil with the larger one

    def at(self, speed: float, values: np.ndarray) -> np.ndarray:
        """Those of `values` (n, ...) at the speed nearest to one (rad/s)."""
        return values[int(np.argmin(np.abs(self.speeds - speed)))]

    def to_pandas(self) -> pandas.DataFrame:
        """Columns by place (m) and by axis (A, V) over the speed (rad/s)."""
        import pandas

        columns = {f"orbit_m {one.name}": self.orbits[:, k] for k, one in enumerate(self.places)}
        columns |= {f"current_A {name}": self.currents[:, k] for k, name in enumerate(self.axes)}
        columns |= {f"voltage_V {name}": self.voltages[:, k] for k, name in enumerate(self.axes)}
        return pandas.DataFrame(columns, index=pandas.Index(self.speeds, name="speed"))


def zone(share: float) -> str:
    """Of an orbit at a sensor, over the least clearance: A, B, C or D; none of loops that are unstable."""
    if math.isnan(share):
        return ""
    return next((name for limit, name in ZONES if share < limit), WORST)


def unbalance_response(scene: Scene, loops: Loops, highest: float = 0.0) -> UnbalanceResponse | None:
    """Over speeds up to `highest` (rad/s; 0: `UP_TO` times the scene's); None of a balanced rotor.

    All peaks are among the speeds: at resonances, and at summits between the others.
    """
    highest = highest or UP_TO * abs(loops.speed)
    if highest == 0.0 or not np.any(loops.rotor.unbalance):
        return None
    places = _places(scene, loops)
    speeds = np.linspace(0.0, highest, COUNT + 1)[1:]
    turns = math.copysign(1.0, loops.speed)
    poles = [np.sort(np.imag(loops.closed(turns * speed).poles)) for speed in speeds]
    speeds = np.union1d(speeds, [abs(loops.speed), *_resonances(loops, speeds, poles)])
    rows = {float(speed): _row(loops, places, float(speed)) for speed in speeds if speed <= highest}
    table = np.array(list(rows.values()))
    for column in range(table.shape[1]):
        for k in _summits(table[:, column]):
            ends = list(rows)[k - 1], list(rows)[k + 1]
            found: Any = minimize_scalar(
                lambda speed, column=column: -_row(loops, places, speed)[column],
                bounds=ends, method="bounded", options={"xatol": 1e-6 * ends[1]},
            )  # fmt: skip
            rows[float(found.x)] = _row(loops, places, float(found.x))
        rows = dict(sorted(rows.items()))
        table = np.array(list(rows.values()))
    axes = loops.names if isinstance(loops, Sampled) else ()
    orbits, currents, voltages = np.split(table, [len(places), len(places) + len(axes)], axis=1)
    return UnbalanceResponse(np.array(list(rows)), places, orbits, axes, currents, voltages)


def _places(scene: Scene, loops: Loops) -> tuple[Place, ...]:
    """Sensors and magnets, touchdown bearings, and gaps across the shaft."""
    rotor, found = loops.rotor, list[Place]()
    with opened(scene, in_process=True, listening=False) as system:
        held = {a.bearing: a.body_port for a in system.attachments if a.on_journal}
        known = {name: f"{name}.{CLEARANCE}" for name in held}
        rooms = {name: system.value(key) for name, key in known.items() if key in system}
        least = min(rooms.values(), default=0.0)
        for k, name in enumerate(loops.bearing_names):
            gap = system.value(f"{name}.{GAP}") if f"{name}.{GAP}" in system else 0.0
            found += [
                Place(f"{name}, sensor", rotor.sees[k], least, is_sensor=True),
                Place(f"{name}, magnets", rotor.acts[k], gap),
            ]
    found += [Place(name, rotor.ports[held[name]], room) for name, room in rooms.items()]
    gaps = [(gap, gap.at.rpartition(".")[2]) for gap in scene.gaps if gap.axial is None]
    found += [Place(gap.name, rotor.ports[p], gap.size) for gap, p in gaps if p in rotor.ports]
    return tuple(found)


def _resonances(loops: Loops, speeds: np.ndarray, poles: list[np.ndarray]) -> Iterator[float]:
    """Speeds (rad/s) at and beside those where a pole turns as fast as the rotor."""
    for k in range(len(speeds) - 1):
        both = min(len(poles[k]), len(poles[k + 1]))
        before, after = (poles[j][-both:] - speeds[j] for j in (k, k + 1))
        for j in np.flatnonzero((before > 0.0) != (after > 0.0)):
            at = speeds[k] + (speeds[k + 1] - speeds[k]) * before[j] / (before[j] - after[j])
            near = loops.closed(math.copysign(at, loops.speed)).poles
            pole = near[np.argmin(np.abs(np.imag(near) - at))]
            width = min(abs(pole.real) / max(abs(pole), 1e-300), 0.1)
            yield from (float(at * (1.0 + share * width)) for share in (*BESIDE, 0.0))


def _row(loops: Loops, places: tuple[Place, ...], speed: float) -> np.ndarray:
    """Orbits (m), control currents (A), coil voltages (V) at a speed (rad/s); nan of unstable loops."""
    rotor = loops.rotor
    speed = math.copysign(speed, loops.speed)
    if growing(loops.closed(speed).poles) is not None:
        return np.full(len(places) + (2 * len(loops.names) if isinstance(loops, Sampled) else 0), math.nan)
    state = loops.swing(speed, speed, rotor.turning(speed))
    x, y = state[: rotor.places].reshape(2, -1) @ np.array([one.shape for one in places]).T
    orbits = 0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y))
    if not isinstance(loops, Sampled):
        return orbits
    voltages = [np.abs(volts).max(initial=0.0) for _, volts in loops.electrical(state)]
    return np.concatenate([orbits, np.abs(loops.control(state)), voltages])


def _summits(values: np.ndarray) -> np.ndarray:
    """Rows of a column (n,) that are larger than both beside them."""
    inner = values[1:-1]
    return np.flatnonzero((inner > values[:-2]) & (inner > values[2:])) + 1
