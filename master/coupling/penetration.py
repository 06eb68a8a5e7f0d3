"""Warns where a journal is pressed far into its bearing, and ends a run whose bearing does not hold it.

A contact gives way by a part of its clearance. Where the journal is further out than that, the bearing's
force has the wrong sign or unit, or its contact is far too soft for the rotor: no macro step mends that.
"""

from __future__ import annotations

import math
from typing import ClassVar

from ..common.errors import Ended
from ..components.component import POSITION
from .connections import Attachment, housing_port
from .ledger.auditor import CLEARANCE, estimated_by_master
from .observer import Observer, RunState
from .system import System

WARN_CLEARANCES = 2.0  # clearances off the middle of the bore
STOP_CLEARANCES = 100.0  # and so many of them where the run ends


class Penetration(Observer):
    """Compares the journals' places in their bearings with the clearances that these state."""

    at_beats_only: ClassVar[bool] = True
    KEPT = ("warned_at", "warning", "_deepest")

    def __init__(self, system: System) -> None:
        self.warned_at: float | None = None  # s from zero
        self.warning = ""  # which journal is how deep, and what to look at
        self._seats = [
            (a, housing_port(system, a.bearing))
            for a in system.attachments
            if a.on_journal and _stated(system, a.bearing)
        ]
        self._deepest = WARN_CLEARANCES

    def stepped(self, state: RunState) -> None:
        for journal, housing in self._seats:
            clearance = state.system.value(f"{journal.bearing}.{CLEARANCE}")
            if not 0.0 < clearance < math.inf:
                continue
            depth = _distance(state.system, journal, housing) / clearance
            if depth <= self._deepest:
                continue
            state.keep()
            self._deepest, self.warned_at = depth, state.since_zero
            self.warning = (
                f"the journal on {journal.body_end.title} is {1e6 * depth * clearance:.3g} um off the "
                f"middle of {journal.bearing} at t = {state.since_zero:.6g} s, {depth:.2g} times its "
                f"clearance: that bearing does not hold it; see that its force on the journal points back "
                "and is in N (`touchdown check FMU --as bearing`), and that its contact is stiff enough"
            )
            if depth > STOP_CLEARANCES:
                state.stop(self.warning, Ended.STOPPED)


def _stated(system: System, bearing: str) -> bool:
    """Whether a bearing states its clearance; what the master estimates begins at the first force."""
    variable = system.components[bearing].variables.get(CLEARANCE)
    return variable is not None and not estimated_by_master(variable)


def _distance(system: System, journal: Attachment, housing: str | None) -> float:
    """Of the journal from the middle of its bearing (m)."""
    offsets = [
        system.value(journal.motion(axis)) - (system.value(f"{housing}.{axis}") if housing else 0.0)
        for axis in POSITION
    ]
    return math.hypot(*offsets)
