"""Heat of a run in its bearings: heat by part, temperatures, and changes of play and clearance.

Temperatures are those of `bearings.heat`, above the start, worked out when the run is over from the heat
that a bearing tells. With `thermal = 1` the bearing has worked out the same in the run, and its gaps
follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...bearings.heat import bodies, network
from ..coupling.connections import Attachment
from .final_state import Finished, ReadableSystem

PARTS = ("journal", "inner", "balls", "outer")  # as `bearings.heat.bodies` counts them
WORK = "contact.sliding_work"
MOST_STEPS = 2000  # rows of the recording that temperatures are followed over
SAME_STEP = 1e-9  # of a step, up to which its matrices serve the next
GEOMETRY = ("balls.", "ring.", "journal_radius", "clearance", "contact.length", "housing.inv_m")
THERMAL, PLAY = "thermal", "balls.play"
LATE = 0.1  # of a run, over which the growth of a preload is compared with that before
FASTER = 1.05  # ratio from which on it grows ever faster; scatter of the drag stays below
NOTED_PRELOAD = 2e-6  # m, from which on it is worth a word: the drag of a 6904 grows by 5 % per um
UM = 1e6


@dataclass(frozen=True)
class Warmed:
    """Temperatures of a bearing's parts above the start, from its heat."""

    bodies: bodies.Bodies
    time: np.ndarray  # s, (rows,)
    warmth: np.ndarray  # K, (rows, 5), journal, inner ring, balls, outer ring, housing
    adiabatic: np.ndarray  # K, (4,), at the end, if every part kept what it took
    capacities: np.ndarray  # J/K, (4,)

    @property
    def rise(self) -> np.ndarray:
        """The largest temperature of each part (K, (5,))."""
        return self.warmth.max(axis=0)

    @property
    def play(self) -> np.ndarray:
        """Change of the radial play (m, (rows,))."""
        return np.array([bodies.play_change(self.bodies, row) for row in self.warmth])

    @property
    def clearance(self) -> np.ndarray:
        """Change of the journal's radial clearance (m, (rows,))."""
        return np.array([bodies.clearance_change(self.bodies, row) for row in self.warmth])


def has_heat(system: ReadableSystem, a: Attachment) -> bool:
    """Whether a bearing tells its heat by part."""
    return all(f"{a.bearing}.heat.{part}" in system for part in PARTS)


def heat_of(system: ReadableSystem, a: Attachment) -> dict[str, float]:
    """Heat (J) that each part has taken by the end."""
    return {part: system.value(f"{a.bearing}.heat.{part}") for part in PARTS}


def warmed(run: Finished, a: Attachment) -> Warmed | None:
    """Temperatures of a bearing's parts over the recorded times; None where it is not known enough of it.

    Each lies between those of no conduction and of steady state; housing and shaft are `bearings.heat`'s.
    """
    own = _bodies_of(run.system, a)
    names = [f"{a.bearing}.heat.{part}" for part in PARTS]
    if own is None or not all(name in run.recording for name in names):
        return None
    rows = _chosen(len(run.recording.time))
    time = run.recording.time[rows]
    heat = np.stack([run.recording[name][rows] for name in names], axis=1)
    inverse, conductances = np.zeros(bodies.NODES), np.zeros((bodies.NODES, bodies.NODES))
    bodies.set_inverse_capacities(own, inverse)
    bodies.set_conductances(own, conductances)
    capacities = 1.0 / inverse[: len(PARTS)]
    warmth = _followed(inverse, conductances, time, heat)
    return Warmed(own, time, warmth, (heat[-1] - heat[0]) / capacities, capacities)


def _bodies_of(system: ReadableSystem, a: Attachment) -> bodies.Bodies | None:
    component = system.components[a.bearing]
    names = [n for n in component.variables if n.startswith(GEOMETRY)]
    try:
        return bodies.bodies_by(dict(zip(names, component.read(names), strict=True)))
    except KeyError:
        return None


def _chosen(rows: int) -> np.ndarray:
    """Which of the recorded `rows` temperatures are followed over, the first and the last among them."""
    return np.unique(np.linspace(0, rows - 1, min(rows, MOST_STEPS)).astype(int))


