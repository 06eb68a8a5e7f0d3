"""What a scene's runs say round the circle of phases, with one choice of steps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from touchdown.master.common.ended import Ended
from touchdown.master.results.whirl.told import whirling
from touchdown.master.studies.sweep.journal import Member
from touchdown.master.studies.sweep.report import largest
from touchdown.master.studies.verdict.phases import Verdicts


@dataclass(frozen=True)
class Circle:
    """One choice of steps, and its runs by phase (deg)."""

    title: str  # such as "macro step 40 us"
    members: Mapping[float, Member]

    @cached_property
    def verdicts(self) -> Verdicts:
        """Of the runs that came to their end: how the rotor whirls, in words, or "" where it does not."""
        return {phase: whirling(m.summary) for phase, m in self.members.items() if not m.failed}

    @property
    def failed(self) -> dict[float, str]:
        """Why runs gave no verdict, those left out where they were interrupted."""
        return {
            phase: m.failed
            for phase, m in self.members.items()
            if m.failed and m.ended is not Ended.INTERRUPTED
        }

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C kept some from running."""
        return any(m.ended is Ended.INTERRUPTED for m in self.members.values())

    def over_the_limit(self, limit: float) -> int:
        """How many runs have a ledger whose residual is beyond `limit` of what a connection turned over."""
        residuals = (m.summary.get("energy_residual_of_turnover") for m in self.members.values())
        return sum(isinstance(r, float) and r > limit for r in residuals)

    def largest_force(self) -> float | None:
        """The largest contact force of all runs and seats (N); None where no bearing reports it."""
        forces = (peak_force(m.summary) for m in self.members.values())
        return max((force for force in forces if force is not None), default=None)


def peak_force(summary: Mapping[str, object]) -> float | None:
    """The largest contact force of a run (N), of all its bearings; None where none reports it."""
    return largest(summary, "peak_contact_force_N")
