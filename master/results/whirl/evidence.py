"""On what a run's verdicts rest, in words for the screen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from ..final_state import ReadableSystem
from .contacts import MIN_SWING
from .verdict import TOO_COARSE, Verdict, short_of_one

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
MARCHED = "_most_turns_one_way"  # behind the key of a verdict
CONTACT = "first_contact_time_s"  # begins the key of a bearing's; no value: not yet
LANDING = "face_landing_time_s"  # likewise, of a shoulder along the shaft
SWUNG = math.degrees(MIN_SWING)  # of a pendulum, either way in contact
COARSELY = (
    "from one recorded row in contact to the next the contact mostly moves by a quarter turn or more; "
    "a smaller run.record_every or run.macro_step resolves it"
)
SLIDES = 1.0  # deg of the force's phase; below it the force neither drives a whirl nor brakes it


def evidence(summary: Mapping[str, object]) -> list[str]:
    """A line for each verdict of a run's summary: what it rests on, and whether that is near an edge."""
    if not touched_bore(summary):
        if touched(summary):
            return ["the rotor landed along its shaft, and touched no bore"]
        return ["no bearing has been touched: the run ends too early; a longer run.duration shows the drop"]
    return [_rests_on(summary, key.removesuffix(MARCHED)) for key in summary if key.endswith(MARCHED)]


def first_contact(summary: Mapping[str, object]) -> float | None:
    """When the first bearing was touched (s from the zero); None where none was."""
    times = [time for key, time in summary.items() if key.startswith(CONTACT)]
    return min((time for time in times if isinstance(time, float)), default=None)


def touched(summary: Mapping[str, object]) -> bool:
    """Whether any bearing was, in its bore or on a face, as far as bearings tell."""
    landed = any(key.startswith(LANDING) and value is not None for key, value in summary.items())
    return landed or touched_bore(summary)


def touched_bore(summary: Mapping[str, object]) -> bool:
    """Whether the bore of any bearing was, as far as bearings tell."""
    tells = any(key.startswith(CONTACT) for key in summary)
    return not tells or first_contact(summary) is not None


def hint(scene: str, system: ReadableSystem, summary: Mapping[str, object]) -> Iterator[str]:
    """A note that a run with an unbalance is one phase of it, where its verdict depends on the phase."""
    verdicts = any(key.endswith(MARCHED) and value is not None for key, value in summary.items())
    if verdicts and touched_bore(summary) and unbalanced(system):
        yield f"one phase of the unbalance: `touchdown verdict {scene}` shows how the verdict depends on it"


def goes_on(summary: Mapping[str, object]) -> Iterator[str]:
    """How the seats settle, and how long a run should be where one has not."""
    yield from (f"{key}: {value}" for key, value in summary.items() if key.startswith("settled") and value)
    if isinstance(longer := summary.get("proposed_duration_s"), float):
        yield f'a longer run may show it: --set run.until=settled --duration "{longer:g} s"'


def _rests_on(summary: Mapping[str, object], seat: str) -> str:
    marched, turns = summary[f"{seat}{MARCHED}"], summary[f"{seat}_revolutions"]
    if not isinstance(marched, float) or not isinstance(turns, float):
        return f"{seat}: no verdict, since the bearing states no clearance"
    if summary[seat] == TOO_COARSE:
        return f"{seat}: {TOO_COARSE}: {COARSELY}"
    if turns > 0.0:
        text = f"the contact went round {turns:.3g} times{_driven(summary[f'{seat}_force_phase_deg'])}"
    elif marched == 0.0:
        text = "no contact that could swing or go round"
    else:
        text = f"{_swings(str(summary[seat]))}; {_went(marched)}, and a whirl takes 1"
    edge = ", so it is near the edge" if NEAR[0] <= (turns or marched) <= NEAR[1] else ""
    return f"{seat}: {summary[seat]}: {text}{edge}"


def _swings(words: str) -> str:
    """The evidence for or against a pendulum: a contact that goes far one way may not come back."""
    if words.startswith(Verdict.PENDULUM):
        return f"the contact swung either way by {SWUNG:g} deg or more"
    return f"the contact did not swing to both sides by {SWUNG:g} deg"


def _went(marched: float) -> str:
    """How far the contact went one way."""
    if marched < 1.0:
        return f"it went {short_of_one(marched)} of a turn one way at most"
    return f"it went {marched:.3g} turns one way at most and back, or with rests"


def _driven(phase: object) -> str:
    if not isinstance(phase, float) or abs(phase) < SLIDES:
        return ""
    return f", and its force {'drives' if phase > 0.0 else 'brakes'} it by {abs(phase):.2g} deg"
