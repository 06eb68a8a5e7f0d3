"""Results of a sweep: as a table, short or of all quantities, as counts of verdicts, as a file."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from itertools import groupby
from pathlib import Path
from statistics import median
from typing import Any

from ...master.common.errors import Ended, TouchdownError, one_of
from ...master.common.text import aligned, percent
from ...master.quantities import Item, Owner, most, named, quantities, summary_items
from ...master.results.capture import Fate, fate
from ...master.results.required import margin_words
from ...master.results.table import WIDEST, shown_value
from ...master.results.whirl.verdict import (
    CONFIDENCE,
    Share,
    clopper_pearson,
    has_verdict,
    verdict_class,
    worst_whirl,
)
from ...master.scene.requirements import limited
from ...modelkit.kernel.writing import replacing_text
from .design import number_and_unit
from .members import Member, without_costs

MAX_ROWS = 40  # shown; all are in the file
MAX_REASONS = 5  # why members failed, or are warned of
MAX_BESIDE = 6  # members beside each other, where all of their quantities are shown
MAX_NAME = 28  # of a setting in a head; one of several names is cut

VERDICTS = "whirl", "capture"  # in words
DEFAULT_FIGURES = (  # shown beside the verdicts where none are asked for
    "whirl_revolutions",
    "first_impact_contact_force",
    "peak_contact_force",
    "peak_ball_force",
    "peak_face_force",
    "settling_time",
    "pendulum_frequency",
    "speed_end",
)
SHORT = {  # columns of the short table, by the quantity; of several seats the worst counts
    "first_impact_contact_force": "first impact",
    "peak_contact_force": "largest force",
    "peak_ball_force": "most loaded ball",
    "peak_face_force": "face",
    "lowest_static_safety": "safety",
    "least_gap": "least gap",
    "settling_time": "settled",
}


def items_of(members: Sequence[Member]) -> list[Item]:
    """All that any member has, in the order of groups."""
    return summary_items(*(member.summary for member in members))


def quantity_lines() -> Iterator[str]:
    """The quantities of runs by groups: key, of what, SI unit, unit in which people read it, words."""
    known = quantities()
    rows = [(f"  {q.key}", q.owner.name.lower(), q.unit, q.read_in, q.words) for q in known]
    head, *lines = aligned([("", "of", "SI", "read in", ""), *rows])
    yield head
    for group, of_group in groupby(zip(known, lines, strict=True), lambda pair: pair[0].group):
        yield from (group, *(line for _, line in of_group))


def _verdict_items(members: Sequence[Member]) -> list[Item]:
    """The verdicts in words that any member has."""
    verdicts = [item for item in items_of(members) if item.quantity.key in VERDICTS]
    return [item for item in verdicts if any(item.of(m.summary) is not None for m in members)]


def verdict_lines(members: Sequence[Member]) -> list[str]:
    """How many members have each verdict, the most frequent first."""
    lines = []
    for item in _verdict_items(members):
        words = [found for m in members if (found := item.of(m.summary)) is not None]
        if item.quantity.key == "whirl":
            words = map(verdict_class, words)  # however near to a turn they came
        counts = Counter(words).most_common()
        lines.append(f"  {item.words}: " + ", ".join(f"{n} x {verdict}" for verdict, n in counts))
    return lines


def capture_lines(members: Sequence[Member]) -> list[str]:
    """How many rotors are captured of those that were asked for again; none where none was.

    The worst seat counts, and what is undecided is not captured: a run that ends too early tells captures
    only.
    """
    fates = [one for m in members if not m.failed and (one := fate(m.summary)) is not None]
    if not fates:
        return []
    undecided = fates.count(Fate.UNDECIDED)
    more = f", {undecided} undecided, which count as not captured" if undecided else ""
    return [f"  captured: {_passing([one is Fate.CAPTURED for one in fates])}{more}"]


def requirement_lines(members: Sequence[Member]) -> list[str]:
    """How many members meet all that the scene requires, and each of it; none where it requires nothing.

    Drops that failed meet nothing; those that were not run, or were interrupted, do not count.
    """
    judged = [m for m in members if m.ended is not Ended.INTERRUPTED]
    if not any("requirements_met" in m.summary for m in judged):
        return []
    lines = [f"  requirements met: {_passing([m.meets for m in judged])}"]
    for item in items_of(judged):
        if item.quantity.owner is not Owner.REQUIREMENT:
            continue
        margins = [None if m.failed else item.of(m.summary) for m in judged]
        known = [margin for margin in margins if margin is not None]
        passing = _passing([margin is not None and margin >= 0.0 for margin in margins])
        worst = (
            f", margin {margin_words(min(known))} at worst, {margin_words(median(known))} in the median"
            if known
            else ""
        )
        lines.append(f"    {limited(item.name).words}: {passing}{worst}")
    return lines


def _passing(met: Sequence[bool]) -> str:
    """How many of independent drops, with the interval of their share."""
    return f"{sum(met)} of {len(met)} ({with_interval(clopper_pearson(sum(met), len(met)))})"


def with_interval(share: Share) -> str:
    """A share of drops and its interval."""
    low, high = percent(share.low), percent(share.high)
    return f"{percent(share.value)}; {low} to {high} with {CONFIDENCE:.0%} confidence"


def refuse_picks(picks: Iterable[str]) -> None:
    """Raise TouchdownError for one that matches no declared quantity by its key or its path."""
    keys = {one.key for one in quantities()}
    for pick in picks:
        pattern = re.sub(r"\[.[^]]*\]", "?", pick)
        name = (*pattern.split("."), "*")[1]  # of any seat
        paths = {Item(one, name if one.owner else "").path for one in quantities()}
        if not any(fnmatchcase(text, pattern) for text in keys | paths):
            raise TouchdownError(f"--pick {pick}: there is no such quantity; {one_of(pick, keys)}")


def picked(members: Sequence[Member], picks: Iterable[str]) -> tuple[list[Item], list[str]]:
    """What matches `picks` by its key or its path (* for anything), or what tells most, and complaints."""
    known = items_of(members)
    names = {item.quantity.key for item in known}
    requested = list(picks)
    chosen = [] if requested else _verdict_items(members)
    complaints: list[str] = []
    for pick in requested or DEFAULT_FIGURES:
        matches = [i for i in known if fnmatchcase(i.quantity.key, pick) or fnmatchcase(i.path, pick)]
        chosen += matches
        if requested and known and not matches:
            complaints.append(f"no drop has a quantity {pick}; {one_of(pick, names)}")
    return list(dict.fromkeys(chosen)), complaints


def report_lines(
    members: Sequence[Member], picks: Sequence[str], everything: bool = False
) -> tuple[list[str], list[str]]:
    """The command's lines on a sweep, and complaints about `picks`, the requested quantities."""
    complaints: list[str] = []
    if picks:
        chosen, complaints = picked(members, picks)
        lines = [table(members, chosen)]
    else:
        lines = [whole_table(members) if everything else short_table(members)]
    lines += [*verdict_lines(members), *capture_lines(members), *requirement_lines(members)]
    lines += [f"  {name} changes nothing in these drops" for name in without_effect(members)]
    if why := failures(members):
        lines += ["failed:", *why]
    if reasons := warned(members):
        lines += ["warnings:", *reasons]
    return lines, complaints


