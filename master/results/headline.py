"""A run in a few sentences: what it fails by, or how near it comes to its limits, and whether it whirls."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress

from ..common.errors import Ended, TouchdownError
from ..common.text import UM, joined
from ..coupling.loop.span import origin_of
from ..quantities import Owner, Summary, first_touch, owned, values_of
from ..scene.scene import Scene
from .capture import Fate, by_words, captured_words, fate
from .final_state import Finished
from .required import judged
from .summary import touchdown_seats
from .validity import invalid_from
from .whirl.evidence import touched_bore

FAILS = "FAILS"
NOT_ACCURATE = 0.02  # of the energy that crossed, made by the coupling
NO_VERDICT = "not known: no clearance is stated, or no orbit was recorded"


def headline(run: Finished, summary: Summary, ended: Ended, because: str) -> str:
    """The decision first, then until when figures hold, and what the rotor does.

    A run that stopped passes nothing; it fails by what happened before, where its ledger closed till then.
    """
    decision = _decision(run.scene, summary)
    void = invalid_from(summary, decision)
    if ended is Ended.STOPPED:
        known = decision.startswith(FAILS) and abs(summary["energy_made_of_turnover"] or 0.0) < NOT_ACCURATE
        said = (decision, void) if known else ()
        return " ".join(
            filter(None, (*said, f"The run stopped before its end: {because.partition(';')[0]}."))
        )
    cut = "" if ended is Ended.COMPLETED else "The run was ended early."
    return " ".join(filter(None, (decision, void, *_ending(run, summary), cut)))


def since_origin(run: Finished, time: float) -> float:
    """A recorded time (s) from the shutdown on, or from the start of a run whose scene names no zero."""
    with suppress(TouchdownError):  # a component that failed tells nothing any more
        return time - origin_of(run.scene, run.system)
    return time


def _decision(scene: Scene, summary: Summary) -> str:
    """Whether the run fails, and by what; or how near it comes to what is required."""
    required = judged(scene.requirements, summary)
    if reasons := [*_failures(summary), *(one.beyond() for one in required if one.fails)]:
        return f"{FAILS}: {'; '.join(dict.fromkeys(filter(None, reasons)))}."
    if unknown := [one.item.words for one in required if one.margin is None]:
        return f"UNDECIDED: this run has no figure of {joined(unknown)}."
    if not required:
        return ""
    nearest = min(required, key=lambda one: one.margin or 0.0)
    every = "its requirement" if len(required) == 1 else f"all {len(required)} requirements"
    if len(required) < len(scene.requirements):
        every += " of a drop (`touchdown amb-margins` judges the loops)"
    return f"PASSES {every}; nearest to its limit: {nearest.compared()}."


def _failures(summary: Summary) -> Iterator[str]:
    """What no machine is meant to do, also where its scene does not require it."""
    for name, least in values_of(summary, "least", Owner.GAP).items():
        if least is not None and least <= 0.0:
            yield f"{name} is rubbed ({-UM * least:.3g} um beyond its gap)"
    if (because := summary.get("invalid_because")) and " is rubbed" not in because:
        yield because
    if fate(summary) is Fate.LOST:
        yield "the rotor is not captured"


def _ending(run: Finished, summary: Summary) -> Iterator[str]:
    """What the rotor does, to the end of the run."""
    length = since_origin(run, float(run.recording.time[-1]))
    if not touchdown_seats(run.system):
        yield "The scene has no touchdown bearing."
    elif first_touch(summary) is None:
        yield f"The rotor touches no bearing within {length:.4g} s of the shutdown."
    else:
        yield captured_words(summary)
        yield from _running_away(owned(summary, Owner.SEAT))
        yield _whirl(summary, length)


def _running_away(seats: Mapping[str, Mapping[str, float | None]]) -> Iterator[str]:
    """Sentences on bearings that heat closes ever faster, and that have not seized."""
    for name, seat in seats.items():
        if seat.get("seized_time") is None and (time := seat.get("runaway_time")) is not None:
            yield (
                f"The bearing at {name} heats up ever faster from {time:.3g} s after the shutdown on: "
                "its preload runs away."
            )


def _whirl(summary: Summary, length: float) -> str:
    """The verdict, in a sentence."""
    verdicts = {name: words for name, words in values_of(summary, "whirl").items() if words}
    if whirls := {seat: words for seat, words in verdicts.items() if "ward whirl" in words}:
        return f"The rotor whirls: {_placed(whirls)}."
    if not touched_bore(summary):
        times = values_of(summary, "face_landing_time").items()
        landed = [name for name, time in times if time is not None]
        return f"The rotor lands along its shaft at {joined(landed)}, and touches no bore."
    if not verdicts:
        return f"The rotor lands; whether it whirls is {NO_VERDICT}."
    more = {seat: words for seat, words in verdicts.items() if words != "no whirl"}
    return f"No whirl within {length:.4g} s{': ' if more else ''}{_placed(more)}."


def _placed(verdicts: Mapping[str, str]) -> str:
    """'pendulum at A and B', 'pendulum at A; no whirl at B'."""
    return "; ".join(f"{words} at {seats}" for words, seats in by_words(verdicts))
