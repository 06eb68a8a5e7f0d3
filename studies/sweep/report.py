"""Results of a sweep: as a table, short or of all figures, as counts of verdicts, as a file."""

from __future__ import annotations

import csv
import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from statistics import median
from typing import NamedTuple

from ...master.common.errors import Ended, one_of
from ...master.common.units import percent
from ...master.results.capture import Fate, capture_keys, fate
from ...master.results.requirements import MARGIN, MET
from ...master.results.table import WIDEST, aligned, bearings_of, by_group, shown
from ...master.results.whirl.verdict import (
    CONFIDENCE,
    TURNS,
    clopper_pearson,
    has_verdict,
    verdict_class,
    whirling,
)
from ...master.scene.requirements import KINDS
from ...modelkit.kernel.writing import replacing_text
from .design import number_and_unit
from .members import COSTS, Member

MAX_ROWS = 40  # shown; all are in the file
MAX_REASONS = 5  # why members failed, or are warned of
MAX_BESIDE = 6  # members beside each other, where all their figures are shown
MAX_NAME = 28  # of a setting in a head; one of several names is cut

DEFAULT_FIGURES = (  # shown beside the verdicts where none are asked for
    "whirl_*_revolutions",
    "first_impact_contact_force_N*",
    "peak_contact_force_N*",
    "peak_ball_force_N*",
    "peak_face_force_N*",
    "settling_time_s*",
    "pendulum_frequency_Hz*",
    "rotor_speed_end_rpm*",
)


class Short(NamedTuple):
    """A column of the short table: of the bearings' figures the one that counts."""

    head: str
    unit: str
    key: str  # what they begin with
    least: bool = False  # which is the worst


SHORT = (
    Short("first impact", "[N]", "first_impact_contact_force_N"),
    Short("largest force", "[N]", "peak_contact_force_N"),
    Short("most loaded ball", "[N]", "peak_ball_force_N"),
    Short("face", "[N]", "peak_face_force_N"),
    Short("safety", "", "lowest_static_safety", least=True),
    Short("least gap", "[um]", "least_gap_um", least=True),
    Short("settled", "[s]", "settling_time_s"),
)


def keys(members: Sequence[Member]) -> list[str]:
    """All figures that any member has, grouped as a run's are."""
    found = dict.fromkeys(key for member in members for key in member.summary)
    return [key for group in by_group(found).values() for key in group]


def verdict_keys(members: Sequence[Member]) -> list[str]:
    """Figures that are verdicts in words, such as whirl_A and capture_A."""
    known = keys(members)
    whirls = [key for key in known if key.startswith("whirl_") and f"{key}{TURNS}" in known]
    return [
        *(key for key in whirls if any(isinstance(m.summary.get(key), str) for m in members)),
        *dict.fromkeys(key for m in members for key in capture_keys(m.summary)),
    ]


def verdict_lines(members: Sequence[Member]) -> list[str]:
    """How many members have each verdict, the most frequent first."""
    lines = []
    for key in verdict_keys(members):
        words = [str(m.summary[key]) for m in members if m.summary.get(key) is not None]
        if key.startswith("whirl_"):
            words = list(map(verdict_class, words))  # however near to a turn they came
        counts = Counter(words)
        lines.append(f"  {key}: " + ", ".join(f"{n} x {verdict}" for verdict, n in counts.most_common()))
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
    if not any(MET in m.summary for m in judged):
        return []
    lines = [f"  requirements met: {_passing([m.meets for m in judged])}"]
    for key in (key for key in keys(judged) if key.startswith(MARGIN)):
        margins = [None if m.failed else m.summary.get(key) for m in judged]
        known = [margin for margin in margins if isinstance(margin, float)]
        passing = _passing([isinstance(margin, float) and margin >= 0.0 for margin in margins])
        worst = (
            f", margin {percent(min(known))} at worst, {percent(median(known))} in the median"
            if known
            else ""
        )
        lines.append(f"    {KINDS[key.removeprefix(MARGIN)].meaning}: {passing}{worst}")
    return lines


def _passing(met: Sequence[bool]) -> str:
    """How many of independent drops, with the interval of their share."""
    one = clopper_pearson(sum(met), len(met))
    interval = f"{percent(one.low)} to {percent(one.high)} with {CONFIDENCE:.0%} confidence"
    return f"{sum(met)} of {len(met)} ({percent(one.value)}; {interval})"


def picked(members: Sequence[Member], picks: Iterable[str]) -> tuple[list[str], list[str]]:
    """Figures that match `picks` (names, * for anything), or a few that tell most, and complaints."""
    known = keys(members)
    wanted = list(picks)
    chosen = [] if wanted else verdict_keys(members)
    complaints: list[str] = []
    for pick in wanted or DEFAULT_FIGURES:
        matches = [key for key in known if fnmatchcase(key, pick)]
        chosen += matches
        if wanted and known and not matches:
            complaints.append(f"no drop has a figure {pick}; {one_of(pick, known)}")
    return list(dict.fromkeys(chosen)), complaints


def report_lines(
    members: Sequence[Member], picks: Sequence[str], everything: bool = False
) -> tuple[list[str], list[str]]:
    """The command's lines on a sweep, and complaints about `picks`, the requested figures."""
    complaints: list[str] = []
    if picks:
        figures, complaints = picked(members, picks)
        lines = [table(members, figures)]
    else:
        lines = [whole_table(members) if everything else short_table(members)]
    lines += [*verdict_lines(members), *capture_lines(members), *requirement_lines(members)]
    lines += [f"  {name} changes no figure of these drops" for name in without_effect(members)]
    if why := failures(members):
        lines += ["failed:", *why]
    if reasons := warned(members):
        lines += ["warnings:", *reasons]
    return lines, complaints