def without_effect(members: Sequence[Member]) -> list[str]:
    """Settings that change nothing where all others stay the same, but for what a run cost."""
    ended = [m for m in members if not m.failed]
    return [name for name in (members[0].settings if members else ()) if _is_without_effect(name, ended)]


def _is_without_effect(name: str, members: Sequence[Member]) -> bool:
    alike: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for m in members:
        others = tuple(f"{key}={value}" for key, value in m.settings.items() if key != name)
        alike.setdefault(others, []).append(without_costs(m.summary))
    runs = [summaries for summaries in alike.values() if len(summaries) > 1]
    return bool(runs) and all(one == summaries[0] for summaries in runs for one in summaries)


def failures(members: Sequence[Member]) -> list[str]:
    """Why members failed, the most frequent reasons first, each with the first member that has it."""
    return _most_frequent([(m.number, m.failed) for m in members if m.failed])


def warned(members: Sequence[Member]) -> list[str]:
    """The warnings of runs, the most frequent first, each with the first member that has it."""
    return _most_frequent([(m.number, warning) for m in members for warning in m.warnings])


def _most_frequent(texts: Sequence[tuple[int, str]]) -> list[str]:
    """Of members' numbers and what is said of them: a line each, how often, and of whom first."""
    counts = Counter(what for _, what in texts)
    first = {what: number for number, what in reversed(texts)}
    lines = [f"  {n} x {what} (drop {first[what]})" for what, n in counts.most_common(MAX_REASONS)]
    return (
        lines if len(counts) <= MAX_REASONS else [*lines, f"  and {len(counts) - MAX_REASONS} reasons more"]
    )


