"""Whether a rotor that was to be levitated again is captured, seat by seat.

With the command at t_c, c the clearance of a touchdown bearing and r the true distance of its journal from
the bearing's middle:

captured    from some t_k <= t_c + WITHIN to the end of the run, r <= c/2 without a contact; that lasts for
            HOLD and for TURNS turns of the rotor (at most WITHIN), and r does not grow so fast that the
            orbit leaves c/2 within another WITHIN; t_k - t_c is the capture time
undecided   r was within c/2 for that time, and left it, or will, without a contact since: an unstable loop,
            or a shock. Or not captured, and the run ends before t_c + WITHIN and the time to hold
lost        else, and why: through the gap (the journal came to the magnets: what follows is void), whirl
            (by the whirl's verdict, still so at the end), not lifted (contact in more than LASTING of the
            time from t_c on), rebounds (contacts without either)

Forces are means over macro steps, at recorded times. What commands a rotor tells the time of it
(`commanded_time`); what holds one by magnets tells of its coils.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from ..common.text import joined
from ..coupling.connections import Attachment, housing_port
from ..quantities import Owner, Summary, enter, owned
from .final_state import ReadableSystem
from .recording import Recording
from .whirl.verdict import WhirlKind, kind_of_whirl, verdict_class

WITHIN = 0.5  # s
HOLD, TURNS = 0.05, 5.0  # s; turns
SHARE = 0.5  # of the clearance
LASTING = 0.9  # of the time from the command on
COMMANDED = "commanded_time"  # s, simulation's clock, of a controller; below zero: never
GAP = "least_gap"  # m, of an actuator
COILS = {  # of an actuator: the variable, of which the largest over all counts
    "largest_coil_current": "peak_current",
    "time_at_current_limit": "limits.current_time",
    "time_at_voltage_limit": "limits.voltage_time",
}
LIMITED = "limited_time"  # s, of a controller: for how long its own limit cut a set point


class Fate(StrEnum):
    """The fate of a rotor that was to be levitated again, the gravest last."""

    CAPTURED = "captured"
    UNDECIDED = "undecided"
    LOST = "lost"


def fate(summary: Mapping[str, Any]) -> Fate | None:
    """Of a run, that of the worst of its seats; None where no rotor was asked for again."""
    order = list(Fate)
    words = (one.words.partition(":")[0] for one in captures(summary).values())
    return max(map(Fate, words), key=order.index, default=None)


def captured_words(summary: Mapping[str, Any]) -> str:
    """The fate of a rotor that was to be levitated again, in a sentence; "": it was not to be."""
    fates = captures(summary)
    if not fates:
        return ""
    text = "; ".join(_placed(*pair) for pair in by_words({s: one.words for s, one in fates.items()}))
    times = [one.after for one in fates.values() if one.after is not None]
    after = f", {max(times):.3g} s after the command" if len(times) == len(fates) else ""
    return f"Asked for again, the rotor is {text}{after}."


def _placed(words: str, seats: str) -> str:
    """'captured at A and B', 'lost at A (whirl)'."""
    what, _, why = words.partition(": ")
    return f"{what} at {seats} ({why})" if why else f"{what} at {seats}"


def by_words(said: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """What is said of seats, and of which of them: ('pendulum', 'A and B')."""
    for words in dict.fromkeys(said.values()):
        yield words, joined(seat for seat, one in said.items() if one == words)


@dataclass(frozen=True)
class CaptureVerdict:
    """The verdict at one seat, and what it rests on."""

    words: str
    after: float | None  # s, capture time; None where it is not captured
    last_contact: float | None  # s after the command; None: none
    peak_force: float  # N, after the command


def captures(summary: Mapping[str, Any]) -> dict[str, CaptureVerdict]:
    """The verdicts of a run by the names of their seats; none where no rotor was asked for again."""
    return {
        name: CaptureVerdict(
            seat["capture"], seat["capture_time"], seat["capture_last_contact"], seat["capture_peak_force"]
        )
        for name, seat in owned(summary, Owner.SEAT).items()
        if "capture" in seat
    }


def judge(
    time: np.ndarray, radius: np.ndarray, force: np.ndarray, clearance: float, hold: float, lost: str = ""
) -> CaptureVerdict:
    """The verdict on a seat; arrays (n,).

    time: s since the command; radius: m, of the journal from the bearing; force: N, of the contact;
    hold: s, for which it must stay; lost: why it is lost if it is not captured, where that is known.
    """
    later = time >= 0.0
    time, radius, touching = time[later], radius[later], force[later] > 0.0
    peak = float(force[later].max(initial=0.0))
    contacts = np.flatnonzero(touching)
    last = float(time[contacts[-1]]) if len(contacts) else None
    free = int(contacts[-1]) + 1 if len(contacts) else 0
    outside = np.flatnonzero(radius > SHARE * clearance)
    unsure = ""
    begins = [free, *(int(k) + 1 for k in outside if k >= free)]
    for first in begins:
        if first >= len(time) or time[first] > WITHIN:
            break
        leaves = outside[outside >= first]
        end = time[leaves[0]] if len(leaves) else time[-1]
        if end - time[first] < hold:
            continue
        if not len(leaves) and not _grows(time[first:], radius[first:], SHARE * clearance):
            return CaptureVerdict("captured", float(time[first]), last, peak)
        unsure = "leaves half the clearance again" if len(leaves) else "moves ever farther"
    if unsure:
        return CaptureVerdict(f"undecided: cannot tell yet, it {unsure}", None, last, peak)
    if not len(time) or time[-1] < WITHIN + hold:
        return CaptureVerdict("undecided: the run ends too early", None, last, peak)
    why = lost or ("not lifted" if touching.mean() > LASTING else "rebounds")
    return CaptureVerdict(f"lost: {why}", None, last, peak)


def _grows(time: np.ndarray, radius: np.ndarray, limit: float) -> bool:
    """Whether a radius (n,) that grows on as over the last quarter exceeds `limit` (m) within WITHIN.

    Quarters shorter than HOLD show beats, not growth.
    """
    quarter = 0.25 * float(time[-1] - time[0])
    if quarter < HOLD:
        return False
    third, last = (
        float(
            radius[(time > time[-1] - k * quarter) & (time <= time[-1] - (k - 1) * quarter)].max(
                initial=0.0
            )
        )
        for k in (2, 1)
    )
    if not last > third > 0.0:
        return False  # also where a quarter has no rows
    # logarithms, since the growth over WITHIN may be beyond any number
    rise = math.log(last) - math.log(third)
    return math.log(last) + rise * WITHIN / quarter > math.log(limit)


def add_captures(
    summary: Summary,
    system: ReadableSystem,
    recording: Recording,
    zero: float,
    seats: Mapping[str, Attachment],
) -> None:
    """Add the verdicts on a rotor that was to be levitated again; nothing to a summary of others.

    zero: s on the simulation's clock; seats: by name; the summary has their whirls already. Raises
    NotRecordedError where motion or force was not recorded.
    """
    times = _values_of(system, COMMANDED)
    if not times or max(times) < 0.0:
        return
    command = max(times) - zero
    for name, a in seats.items():
        if f"{a.bearing}.clearance" not in system:
            continue
        one = _at_seat(system, recording, command, a, _loss_reason(system, name, summary))
        values = one.words, one.after, one.last_contact, one.peak_force
        keys = "capture", "capture_time", "capture_last_contact", "capture_peak_force"
        enter(summary, dict(zip(keys, values, strict=True)), Owner.SEAT, name)
        enter(summary, {"capture_command_time": command})


def coils(system: ReadableSystem) -> dict[str, object]:
    """What actuators and controllers went through over the run; nothing where there are none."""
    variables = COILS | {"time_at_controller_limit": LIMITED}
    values = {key: _values_of(system, variable) for key, variable in variables.items()}
    return {key: max(found) for key, found in values.items() if found}


def _values_of(system: ReadableSystem, variable: str) -> list[float]:
    """The values at the end of all components' variables of that name."""
    return [
        system.value(f"{name}.{variable}") for name in system.components if f"{name}.{variable}" in system
    ]


def _loss_reason(system: ReadableSystem, name: str, summary: Summary) -> str:
    """Why a rotor that is not captured is lost; "": not known yet."""
    if any(gap <= 0.0 for gap in _values_of(system, GAP)):
        return "through the gap"
    words = verdict_class(summary["seats"][name].get("whirl") or "")
    return "whirl" if kind_of_whirl(words) is WhirlKind.SUSTAINED else ""


def _at_seat(
    system: ReadableSystem, recording: Recording, command: float, a: Attachment, lost: str
) -> CaptureVerdict:
    x, y = (recording[a.motion(axis)] for axis in "xy")
    port = housing_port(system, a.bearing)
    if port and f"{port}.x" in recording:
        x, y = x - recording[f"{port}.x"], y - recording[f"{port}.y"]
    force = np.hypot(recording[a.load("fx")], recording[a.load("fy")])
    speed = abs(system.value(a.motion("omega"))) if a.motion("omega") in system else np.inf
    hold = max(HOLD, 2.0 * np.pi * TURNS / max(speed, 2.0 * np.pi * TURNS / WITHIN))
    clearance = system.value(f"{a.bearing}.clearance")
    return judge(recording.time - command, np.hypot(x, y), force, clearance, hold, lost)