def without_effect(members: Sequence[Member]) -> list[str]:
    """Settings that change no figure where all others stay the same, but for what a run cost."""
    ended = [m for m in members if not m.failed]
    return [name for name in (members[0].settings if members else ()) if _is_without_effect(name, ended)]


def _is_without_effect(name: str, members: Sequence[Member]) -> bool:
    alike: dict[tuple[str, ...], list[Mapping[str, object]]] = {}
    for m in members:
        others = tuple(f"{key}={value}" for key, value in m.settings.items() if key != name)
        figures = {key: value for key, value in m.summary.items() if key not in COSTS}
        alike.setdefault(others, []).append(figures)
    runs = [figures for figures in alike.values() if len(figures) > 1]
    return bool(runs) and all(one == figures[0] for figures in runs for one in figures)


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


def largest(summary: Mapping[str, object], key: str) -> float | None:
    """The largest of the figures whose names begin with `key`; None where there is none."""
    found = [value for name, value in summary.items() if name.startswith(key)]
    numbers = [value for value in found if isinstance(value, float) and math.isfinite(value)]
    return max(numbers, default=None)


def short_table(members: Sequence[Member]) -> str:
    """A line for each of the first members, with what a designer acts on, of several bearings the worst."""
    if not members:
        return "no drops"
    known = keys(members)
    columns = [one for one in SHORT if any(key.startswith(one.key) for key in known)]
    judged = any(MET in m.summary for m in members)
    heads = [_two_lines(name) for name in members[0].settings]
    heads += [("whirl", ""), *((one.head, one.unit) for one in columns)]
    heads += [("require-", "ments")] if judged else []
    rows = [["", *(head[line] for head in heads), ""] for line in (0, 1)]
    for m in members[:MAX_ROWS]:
        verdict = whirling(m.summary) or ("no" if has_verdict(m.summary) else "-")
        row = [
            str(m.number),
            *map(str, m.settings.values()),
            verdict,
            *(_worst(m.summary, s) for s in columns),
        ]
        row += ["-" if m.failed else "met" if m.meets else "not met"] if judged else []
        rows.append([*row, f"failed: {m.failed}" if m.failed else ""])
    several = "of several bearings the worst; " if bearings_of(known) else ""
    lines = _numbers(rows)
    text = _and_more(lines, len(members) - MAX_ROWS)
    return f'{text}\n{several}--pick "*": all {len(known)} figures, --pick KEY: some of them'


def _two_lines(name: str) -> tuple[str, str]:
    """A setting's name over two lines of a head: of whom, and what."""
    whose, _, what = name.partition(".")
    return f"{whose}.", what if len(what) <= MAX_NAME else f"{what[:MAX_NAME]}..."


def _worst(summary: Mapping[str, object], column: Short) -> str:
    """Of the figures of a `column` the one that counts, as text; the whole drop's where there is one."""
    by_bearing = [value for key, value in summary.items() if key.startswith(column.key)]
    found = [summary[column.key]] if column.key in summary else by_bearing
    numbers = [float(v) for v in found if isinstance(v, (int, float)) and math.isfinite(v)]
    if not numbers:
        return "-"
    return f"{min(numbers) if column.least else max(numbers):.4g}"


def whole_table(members: Sequence[Member]) -> str:
    """All figures by their groups, a line each, of the first members beside each other."""
    if not members:
        return "no drops"
    beside = members[:MAX_BESIDE]
    rows = [["", *(f"drop {m.number}" for m in beside), ""]]
    rows += [[f"  {name}", *(str(m.settings[name]) for m in beside), ""] for name in members[0].settings]
    for group, figures in by_group(keys(members)).items():
        rows.append([group, *("" for _ in beside), ""])
        rows += [
            [f"  {key}", *(_cut(shown(m.summary.get(key), key)) for m in beside), ""] for key in figures
        ]
    return _and_more(aligned(rows, "<>"), len(members) - MAX_BESIDE)


def _cut(text: str) -> str:
    return text if len(text) <= WIDEST else f"{text[: WIDEST - 3]}..."


def table(members: Sequence[Member], figures: Sequence[str]) -> str:
    """A line for each of the first members: number, what was set, `figures`, and why it failed."""
    if not members:
        return "no drops"
    names = list(members[0].settings)
    rows = [["", *names, *figures, ""]]
    for m in members[:MAX_ROWS]:
        row = [str(m.number), *(str(m.settings[name]) for name in names)]
        row += [shown(m.summary.get(key), key) for key in figures]
        rows.append([*row, f"failed: {m.failed}" if m.failed else ""])
    return _and_more(_numbers(rows), len(members) - MAX_ROWS)


def _numbers(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows of numbers as lines; the last cell says why there are none."""
    return aligned(rows, ">" * (len(rows[0]) - 1) + "<")


def _and_more(lines: list[str], left: int) -> str:
    """Lines, and how many members are `left` that have none."""
    return "\n".join([*lines, *([f"... and {left} more"] if left > 0 else [])])


def write_table(members: Sequence[Member], path: Path) -> None:
    """All figures of all members; a varied number stands in the unit its column names, or SI.

    An older table is replaced when the new one is whole. Raises OSError.
    """
    names, figures = list(members[0].settings) if members else [], keys(members)
    columns = {name: column(name, [m.settings[name] for m in members]) for name in names}
    with replacing_text(path) as file:
        writer = csv.writer(file)
        writer.writerow(["member", *(title for title, _ in columns.values()), *figures, "failed"])
        for i, m in enumerate(members):
            cells = [counted(m.summary.get(key)) for key in figures]
            writer.writerow([m.number, *(values[i] for _, values in columns.values()), *cells, m.failed])


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