def _followed(
    inverse: np.ndarray, conductances: np.ndarray, time: np.ndarray, heat: np.ndarray
) -> np.ndarray:
    """Temperatures (K, (rows, 5)) of parts that took `heat` (J, (rows, 4)) by `time` (s, (rows,))."""
    nodes = len(inverse)
    warmth, kept, gained = np.zeros((len(time), nodes)), np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
    last, now, given = 0.0, np.zeros(nodes), np.zeros(nodes)
    for row in range(1, len(time)):
        step = time[row] - time[row - 1]
        if abs(step - last) > SAME_STEP * step:
            network.set_step(inverse, conductances, step, kept, gained)
            last = step
        given[: len(PARTS)] = heat[row] - heat[row - 1]
        network.take_step(kept, gained, given, now)
        warmth[row] = now
    return warmth


def heat_figures(run: Finished, a: Attachment) -> dict[str, object]:
    """Heat by part, work of sliding, highest temperatures, and largest changes of play and clearance.

    Figures of temperature are None where heat was not recorded; none of them of a bearing without balls.
    """
    if not has_heat(run.system, a):
        return {}
    figures: dict[str, object] = {
        f"bearing_heat_{part}_J": heat for part, heat in heat_of(run.system, a).items()
    }
    if f"{a.bearing}.{WORK}" in run.system:
        figures["bearing_sliding_work_J"] = run.system.value(f"{a.bearing}.{WORK}")
    if f"{a.bearing}.balls.count" not in run.system:
        return figures
    found = warmed(run, a)
    for k, part in enumerate(PARTS):
        figures[f"temperature_rise_{part}_K"] = None if found is None else float(found.rise[k])
        key = f"temperature_rise_{part}_adiabatic_K"
        figures[key] = None if found is None else float(found.adiabatic[k])
    figures["play_change_um"] = None if found is None else UM * largest(found.play)
    figures["clearance_change_um"] = None if found is None else UM * largest(found.clearance)
    return figures


@dataclass(frozen=True)
class Closing:
    """Play that temperatures have closed to a preload by the end of a run."""

    preload: float  # m, at the end
    rate: float  # m/s, at which it grows over the last part of the run
    rate_before: float  # m/s, over the part before

    @property
    def runs_away(self) -> bool:
        """Whether it is worth a word and grows ever faster: preload makes drag, and drag makes preload."""
        return self.preload > NOTED_PRELOAD and self.rate > FASTER * self.rate_before > 0.0


def closing(time: np.ndarray, play: np.ndarray) -> Closing | None:
    """How a radial play (m, (rows,)) over `time` (s) has closed; None where it has not."""
    if play[-1] >= 0.0:
        return None
    ends = time[-1] - LATE * (time[-1] - time[0]) * np.array([2.0, 1.0, 0.0])
    before, middle, end = np.interp(ends, time, play)
    span = float(ends[1] - ends[0])
    return Closing(-float(end), float(middle - end) / span, float(before - middle) / span)


def is_thermal(system: ReadableSystem, a: Attachment) -> bool:
    """Whether the gaps of a bearing follow its temperatures."""
    name = f"{a.bearing}.{THERMAL}"
    return name in system and system.value(name) == 1.0


def running_away(run: Finished, seats: Sequence[Attachment]) -> list[str]:
    """Lines on bearings whose drag and heat drive each other."""
    lines = []
    for a in seats:
        warm = warmed(run, a) if is_thermal(run.system, a) else None
        found = closing(warm.time, run.system.value(f"{a.bearing}.{PLAY}") + warm.play) if warm else None
        if found is not None and found.runs_away:
            lines.append(
                f"{a.bearing}: heat has closed its play to a preload of {UM * found.preload:.3g} um, which "
                f"grows by {UM * found.rate:.3g} um/s, faster than the {UM * found.rate_before:.3g} um/s "
                "before: preload brakes the balls, which warms them further, and it may run away; give it "
                "more play, less drag, or a mount that ends the whirl"
            )
    return lines


def largest(values: np.ndarray) -> float:
    """The one farthest from 0, with its sign; values: (rows,)."""
    return float(values[np.argmax(np.abs(values))])
