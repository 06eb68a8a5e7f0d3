"""Heat of a run in its bearings: temperatures, gaps, and whether a bearing seizes or heat runs away.

Temperatures are those of `bearings.heat`, above the start, worked out when the run is over from the heat
that a bearing tells. With `thermal = 1` the bearing has worked out the same in the run, and its gaps
follow.

Recordings may be thinned, so that events are told from speeds, whose changes last, and from heat, which
adds up over rows that are left out:

seized      an inner ring that rolled with the journal (`SYNCHRONOUS`) falls behind it to half its speed,
            and friction in the bore meanwhile does the work that would bring the ring back: I w^2/2, w by
            how much it is slower. Friction's work is that of sliding times the dynamic coefficient, since
            a ring that is behind slides fast; the heat of damping does not count. A ring that coasts
            while the journal flies, or floats again, has no such friction, and one that is spun up again
            by a later bounce is not slowed any more
runs away   heat makes a preload that grows ever faster: from `NOTED_PRELOAD` on, the rate from one level to
            the next, `STEP` times as high, rises by `FASTER` and more, `RISES` times in a row. Even heat
            makes a rate that stays, heat that flows off one that falls; a whirl that sets in raises it once
used up     a radial play or clearance that there was at the start is closed by heat and spin
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...bearings.heat import network, warm_parts
from ...bearings.heat.flash import damage
from ...modelkit.kernel import interpret
from ..common.text import RPM, UM, percent
from ..coupling.connections import Attachment
from ..quantities import CONTACT_TEMPERATURE, HEAT_PARTS
from .final_state import Finished, ReadableSystem

PARTS = (*HEAT_PARTS,)  # as `bearings.heat.warm_parts` counts them
WORK = "contact.sliding_work"
MOST_STEPS = 2000  # rows of the recording that temperatures are followed over
STEP_DIGITS = ".9e"  # to which steps are of one length
GEOMETRY = ("balls.", "ring.", "heat.", "journal_radius", "clearance", "contact.length", "housing.inv_m")
THERMAL, PLAY, CLEARANCE, ANGLE = "thermal", "gaps.play", "gaps.clearance", "balls.contact_angle"
SYNCHRONOUS, BEHIND, HALF, STILL = 0.99, 0.9, 0.5, 0.01  # speed of the ring over that of rolling
ROCKING = 10.0  # rad/s, by which a ring that seizes lags at least: a rotor at rest rocks in its own
AT_REST = 0.01  # of the journal's largest speed; slower, it may stand
NOTED_PRELOAD = 2e-6  # m, from which on it is worth a word: the drag of a 6904 grows by 5 % per um
STEP, RISES = 1.25, 3
FASTER = 1.05  # scatter of the drag stays below


@dataclass(frozen=True)
class Warmed:
    """Temperatures of a bearing's parts above the start, from its heat."""

    bodies: warm_parts.Bodies
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
        return np.array([interpret(warm_parts.play_change, self.bodies, row) for row in self.warmth])

    @property
    def clearance(self) -> np.ndarray:
        """Change of the journal's radial clearance (m, (rows,))."""
        return np.array([interpret(warm_parts.clearance_change, self.bodies, row) for row in self.warmth])


def has_heat(system: ReadableSystem, a: Attachment) -> bool:
    """Whether a bearing tells its heat by part."""
    return all(f"{a.bearing}.heat.{part}" in system for part in PARTS)


def warmed(run: Finished, a: Attachment) -> Warmed | None:
    """Temperatures of a bearing's parts over the recorded times; None where it is not known enough of it.

    Each lies between those of no conduction and of steady state; housing and shaft are `bearings.heat`'s.
    """
    bodies = _bodies_of(run.system, a)
    names = [f"{a.bearing}.heat.{part}" for part in PARTS]
    if bodies is None or not all(name in run.recording for name in names):
        return None
    time, every = run.recording.time, len(run.recording.time)
    rows = np.unique(np.linspace(0, every - 1, min(every, MOST_STEPS)).astype(int))
    time = time[rows]
    heat = np.stack([run.recording[name][rows] for name in names], axis=1)
    inverse, conductances = np.zeros(warm_parts.NODES), np.zeros((warm_parts.NODES, warm_parts.NODES))
    interpret(warm_parts.set_inverse_capacities, bodies, inverse)
    interpret(warm_parts.set_conductances, bodies, conductances)
    capacities = 1.0 / inverse[: len(PARTS)]
    warmth = _followed(bodies, inverse, conductances, time, heat)
    return Warmed(bodies, time, warmth, (heat[-1] - heat[0]) / capacities, capacities)


def _bodies_of(system: ReadableSystem, a: Attachment) -> warm_parts.Bodies | None:
    component = system.components[a.bearing]
    names = [n for n in component.variables if n.startswith(GEOMETRY)]
    try:
        return warm_parts.bodies_by(dict(zip(names, component.read(names), strict=True)))
    except KeyError:
        return None


