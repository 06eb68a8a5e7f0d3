"""How a controller responds to a rotor that is moved: the sign of its set points, their size, their delay,
and whether it uses every sample.

A set point of the wrong sign throws the rotor out; positions read in mm leave it where it lies. One that
samples by itself, by comparing times, may use every second sample only, by rounding. All of that gives
numbers that look like a loop. So each axis is moved by a micrometre, and then every sample differs.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..common.errors import TouchdownError
from ..components.component import Component
from ..coupling.controller_alone import ControllerAlone, control_axes, set_points
from .contract import CheckReport

PERIOD = 1e-4  # s, from sample to sample, by default
MOVED, NOISE = 1e-6, 1e-7  # m
RESTING, WAITING, SAMPLES, PARTS = 20, 10, 1000, 4  # calls, samples, calls to a sample
CHANGED = 1e-4  # of an axis' largest answer; less is rounding, also of a controller in single precision
DECAYING = 1e-2  # of the largest answer of any axis; less may be left of an axis moved before
SILENT = 1e-4  # of the largest answer of any axis; an axis with less does not answer
FOREIGN = 0.5  # of the largest answer to a move along an axis; its own is more
USUAL_GAIN = 1e2, 1e7  # A/m; a limit of N/m would not tell metres from millimetres


def move_axes(load: Callable[[], Component], period: float, report: CheckReport) -> None:
    """Move the axes of a controller, of which load() gives instances; findings go into `report`."""
    for look in (_answers, _samples, _calls):
        component = load()
        try:
            look(component, period, report)
        except TouchdownError as error:
            report.problems.append(f"pressed: {error}")
        finally:
            component.close()
        if report.problems:
            return


def _answers(component: Component, period: float, report: CheckReport) -> None:
    """Each axis moved alone: sign, size and delay of the answer."""
    axes = control_axes(component)
    alone = ControllerAlone(component, axes, period)
    rest = np.zeros(len(axes))
    moved = np.empty((len(axes), WAITING, len(axes)))  # by the axis moved, sample and axis that answers
    for k in range(len(axes)):
        before = [alone.sample(rest) for _ in range(RESTING)][-1]
        place = rest.copy()
        place[k] = MOVED
        moved[k] = np.array([alone.sample(place) for _ in range(WAITING)]) - before
    largest = np.abs(moved).max(axis=1)
    for k, axis in enumerate(axes):
        if largest[k, k] <= max(SILENT * largest.max(), FOREIGN * largest[k].max()):
            report.problems.append(_silent(component, k, axes, largest))
        else:
            _judge(component, axis, moved[k, :, k], report)


def _silent(component: Component, k: int, axes: list[int], largest: np.ndarray) -> str:
    """The message about the k-th axis, which does not answer; largest: by axis moved, axis answering."""
    name, unit = next(iter(set_points(component, axes[k]).items()))
    problem, left = f"a rotor {1e6 * MOVED:g} um off along axis {axes[k]}", DECAYING * largest.max()
    if largest[k].max() <= left:
        late = f"does not change {name} within {WAITING} samples"
        return f"{problem} {late}; see that the controller is on from its start"
    other = int(np.argmax(largest[k]))
    if largest[k, k] <= left:
        found = f"does not change {name}, but that of axis {axes[other]}"
    else:
        found = f"changes {name} by {largest[k, k]:.2g} {unit}, and that of axis {axes[other]} by "
        found += f"{largest[k, other]:.2g} {unit}"
    return f"{problem} {found}; name its variables the other way round"


def _judge(component: Component, axis: int, answer: np.ndarray, report: CheckReport) -> None:
    """An axis' set points (n,) after the move, from sample to sample."""
    name, unit = next(iter(set_points(component, axis).items()))
    gain = answer[-1] / MOVED
    if answer.sum() > 0.0:
        report.problems.append(
            f"a rotor {1e6 * MOVED:g} um off along axis {axis} is pushed further out: {name} rises by "
            f"{answer.max():.3g} {unit}; a set point above zero pulls along the axis: turn its sign"
        )
        return
    late = int(np.argmax(np.abs(answer) > CHANGED * np.abs(answer).max()))
    moment = "in the call of the sample" if late == 0 else f"{late} samples after it"
    report.lines.append(
        f"axis {axis}: a rotor off the centre is pulled back, at {-gain:.3g} {unit}/m; it answers "
        f"{moment}, which makes {late + 1} sample{'s' if late else ''} of delay in the loop"
    )
    if unit == "N":
        report.lines.append(f"axis {axis}: it commands forces; set the actuator's command = force")
    elif not USUAL_GAIN[0] <= -gain <= USUAL_GAIN[1]:
        report.lines.append(
            f"warning: {-gain:.3g} A/m on axis {axis}; controllers have {USUAL_GAIN[0]:g} to "
            f"{USUAL_GAIN[1]:g} A/m: see that positions are in m and set points in A"
        )


def _samples_used(component: Component, period: float, parts: int) -> int:
    """How many of `SAMPLES` different positions, in so many calls, changed the set points."""
    axes = control_axes(component)
    alone = ControllerAlone(component, axes, period)
    places = NOISE * np.random.default_rng(1).uniform(-1.0, 1.0, (SAMPLES, len(axes)))
    asked = np.array([alone.sample(place, parts) for place in places])
    return 1 + int(np.any(np.diff(asked, axis=0) != 0.0, axis=1).sum())


def _samples(component: Component, period: float, report: CheckReport) -> None:
    taken = _samples_used(component, period, 1)
    if taken < SAMPLES - 1:  # the first may come late
        report.problems.append(
            f"it takes {taken} of {SAMPLES} samples, called once every {1e6 * period:g} us: one that "
            "samples by itself must not compare times without a margin; have it answer at every call, or "
            "by `tick`, or give its own time between samples (--sample-time)"
        )


def _calls(component: Component, period: float, report: CheckReport) -> None:
    """Called more often than once a sample: whether it answers each call."""
    expected = SAMPLES // PARTS
    try:
        taken = _samples_used(component, period, PARTS)
    except TouchdownError as error:
        report.lines.append(f"it takes no steps of a {PARTS}th of {1e6 * period:g} us: {error}")
        taken = SAMPLES
    if taken >= SAMPLES - PARTS:
        report.lines.append(
            f'it answers at every call: step it once a sample, sampled = "{1e6 * period:g} us" in its table'
        )
    elif abs(taken - expected) <= 1:
        report.lines.append("called more often, it uses each sample once: every macro step will do")
    else:
        report.lines.append(
            f"warning: called {PARTS} times a sample, it uses {taken} of {expected} samples: step it once "
            f'a sample, sampled = "{1e6 * period:g} us" in its table'
        )
