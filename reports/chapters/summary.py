"""The verdict, on what it rests, and the figures that are asked for first."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator

from ...bearings import rating
from ...master.common.errors import Ended
from ...master.coupling.connections import Attachment
from ...master.quantities import INVALID, Item, Owner, named, owned, summary_items
from ...master.results.headline import NO_VERDICT, NOT_ACCURATE
from ...master.results.least_gaps import closed
from ...master.results.ratings import Rated, rated
from ...master.results.required import Judged, beside, judged
from ...master.results.whirl.evidence import evidence, unbalanced
from ...master.scene.gaps import RotorGap
from ...master.scene.requirements import SENSITIVITY
from ...studies.rotor.supports import balanced
from ..layout import Absent, Data
from ..numbers import NONE, capital, digits, heads, percentage, quantity, speed, spelt
from ..subject import Subject
from .bearings import left_out

OPTION = re.compile(r"(--set (?:\"[^\"]*\"|[^\s;]+))")  # of a command, in a warning
CODE = r"`\1`"
SPINNING_SHARE = 0.5  # of the speed at the shutdown; above it the end of the run is not the end of the drop


def summary(subject: Subject) -> Data:
    """Verdicts and first figures."""
    result = subject.result
    return {
        "limits": _limits(subject),
        "elsewhere": _of_loops(subject),
        "figures": list(_tiles(subject)),
        **_caveats(subject),
        "verdict_heads": heads((*FIRST, *WHIRL)),
        "verdicts": [_verdict_row(subject, a) for a in subject.seats],
        "evidence": [f"{capital(line)}." for line in evidence(subject.summary)] if subject.seats else [],
        "gaps": [_gap_row(subject, gap) for gap in result.scene.gaps],
    }


def _limits(subject: Subject) -> list[Data]:
    """What is required, each with its value, its limit and a bar; what fails comes first."""
    return [
        {
            "label": capital(one.item.words),
            "late": _is_late(subject, Item(named("margin")[0], one.requirement.key).path),
            "value": spelt(one.value) or NONE,
            "note": spelt(f"{one.bound}; {one.left()}" if one.value else f"{one.bound}; no such figure"),
            "used": round(100.0 * one.used),
            "met": one.met,
        }
        for one in sorted(_judged(subject), key=lambda one: one.met)
    ]


def requirements(subject: Subject) -> Data:
    """The scene's requirements beside the results. Raises Absent where it has none."""
    wanted = [spelt(one.words()) for one in _judged(subject)]
    wanted += [f"{one}: judged by `touchdown amb-margins`" for one in _of_loops(subject)]
    if wanted:
        return {"wanted": [f"{capital(one)}." for one in wanted]}
    raise Absent("the scene requires nothing; [requirements] in its file is where it would.")


def _of_loops(subject: Subject) -> list[str]:
    """What is required of the magnetic bearings' loops."""
    of_loops = [one for one in subject.result.scene.requirements if one.kind == SENSITIVITY]
    return [spelt(f"{one.item.words}, {one.bound}") for one in (beside(one, None) for one in of_loops)]


def _judged(subject: Subject) -> list[Judged]:
    return judged(subject.result.scene.requirements, subject.summary)


PEAKS = (
    *("first_impact_contact_force", "peak_contact_force", "peak_face_force", "peak_ball_force"),
    *("largest_displacement", "peak_bending_stress"),
)


Figure = tuple[str, str, str, bool]  # that is seen first: label, value, note, whether no longer valid


def _tiles(subject: Subject) -> Iterator[Figure]:
    known = [i for i in summary_items(subject.summary) if i.of(subject.summary) is not None]
    limited = {one.quantity.key for one in _judged(subject) if not one.requirement.of}
    if subject.fall is not None:
        yield "First contact", quantity(subject.fall, "s"), "after the shutdown", False
    for key in PEAKS:
        if key not in limited and (found := [i for i in known if i.quantity.key == key]):
            i = max(found, key=lambda i: i.of(subject.summary))
            place = f"{'in' if i.quantity.owner is Owner.COMPONENT else 'at'} {i.name}"
            note = "; ".join(filter(None, (place, subject.firmness(i))))
            value = quantity(i.of(subject.summary), i.quantity.unit, 3)
            yield capital(i.quantity.words), value, note, _is_late(subject, i.path)
    yield from _rated(subject, limited)
    if "least_gap" not in limited and (least := subject.summary.get("least_gap")) is not None:
        label = "Least gap left" if least > 0.0 else "A gap closes: beyond it by"
        place = f"at {subject.summary['least_gap_at']}"
        yield label, quantity(abs(least), "m", 3), place, _is_late(subject, "least_gap")
    if subject.first_contact is not None:
        settled = subject.summary.get("settling_time")
        when = "not in this run" if settled is None else "after the shutdown"
        yield "Settled", quantity(settled, "s", 3), when, _is_late(subject, "settling_time")
    for i in known:
        if i.quantity.key == "speed_end":
            note = f"{i.name}, after {quantity(subject.length, 's')}"
            yield (
                capital(i.quantity.words),
                speed(i.of(subject.summary), 4),
                note,
                _is_late(subject, i.path),
            )


def _is_late(subject: Subject, path: str) -> bool:
    return path in (subject.summary.get(INVALID) or ())


