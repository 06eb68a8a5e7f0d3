"""On what a run's verdicts rest, in words for the screen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from ...quantities import Owner, owned, values_of, was_touched
from ..final_state import ReadableSystem
from .contacts import MIN_SWING
from .verdict import TOO_COARSE, WhirlVerdict, short_of_one

ANGLE = "unbalance_angle"  # of a rotor at the start
SIZES = ("eccentricity", "unbalance_scale")  # without it there is no unbalance, where a rotor states one


def unbalanced(system: ReadableSystem) -> list[str]:
    """The bodies with an unbalance that can be turned, in the order of the scene."""
    return [
        name
        for name in dict.fromkeys(a.body for a in system.attachments)
        if f"{name}.{ANGLE}" in system
        and all(system.value(f"{name}.{size}") != 0.0 for size in SIZES if f"{name}.{size}" in system)
    ]


NEAR = (0.75, 1.25)  # turns one way: about the one that makes a whirl; a turn is a hop or two more or less
SWUNG = math.degrees(MIN_SWING)  # of a pendulum, either way in contact
COARSELY = (
    "from one recorded row in contact to the next the contact mostly moves by a quarter turn or more; "
    "a smaller run.record_every or run.macro_step resolves it"
)
SLIDES = math.radians(1.0)  # of the force's phase; below it the force neither drives a whirl nor brakes it


def evidence(summary: Mapping[str, Any]) -> list[str]:
    """A line for each verdict of a run's summary: what it rests on, and whether that is near an edge."""
    if not touched_bore(summary):
        if touched(summary):
            return ["the rotor landed along its shaft, and touched no bore"]
        return ["no bearing has been touched: the run ends too early; a longer run.duration shows the drop"]
    seats = owned(summary, Owner.SEAT).items()
    return [f"{name}: {_rests_on(seat)}" for name, seat in seats if "whirl" in seat]


def earliest_contact(summary: Mapping[str, Any]) -> float | None:
    """When the first bearing was touched (s from the zero); None where none was."""
    times = values_of(summary, "first_contact_time").values()
    return min((time for time in times if time is not None), default=None)


def touched(summary: Mapping[str, Any]) -> bool:
    """Whether any bearing was, in its bore or on a face, as far as bearings tell."""
    return touched_bore(summary) or any(map(was_touched, owned(summary, Owner.SEAT).values()))


def touched_bore(summary: Mapping[str, Any]) -> bool:
    """Whether the bore of any bearing was, as far as bearings tell."""
    return not values_of(summary, "first_contact_time") or earliest_contact(summary) is not None


def hint(scene: str, system: ReadableSystem, summary: Mapping[str, Any]) -> Iterator[str]:
    """A note that a run with an unbalance is one phase of it, where its verdict depends on the phase."""
    has_verdict = any(turns is not None for turns in values_of(summary, "most_turns_one_way").values())
    if has_verdict and touched_bore(summary) and unbalanced(system):
        yield f"one phase of the unbalance: `touchdown verdict {scene}` shows how the verdict depends on it"


def goes_on(summary: Mapping[str, Any]) -> Iterator[str]:
    """How the seats settle, and how long a run should be where one has not."""
    yield from (f"{name}: {words}" for name, words in values_of(summary, "settled").items() if words)
    if (longer := summary["proposed_duration"]) is not None:
        yield f'a longer run may show it: --set run.until=settled --duration "{longer:g} s"'


def _rests_on(seat: Mapping[str, Any]) -> str:
    words, marched, turns = (seat[key] for key in ("whirl", "most_turns_one_way", "whirl_revolutions"))
    if words is None:
        return "no verdict on whirl, since the bearing states no clearance"
    if words == TOO_COARSE:
        return f"{TOO_COARSE}: {COARSELY}"
    if turns > 0.0:
        text = f"the contact went round {turns:.3g} times{_driven(seat['whirl_force_phase'])}"
    elif marched == 0.0:
        text = "no contact that could swing or go round"
    else:
        swung = f"did not swing to both sides by {SWUNG:g} deg"
        if words.startswith(WhirlVerdict.PENDULUM):  # a contact that goes far one way may not come back
            swung = f"swung either way by {SWUNG:g} deg or more"
        went = f"{marched:.3g} turns one way at most and back, or with rests"
        if marched < 1.0:
            went = f"{short_of_one(marched)} of a turn one way at most"
        text = f"the contact {swung}; it went {went}, and a whirl takes 1"
    edge = ", so it is near the edge" if NEAR[0] <= (turns or marched) <= NEAR[1] else ""
    return f"{words}: {text}{edge}"


def _driven(phase: float | None) -> str:
    if phase is None or abs(phase) < SLIDES:
        return ""
    return (
        f", and its force {'drives' if phase > 0.0 else 'brakes'} it by {abs(math.degrees(phase)):.2g} deg"
    )
