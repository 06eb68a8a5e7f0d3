"""How a bearing responds to a journal that is pressed into it: the sign of its force, and its stiffness.

A force of the wrong sign throws the rotor out of its bearing; in kN, or with lengths in mm, it sinks. Both
give numbers that look like a drop. So the journal is moved outwards in three directions until it meets a
force, and a little further.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..common.errors import TouchdownError
from ..components.component import FORCE, POSITION, Component
from .contract import CheckReport

STEP = 1e-5  # s
MOVING_STEPS, RESTING_STEPS = 10, 40  # steps between two places, and at the one where the force is read
FIRST_DISTANCE, MAX_DISTANCE, DISTANCE_RATIO = (
    10e-6,
    5e-3,
    1.15,
)  # m from the middle; from one place to the next
SLOPE_DISTANCE = 5e-6  # m, between the two places that the stiffness is read from
MIN_FORCE = 0.1  # N; less does not count as contact
DIRECTIONS = (-90.0, 30.0, 150.0)  # degrees
# N/m; magnetic bearings lie at the lower end, steel on steel a tenth of the upper
USUAL_STIFFNESS = 1e5, 1e11
PORT = "journal"
VELOCITY = ("vx", "vy")


class _Rig:
    """A bearing whose journal is moved as asked, from the middle outwards."""

    def __init__(self, component: Component) -> None:
        self._component = component
        motion = [f"{PORT}.{suffix}" for suffix in (*POSITION, *VELOCITY)]
        self._fed = [name for name in motion if name in component.variables]
        self._place = np.zeros(2)
        self._steps = 0
        component.bind(self._fed, np.zeros(0), [])
        component.enter(0.0)
        component.exit()

    def move(self, place: np.ndarray, steps: int) -> None:
        """Move the journal to `place` (2,) (m) in so many steps."""
        begin, velocity = self._place, (place - self._place) / (steps * STEP)
        for k in range(steps):
            self._step(begin + k * STEP * velocity, velocity)
        self._place = place

    def force(self) -> np.ndarray:
        """Mean force (2,) (N) on the journal that rests where it is."""
        total = np.zeros(2)
        for _ in range(RESTING_STEPS):
            self._step(self._place, np.zeros(2))
            total += self._component.read([f"{PORT}.{suffix}" for suffix in FORCE])
        return total / RESTING_STEPS

    def _step(self, place: np.ndarray, velocity: np.ndarray) -> None:
        suffixes: tuple[str, ...] = (*POSITION, *VELOCITY)
        values: dict[str, float] = dict(zip(suffixes, map(float, (*place, *velocity)), strict=True))
        self._component.inputs[:] = [values[name.rpartition(".")[2]] for name in self._fed]
        self._component.push()
        self._component.step(self._steps * STEP, STEP)
        self._steps += 1


def press_journal(component: Component, report: CheckReport) -> None:
    """Press the journal of a bearing that was not initialised; findings go into `report`."""
    try:
        rig = _Rig(component)
        found = [_pressed(rig, math.radians(angle)) for angle in DIRECTIONS]
    except TouchdownError as error:
        report.problems.append(f"pressed by its journal: {error}")
        return
    _judge(found, report)


def _pressed(rig: _Rig, angle: float) -> tuple[float, float, float] | None:
    """Where the journal met a force (m), the force outwards (N) and the stiffness (N/m); None: nowhere."""
    outwards = np.array([math.cos(angle), math.sin(angle)])
    rig.move(0.0 * outwards, MOVING_STEPS)
    count = math.ceil(math.log(MAX_DISTANCE / FIRST_DISTANCE, DISTANCE_RATIO))
    for distance in FIRST_DISTANCE * DISTANCE_RATIO ** np.arange(count + 1):
        rig.move(distance * outwards, MOVING_STEPS)
        force = rig.force()
        if math.hypot(*force) >= MIN_FORCE:
            rig.move((distance + SLOPE_DISTANCE) * outwards, MOVING_STEPS)
            along, deeper = float(force @ outwards), float(rig.force() @ outwards)
            return float(distance), along, (along - deeper) / SLOPE_DISTANCE
    return None


def _judge(found: Sequence[tuple[float, float, float] | None], report: CheckReport) -> None:
    met = [one for one in found if one is not None]
    if not met:
        report.problems.append(
            f"it gave no force on a journal up to {1e3 * MAX_DISTANCE:g} mm off its middle; see that "
            f"{PORT}.x and {PORT}.y are read in m"
        )
        return
    outwards = [one for one in met if one[1] > 0.0]
    if outwards:
        distance, force, _ = outwards[0]
        report.problems.append(
            f"a journal {1e6 * distance:.3g} um off the middle is pushed further out, by {force:.3g} N: "
            f"{PORT}.fx and {PORT}.fy are to be the force on the journal; turn their signs"
        )
        return
    stiffness = float(np.median([one[2] for one in met]))
    text = f"a journal {1e6 * met[0][0]:.3g} um off the middle is pushed back, at {stiffness:.2g} N/m"
    if USUAL_STIFFNESS[0] <= stiffness <= USUAL_STIFFNESS[1]:
        report.lines.append(text)
    else:
        report.lines.append(
            f"warning: {text}; touchdown bearings have {USUAL_STIFFNESS[0]:g} to {USUAL_STIFFNESS[1]:g} "
            "N/m: see that its forces are in N and its lengths in m"
        )
