"""Stresses along a rotor at the first distinct peak after it touches down.

On its way up the bending stress ripples with the higher modes. A peak is distinct where nothing exceeds
it for half a period of the third bending mode: what does so sooner is a ripple of that or a higher mode.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.observer import Moment, Observer
from touchdown.master.coupling.simulation import Outcome, opened, simulate
from touchdown.master.coupling.system import System
from touchdown.master.results.ending import Ending, ending
from touchdown.master.results.stresses import stress_figures, stressed
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.scene.scene import Scene

Reader = Callable[[], np.ndarray]

BENDING = (673.5, 1071.0, 2363.0, 2925.0)  # Hz, of rotor II (Table 2, simulated)
WAIT = 0.5 / BENDING[2]  # s


class FirstPeak(Observer):
    """Ends a run at the first distinct peak after contact of the stress that a rotor watches.

    The stresses it has kept along itself are then those of that instant.
    """

    def __init__(self, peak: Reader, touched: Sequence[Reader], wait: float = WAIT) -> None:
        """Of a time each: peak, when the stress was largest; touched, when a journal was, -1 if not yet.

        wait: s, for which nothing exceeds a distinct peak.
        """
        self._peak, self._touched, self._wait = peak, touched, wait

    @classmethod
    def of(cls, system: System, wait: float = WAIT) -> FirstPeak:
        """The one for the rotor of `system` and its touchdown bearings."""
        (rotor,) = stressed(system)
        bearings = [system.components[a.bearing] for a in touchdown_seats(system)]
        touched = [bearing.reader(["contact.first_time"]) for bearing in bearings]
        return cls(system.components[rotor].reader(["stress.kept_time"]), touched, wait)

    def stepped(self, now: Moment) -> None:
        touched = [float(read()[0]) for read in self._touched]
        first = min((time for time in touched if time >= 0.0), default=now.time)
        peak = float(self._peak()[0])
        if peak > first and now.time - peak >= self._wait:
            now.stop("the first distinct peak is over")


def figures_at_first_peak(scene: Scene, wait: float = WAIT) -> dict[str, object]:
    """Run `scene` in process up to that peak: its stress figures and first contacts, as in a summary.

    wait: s, for which nothing exceeds it. Raises TouchdownError where the run stops before, or ends
    without one.
    """
    with _at_first_peak(scene, wait) as (system, outcome):
        touched = {
            a.bearing: system.value(f"{a.bearing}.contact.first_time") for a in touchdown_seats(system)
        }
        contacts = {
            f"first_contact_time_s_{bearing}": time - outcome.zero
            for bearing, time in touched.items()
            if time >= 0.0
        }
        return {**contacts, **stress_figures(system, outcome)}


def ending_at_first_peak(scene: Scene, wait: float = WAIT) -> Ending:
    """Run `scene` in process up to that peak: its system as it is then. Raises TouchdownError as above."""
    with _at_first_peak(scene, wait) as (system, _):
        return ending(system)


@contextmanager
def _at_first_peak(scene: Scene, wait: float) -> Iterator[tuple[System, Outcome]]:
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system, observers=[FirstPeak.of(system, wait)])
        outcome.raise_if_stopped()
        if outcome.ended is not Ended.AS_WANTED:
            raise TouchdownError(
                f"scene {scene.name}: the bending stress has no distinct peak within "
                f"{scene.run.duration:g} s; a longer run.duration may show one"
            )
        yield system, outcome
