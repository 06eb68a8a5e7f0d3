"""What masters do on a problem: every setting run, and the longest macro step at which motion dies away."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from cosimulated.runs import Master, Problem, Setting, UnableError
from speeds.measured import Block

SHORTEST, LONGEST = 1e-4, 0.3  # s, where stable macro steps are looked for
CLOSE = 1.1  # ratio of a stable step and one that is not
HEAD = ("master", "asked for", "doSteps", "largest error [m]", "energy made", "at rest up to")


@dataclass(frozen=True)
class Result:
    """A master at one setting."""

    master: str
    label: str
    calls: int = 0
    error: float = float("nan")  # m
    energy: float | None = None  # over what there was
    unable: str = ""  # why there is nothing

    def row(self, rests: str) -> tuple[str, ...]:
        """Of the table."""
        if self.unable:
            return self.master, self.label, "-", "-", "-", rests
        energy = "-" if self.energy is None else f"{self.energy:.1e}"
        return self.master, self.label, f"{self.calls}", f"{self.error:.1e}", energy, rests


def results(master: Master, problem: Problem, settings: Sequence[Setting]) -> Iterator[Result]:
    """One for each setting."""
    return (result(master, problem, setting) for setting in settings)


def result(master: Master, problem: Problem, setting: Setting) -> Result:
    """One run."""
    try:
        motion = master.run(problem, setting)
    except UnableError as reason:
        return Result(master.title, setting.label, unable=str(reason))
    with np.errstate(all="ignore"):
        error, energy = problem.error(motion), problem.energy(motion)
    unable = f"stops: {motion.ended}" if motion.ended else ""
    return Result(master.title, setting.label, motion.calls, error, energy, unable)


def resting(master: Master, problem: Problem) -> str:
    """The longest stable macro step, for people."""
    if problem.damped(LONGEST) is None:
        return "-"
    if master.at(LONGEST) is None:
        return "by tolerance"
    low, high = SHORTEST, LONGEST
    try:
        if rests(master, problem, high):
            return f"above {1e3 * high:g} ms"
        while high / low > CLOSE:
            middle = (low * high) ** 0.5
            low, high = (middle, high) if rests(master, problem, middle) else (low, middle)
    except UnableError:
        return "-"
    return f"{1e3 * low:.2g} ms" if low > SHORTEST else f"below {1e3 * high:.2g} ms"


def rests(master: Master, problem: Problem, step: float) -> bool:
    """Whether motion dies away at macro steps of `step` (s)."""
    damped, setting = problem.damped(step), master.at(step)
    assert damped is not None
    assert setting is not None
    with np.errstate(all="ignore"):
        return damped.rests(master.run(damped, setting))


def block(title: str, found: Iterable[tuple[Result, str]]) -> Block:
    """The table of a problem; what stands under it says why something is missing."""
    return Block(title, HEAD, tuple(one.row(rests) for one, rests in found))


def reasons(found: Iterable[Result]) -> Iterator[str]:
    """Why masters have no figures, a line each."""
    told = dict.fromkeys(f"  {one.master} at {one.label}: {one.unable}" for one in found if one.unable)
    return iter(told)