def _followed(
    bodies: warm_parts.Bodies,
    inverse: np.ndarray,
    conductances: np.ndarray,
    time: np.ndarray,
    heat: np.ndarray,
) -> np.ndarray:
    """Temperatures (K, (rows, 5)) of parts that took `heat` (J, (rows, 4)) by `time` (s, (rows,))."""
    nodes = len(inverse)
    warmth, rise, inflow = np.zeros((len(time), nodes)), np.zeros(nodes), np.zeros(nodes)
    interpret(warm_parts.set_surroundings, bodies, rise, inflow)
    warmth[0] = rise
    matrices: dict[str, tuple[np.ndarray, np.ndarray]] = {}  # by length of step, rounded as `STEP_DIGITS`
    for row in range(1, len(time)):
        step = time[row] - time[row - 1]
        length = f"{step:{STEP_DIGITS}}"
        if length not in matrices:
            matrices[length] = np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
            interpret(network.set_step, inverse, conductances, step, *matrices[length])
        added = inflow * step
        added[: len(PARTS)] += heat[row] - heat[row - 1]
        interpret(network.take_step, *matrices[length], added, rise)
        warmth[row] = rise
    return warmth


def heat_quantities(run: Finished, a: Attachment) -> dict[str, Any]:
    """Heat by part, work of sliding, highest temperatures, largest changes of gaps, and events.

    Temperatures are None where heat was not recorded; a bearing without balls has none of them.
    """
    if not has_heat(run.system, a):
        return {}
    values: dict[str, Any] = {
        f"bearing_heat_{part}": run.system.value(f"{a.bearing}.heat.{part}") for part in PARTS
    }
    if f"{a.bearing}.{WORK}" in run.system:
        values["bearing_sliding_work"] = run.system.value(f"{a.bearing}.{WORK}")
    if f"{a.bearing}.balls.count" not in run.system:
        return values
    if not is_thermal(run.system, a):  # the bearing has not watched it
        values[CONTACT_TEMPERATURE] = None
    found = warmed(run, a)
    for k, part in enumerate(PARTS):
        values[f"temperature_rise_{part}"] = found and float(found.rise[k])
        values[f"temperature_rise_{part}_adiabatic"] = found and float(found.adiabatic[k])
    values["largest_temperature_rise"] = found and float(found.rise[: len(PARTS)].max())
    values["play_change"] = found and largest_absolute(found.play)
    values["clearance_change"] = found and largest_absolute(found.clearance)
    seized, runs_away, used_up, _, shut = heat_events(run, a, found)
    return values | {
        "seized_time": seized and seized.time, "ring_stop_time": seized and seized.stopped,
        "runaway_time": runs_away, "play_used_up_time": used_up, "clearance_closed_time": shut,
    }  # fmt: skip


@dataclass(frozen=True)
class Seizure:
    """An inner ring that no longer turns with the journal, which slides in it."""

    time: float  # s, from which on it falls behind
    stopped: float | None  # s, from which on it stands still; None: it goes on turning
    share: float  # of the speed of rolling, the least
    sliding: float  # s, for which it is behind
    fastest: float  # rad/s, by which it is slower, at most


def seizure(
    time: np.ndarray, ring: np.ndarray, rolling: np.ndarray, friction: np.ndarray, inertia: float
) -> Seizure | None:
    """The first of a run, by this module's rule; all arrays (rows,), as recorded.

    ring: its speed, rolling: that with which it would roll on the journal (rad/s); friction: its heat
    in the bore since the start (J); inertia: of the ring (kg m2).
    """
    turns = np.abs(rolling) > AT_REST * np.abs(rolling).max(initial=0.0)
    share = np.where(turns, ring / np.where(turns, rolling, 1.0), 1.0)
    kept_up = turns & (share >= SYNCHRONOUS) & (friction > friction[:1])
    if not kept_up.any():
        return None
    behind = share < BEHIND
    behind[: np.argmax(kept_up)] = False
    edges = np.flatnonzero(np.diff(behind, prepend=False, append=False))
    for first, end in zip(edges[::2], edges[1::2], strict=True):
        least = first + int(np.argmin(share[first:end]))
        lag = rolling[least] - ring[least]
        work = friction[least] - friction[first - 1]
        if share[least] > HALF or abs(lag) < ROCKING or work < 0.5 * inertia * lag * lag:
            continue
        rows = slice(first - 1, first + 1)
        began = float(np.interp(-BEHIND, -share[rows], time[rows]))
        still = np.flatnonzero(share[first:end] < STILL)
        stopped = float(time[first + still[0]]) if len(still) else None
        fastest = float(np.abs(rolling - ring)[first:end].max())
        lasted = float(time[end - 1]) - began
        return Seizure(began, stopped, max(float(share[least]), 0.0), lasted, fastest)
    return None