def short_table(members: Sequence[Member]) -> str:
    """A line for each of the first members, with what a designer acts on, of several bearings the worst."""
    if not members:
        return "no drops"
    known = items_of(members)
    columns = [key for key in SHORT if any(item.quantity.key == key for item in known)]
    judged = any("requirements_met" in m.summary for m in members)
    heads = [_two_lines(name) for name in members[0].settings]
    units = {key: named(key)[0].read_in for key in columns}
    heads += [("whirl", ""), *((SHORT[key], unit and f"[{unit}]") for key, unit in units.items())]
    heads += [("require-", "ments")] if judged else []
    rows = [["", *(head[line] for head in heads), ""] for line in (0, 1)]
    for m in members[:MAX_ROWS]:
        verdict = worst_whirl(m.summary) or ("no" if has_verdict(m.summary) else "-")
        row = [str(m.number), *map(str, m.settings.values()), verdict]
        found = {key: most(m.summary, key) for key in columns}
        row += ["-" if v is None else f"{named(key)[0].factor * v:.4g}" for key, v in found.items()]
        row += ["-" if m.failed else "met" if m.meets else "not met"] if judged else []
        rows.append([*row, f"failed: {m.failed}" if m.failed else ""])
    seats = {item.name for item in known if item.quantity.owner is Owner.SEAT}
    several = "of several bearings the worst; " if len(seats) > 1 else ""
    text = _and_more(aligned(rows, ">" * len(heads) + "><"), len(members) - MAX_ROWS)
    picks = f'--pick "*": all {len(known)} quantities, --pick KEY: some of them'
    return f"{text}\n{several}{picks}; keys: touchdown scenes --quantities"


def _two_lines(name: str) -> tuple[str, str]:
    """A setting's name over two lines of a head: of whom, and what."""
    whose, _, what = name.partition(".")
    return f"{whose}.", what if len(what) <= MAX_NAME else f"{what[:MAX_NAME]}..."


def whole_table(members: Sequence[Member]) -> str:
    """All quantities by their groups, a line each, of the first members beside each other."""
    if not members:
        return "no drops"
    beside = members[:MAX_BESIDE]
    rows = [["", *(f"drop {m.number}" for m in beside)]]
    rows += [[f"  {name}", *(str(m.settings[name]) for m in beside)] for name in members[0].settings]
    for group, of_group in groupby(items_of(members), lambda item: item.quantity.group):
        rows.append([group])
        rows += [[f"  {i.head}", *(_cut(shown_value(i, m.summary)) for m in beside)] for i in of_group]
    return _and_more(aligned(rows, "<>"), len(members) - MAX_BESIDE)


def _cut(text: str) -> str:
    return text if len(text) <= WIDEST else f"{text[: WIDEST - 3]}..."


def table(members: Sequence[Member], chosen: Sequence[Item]) -> str:
    """A line for each of the first members: number, what was set, what is `chosen`, and why it failed."""
    if not members:
        return "no drops"
    names = list(members[0].settings)
    rows = [["", *names, *(item.head for item in chosen), ""]]
    for m in members[:MAX_ROWS]:
        row = [str(m.number), *(str(m.settings[name]) for name in names)]
        row += [shown_value(item, m.summary) for item in chosen]
        rows.append([*row, f"failed: {m.failed}" if m.failed else ""])
    return _and_more(aligned(rows, ">" * (len(rows[0]) - 1) + "<"), len(members) - MAX_ROWS)


def _and_more(lines: list[str], left: int) -> str:
    """Lines, and how many members are `left` that have none."""
    return "\n".join([*lines, *([f"... and {left} more"] if left > 0 else [])])


def write_table(members: Sequence[Member], path: Path) -> None:
    """All quantities of all members in SI; a varied number stands in the unit its column names, or SI.

    An older table is replaced when the new one is whole. Raises OSError.
    """
    names, known = list(members[0].settings) if members else [], items_of(members)
    columns = {name: column(name, [m.settings[name] for m in members]) for name in names}
    with replacing_text(path) as file:
        writer = csv.writer(file)
        titles = (*(title for title, _ in columns.values()), *map(titled, known))
        writer.writerow(["member", *titles, "failed"])
        for i, m in enumerate(members):
            cells = [counted(item.of(m.summary)) for item in known]
            writer.writerow([m.number, *(values[i] for _, values in columns.values()), *cells, m.failed])


def titled(item: Item) -> str:
    """Of a column: the path, and the SI unit where there is one."""
    unit = item.quantity.unit
    return f"{item.path} [{unit}]" if unit not in ("", "1") else item.path


def column(name: str, values: Sequence[object]) -> tuple[str, list[object]]:
    """Title and cells: bare numbers where all have the same unit, else what was given."""
    parts = [number_and_unit(value) for value in values]
    units = {part[1] for part in parts if part is not None}
    if None in parts or len(units) != 1:
        return name, list(values)
    unit = units.pop()
    return f"{name} [{unit}]" if unit else name, [part[0] for part in parts if part is not None]


def counted(value: object) -> object:
    """Of a list, such as a whirl's episodes, the number."""
    return len(value) if isinstance(value, list) else value