def _rated(subject: Subject, limited: Container[str]) -> Iterator[Figure]:
    """The largest ball load in terms of the races' ratings, but for quantities that are `limited`."""
    ratings = [(one, a) for a in subject.seats if isinstance(one := rated(subject.run, a), Rated)]
    if subject.first_contact is None or not ratings:
        return
    one, a = min(ratings, key=lambda pair: pair[0].safety)
    pressure = max(one.peak_pressure(race) for race in (rating.INNER, rating.OUTER))
    seat = f"{Owner.SEAT}.{subject.name(a)}"
    if (key := "largest_ball_pressure") not in limited:
        late = _is_late(subject, f"{seat}.{key}")
        yield "Largest Hertz pressure", quantity(pressure, "Pa", 3), _at(subject, a), late
    if (key := "lowest_static_safety") not in limited:
        note = f"{_at(subject, a)}, {one.safety_by}"
        yield (
            "Lowest static safety, estimate",
            digits(one.safety, 3),
            note,
            _is_late(subject, f"{seat}.{key}"),
        )
    what, how_near = one.ends_by
    seized = [(time, b) for b in subject.seats if (time := subject.seat(b).get("seized_time")) is not None]
    if seized:
        time, a = min(seized, key=lambda pair: pair[0])
        what, how_near = "a seizure", f"in this drop, {quantity(time, 's', 3)} after the shutdown"
    yield (
        "What ends a bearing first",
        what,
        f"{_at(subject, a)}, {how_near}",
        (_is_late(subject, f"{Owner.SEAT}.{subject.name(a)}.bearing_ends_by")),
    )


def _at(subject: Subject, a: Attachment) -> str:
    return f"at {subject.name(a)}"


FIRST = "first_contact_time", "first_impact_contact_force", "peak_contact_force"
WHIRL = "whirl_revolutions", "whirl_frequency"


def _verdict_row(subject: Subject, a: Attachment) -> list[str]:
    seat = subject.name(a)
    return [
        f"{seat} ({a.bearing})",
        subject.seat(a).get("whirl") or NO_VERDICT,
        _settled(subject, a),
        subject.firmness(Item(named("peak_contact_force")[0], seat)),
        *subject.cells(a, FIRST),
        *(subject.cells(a, WHIRL) if subject.seat(a).get("whirl_revolutions") else (NONE, NONE)),
    ]


def _gap_row(subject: Subject, gap: RotorGap) -> list[str]:
    found = owned(subject.summary, Owner.GAP)[gap.name].get
    late = _is_late(subject, f"{Owner.GAP}.{gap.name}.least")
    return [
        gap.name,
        quantity(gap.size, "m") + (" along the shaft" if gap.axial else ""),
        f"{gap.at} against {gap.stator or 'space'}",
        quantity(found("least"), "m", 3) + (" (not valid)" if late else ""),
        quantity(found("least_time"), "s", 3),
        speed(found("least_rotor_speed"), 4),
        quantity(found("touches"), "1", 3),
    ]


def _settled(subject: Subject, a: Attachment) -> str:
    """When and how a seat settles, in words."""
    words, seized = map(subject.seat(a).get, ("settled", "seized_time"))
    words = words or NO_VERDICT
    return words if seized is None else f"seized at {quantity(seized, 's', 3)}; {words}"


def _caveats(subject: Subject) -> Data:
    """Reservations about the figures."""
    result = subject.result
    energy_made = subject.summary["energy_made_of_turnover"] or 0.0
    turned = unbalanced(subject.run.system)
    longer = subject.summary["proposed_duration"]
    return {
        "ended": "" if result.ended is Ended.COMPLETED else result.ended.value,
        "because": result.stopped_because,
        "warnings": _warnings(subject),
        "made": percentage(abs(energy_made)) if abs(energy_made) > NOT_ACCURATE else "",
        "gained": energy_made > 0.0,
        "one_phase": bool(turned and subject.seats) and not balanced(result.scene, turned),
        "longer": None if longer is None else quantity(longer, "s"),
        "left_out": list(left_out(subject)),
        "end": quantity(subject.length, "s"),
        "spins": _still_turning(subject),
    }


def _warnings(subject: Subject) -> list[str]:
    """What a run warns of, as sentences on seats, each once; what the headline has is not said again."""
    seats, texts = {a.bearing: subject.name(a) for a in subject.seats}, dict[str, None]()
    said = closed(subject.result.scene, subject.summary)
    for warning in (one for one in subject.result.warnings if one not in said):
        name, _, text = warning.partition(": ")
        texts[f"at {seats[name]} {text}" if name in seats else warning] = None
    return [f"{capital(OPTION.sub(CODE, spelt(text))).rstrip('.')}." for text in texts]


def _still_turning(subject: Subject) -> tuple[str, str] | None:
    """The rotor's speed at the end and at the start, where it has much of it left; None: it has not."""
    if subject.first_contact is None:
        return None
    name = subject.seats[0].motion("omega")
    if name not in subject.run.recording:
        return None
    spin = abs(subject.run.recording[name])
    still = spin[-1] > SPINNING_SHARE * spin[0] > 0.0
    return (speed(float(spin[-1]), 4), speed(float(spin[0]), 4)) if still else None