def runaway(time: np.ndarray, preload: np.ndarray) -> float | None:
    """When a preload (m, (rows,)) that heat makes begins to grow ever faster (s), by this module's rule."""
    highest = np.maximum.accumulate(preload)
    if highest[-1] <= NOTED_PRELOAD:
        return None
    count = 1 + int(math.log(highest[-1] / NOTED_PRELOAD) / math.log(STEP))
    levels = NOTED_PRELOAD * STEP ** np.arange(count)
    levels = levels[levels <= highest[-1]]  # the last may be above it by rounding
    rows = np.searchsorted(highest, levels)
    if rows[0] == 0:
        return None
    low, high = highest[rows - 1], highest[rows]
    reached = time[rows - 1] + (levels - low) / (high - low) * (time[rows] - time[rows - 1])
    rates = np.diff(levels) / np.diff(reached)
    rises = rates[1:] > FASTER * rates[:-1]
    for k in range(len(rises) - RISES + 1):
        if rises[k : k + RISES].all():
            return float(reached[k])
    return None


class _HeatEvents(NamedTuple):
    """What became of a bearing by heat."""

    seizure: Seizure | None
    runaway: float | None  # s
    used_up: float | None  # s, when the play was closed
    preload: float  # m, the largest
    shut: float | None  # s, when the journal's clearance was closed


def heat_events(run: Finished, a: Attachment, warm: Warmed | None) -> _HeatEvents:
    """Of a seat; warm: its temperatures. What was not recorded tells nothing."""
    seized, play, angle = _seizure_of(run, a), f"{a.bearing}.{PLAY}", f"{a.bearing}.{ANGLE}"
    flat = angle not in run.system or run.system.value(angle) == 0.0  # else there is no play to use up
    used_up = _closed_at(run, play) if flat else None
    shut = _closed_at(run, f"{a.bearing}.{CLEARANCE}")
    if warm is None or play not in run.recording or not is_thermal(run.system, a):
        return _HeatEvents(seized, None, used_up, 0.0, shut)
    left = np.interp(warm.time, run.recording.time, run.recording[play])
    growth = -warm.play - np.maximum(left - warm.play, 0.0)
    return _HeatEvents(seized, runaway(warm.time, growth), used_up, max(-float(left.min()), 0.0), shut)


def _closed_at(run: Finished, gap: str) -> float | None:
    """When a recorded gap, open at the start, is used up (s); None: it is not."""
    if gap not in run.recording or run.recording[gap][0] <= 0.0:
        return None
    closed = np.flatnonzero(run.recording[gap] <= 0.0)
    return float(run.recording.time[closed[0]]) if len(closed) else None


def _seizure_of(run: Finished, a: Attachment) -> Seizure | None:
    names = [f"{a.bearing}.ring.omega", a.motion("omega"), f"{a.bearing}.{WORK}"]
    required = ("journal_radius", "clearance", "ring.inertia", "friction.dynamic")
    sizes = [f"{a.bearing}.{name}" for name in required]
    if not all(n in run.recording for n in names) or not all(n in run.system for n in sizes):
        return None
    ring, journal, sliding = (run.recording[name] for name in names)
    radius, clearance, inertia, dynamic = (run.system.value(name) for name in sizes)
    rolling = journal * radius / (radius + clearance)
    return seizure(run.recording.time, ring, rolling, dynamic * sliding, inertia)


def is_thermal(system: ReadableSystem, a: Attachment) -> bool:
    """Whether the gaps of a bearing follow its temperatures."""
    name = f"{a.bearing}.{THERMAL}"
    return name in system and system.value(name) == 1.0


def heat_warnings(run: Finished, seats: Sequence[Attachment]) -> list[str]:
    """Lines on bearings that seize, and on those whose drag and heat drive each other."""
    lines = []
    for a in seats:
        found = heat_events(run, a, warmed(run, a) if is_thermal(run.system, a) else None)
        if found.seizure is not None:
            lines.append(f"{a.bearing}: {_seized_words(found.seizure)}")
        name = f"{a.bearing}.temperature.contact"
        hottest = run.system.value(name) if name in run.system else 0.0
        if (harm := damage(hottest)) is not None:
            lines.append(
                f"{a.bearing}: between journal and bore it gets {hottest:.4g} K warmer than at the start; "
                f"{harm}. Take a bearing whose ring starts faster, less friction or speed"
            )
        if found.runaway is not None:
            lines.append(
                f"{a.bearing}: from {found.runaway:.3g} s on heat closes its play ever faster, to a "
                f"preload of {UM * found.preload:.3g} um at most: preload brakes the balls, which warms "
                "them further; give it more play or less preload, less drag, or a mount that ends the whirl"
            )
    return lines


def _seized_words(found: Seizure) -> str:
    how = f"turns with {percent(found.share, 2)} of its speed at least"
    if found.stopped is not None:
        how = f"stands still from {found.stopped:.4g} s on"
    return (
        f"it seizes at {found.time:.4g} s: the inner ring, which rolled with the rotor, falls behind it "
        f"and {how}, while the journal slides in it for {found.sliding:.3g} s, at "
        f"{RPM * found.fastest:.0f} rpm at most; wear and damage are not in the model, and no figure of "
        "later times is valid"
    )


def largest_absolute(values: np.ndarray) -> float:
    """The one farthest from 0, with its sign; values: (rows,)."""
    return float(values[np.argmax(np.abs(values))])
