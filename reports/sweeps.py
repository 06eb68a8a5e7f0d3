"""The report of a sweep: how many of its drops whirl, how hard they hit, and over which settings."""

from __future__ import annotations

import math
import re
import shlex
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..master.common.errors import Ended, TouchdownError
from ..master.common.text import as_given, display_value, joined
from ..master.quantities import Item, Owner, finite_number, most, owned, summary_items
from ..master.results.capture import Fate
from ..master.results.required import Judged, judged
from ..master.results.whirl.evidence import earliest_contact
from ..master.results.whirl.verdict import clopper_pearson, has_verdict, worst_whirl
from ..master.scene.requirements import Requirement
from ..master.scene.scene import amended
from ..studies.machine.rank import HEAD, answer, cells, read_table
from ..studies.sweep.definition import Column
from ..studies.sweep.maps import draw_survival
from ..studies.sweep.members import Member
from ..studies.sweep.parts import CAPTURE
from ..studies.sweep.places import field
from ..studies.sweep.report import failures, picked, verdict_lines, warned
from ..studies.sweep.results import Sweep
from ..studies.sweep.survival import lines, survival_of
from .charts import inline
from .figures.style import sized
from .layout import Absent, Data, laid_out
from .numbers import NONE, capital, digits, digits_of, head, percentage, quantity, spelt
from .page import Page, made_now

FORCE = "peak_contact_force"
NODE = Owner.COMPONENT, "1"  # owner and unit of a place on a rotor, of which there is no mean
RANDOM_SAMPLE = (
    "random"  # drops that stand for all that may be; those of other samples depend on each other
)
MAX_ROWS = 300  # of the table of drops
WORST_DROPS = 10  # drops that are listed by their force
WORST_OF_EACH = 3  # and by each requirement
CLOSED = re.compile("gap .* is closed")  # of warnings, which a page sums up
MAX_DIGITS = 8
ALIKE = 1e-12  # figures that differ by less, or by this part of them, differ by rounding alone
DROPS = (1, 2, 5, 10, 20)  # after which survival is told
MAPS = "whirl", "capture", "force", "stress"


def report_on_sweep(sweep: Sweep) -> Page:
    """The report of a sweep, whole or as far as it went."""
    scene = sweep.definition.scene
    title = amended(str(scene["title"]), sweep.definition.changes)
    over, text = joined(_words(c.name) for c in sweep.definition.columns), spelt(_headline(sweep))
    chapters = [laid_out(name, title, "sweep", partial(tell, sweep)) for name, title, tell in CHAPTERS]
    if ranking := read_table(sweep.folder):
        first = ranking[0]
        over = "bearing and mount" if first.mount else "bearing"
        text = f"{answer(first)} {text}"
        table: Data = {"head": HEAD, "rows": [cells(row) for row in ranking]}
        chapters.insert(0, laid_out("ranking", "Ranking", "sweep", lambda: table))
    return Page(
        kind="Report on many drops",
        title=f"{title}: {len(sweep)} drops over {over}",
        headline=text,
        made=made_now(f"Sweep of scene {scene['name']}"),
        sections=chapters,
        about="",
        document=scene.get("document") or {},
    )


def _words(setting: str) -> str:
    """A setting that varies, in words such as 'dynamic friction of the bearings'."""
    whose, _, what = setting.partition(".")
    words = re.sub(r"friction (dynamic|static)", r"\1 friction", re.sub("[._]", " ", what))
    return f"{words} of the {whose.replace('_*', 's').replace('_', ' ')}" if words else whose


def _headline(sweep: Sweep) -> str:
    """How many drops whirl, in one sentence."""
    with_verdict = _with_verdict(sweep)
    left, decision = len(sweep) - len(_done(sweep)), _decision(sweep)
    unsaid = f" {left} of {len(sweep)} drops failed or were not run." if left else ""
    if not with_verdict:
        return f"{decision}No drop of {len(sweep)} has a verdict.{unsaid}"
    count = sum(bool(worst_whirl(member.summary)) for member in with_verdict)
    text = f"{count} of {len(with_verdict)} drops whirl ({_part(sweep, count, len(with_verdict))})."
    return f"{decision}{_captured(sweep)}{text} {_length(sweep)}{unsaid}"


def _required(sweep: Sweep) -> list[tuple[list[Member], list[Judged]]]:
    """Of each requirement the drops, the worst first, each judged; what most drops fail comes first.

    Drops that failed meet nothing; those that were not run, or were interrupted, do not count.
    """
    found: list[tuple[list[Member], list[Judged]]] = []
    ran = [m for m in sweep if m.ended is not Ended.INTERRUPTED]
    for written in sweep.definition.scene.get("requirements") or ():
        one = Requirement(*written)
        drops = [(m, found) for m in ran for found in judged([one], {} if m.failed else m.summary)]
        drops.sort(key=lambda pair: -math.inf if pair[1].margin is None else pair[1].margin)
        if drops:
            found.append(([m for m, _ in drops], [judgement for _, judgement in drops]))
    return sorted(found, key=lambda pair: sum(one.met for one in pair[1]))


def _decision(sweep: Sweep) -> str:
    """Whether drops fail, how many, and mostly by what, in a sentence; "": nothing is required."""
    required = _required(sweep)
    if not required:
        return ""
    (members, gravest), *_ = required
    met, count = sum(m.meets for m in members), len(members)
    if met == count:
        return f"PASSES in all {count} drops ({_part(sweep, met, count)}). "
    failing = sum(not one.met for one in gravest)
    return f"FAILS in {count - met} of {count} drops, most often by {gravest[0].item.words} ({failing}). "


def _limits(sweep: Sweep) -> list[Data]:
    """Of each requirement how many drops meet it, and how the worst does."""
    return [
        {
            "label": capital(worst.item.words),
            "late": False,
            "value": f"{(met := sum(one.met for one in found))} of {len(found)}",
            "note": spelt(f"{worst.bound}; at worst {worst.value or NONE} in drop {members[0].number}"),
            "used": round(100.0 * met / len(found)),
            "met": met == len(found),
        }
        for members, found in _required(sweep)
        for worst in found[:1]
    ]


def _rubbed(sweep: Sweep) -> Iterator[str]:
    """Sentences on gaps that drops close."""
    done = _done(sweep)
    for name in dict.fromkeys(name for m in done for name in owned(m.summary, Owner.GAP)):
        least = {m.number: owned(m.summary, Owner.GAP).get(name, {}).get("least") for m in done}
        closed = {number: size for number, size in least.items() if size is not None and size <= 0.0}
        if closed:
            worst = min(closed, key=lambda number: closed[number])
            beyond = f"{quantity(-closed[worst], 'm', 3)} beyond it at most"
            yield f"Gap {name} is rubbed in {len(closed)} of {len(done)} drops, {beyond}."


def _part(sweep: Sweep, count: int, total: int) -> str:
    """A part of the drops, with its interval."""
    part = clopper_pearson(count, total)
    stand_for = "" if _is_sample(sweep.definition.about) else "as drops drawn one by one, "
    reach = f"{percentage(part.low)} to {percentage(part.high)} of all with 95 % confidence"
    return f"{percentage(part.value)}; {stand_for}{reach}"


def _captured(sweep: Sweep) -> str:
    """How many rotors are captured of those that were asked for again, in a sentence; "": none was."""
    counts = CAPTURE.counted(_done(sweep))
    if not counts:
        return ""
    count, total = counts[Fate.CAPTURED], counts.total()
    undecided = counts[Fate.UNDECIDED]
    more = f"; {undecided} undecided, which count as not captured" if undecided else ""
    return f"{count} of {total} rotors are captured ({_part(sweep, count, total)}{more}). "


def _length(sweep: Sweep) -> str:
    """How long the drops were followed, and how much of it after they touched."""
    done = _done(sweep)
    if not done:
        return "No drop ran to its end."
    text = f"Each is followed for {_reach([_duration(sweep, m) for m in done], 's')} from the shutdown on"
    firsts = [(m, first) for m in done if (first := earliest_contact(m.summary)) is not None]
    if not firsts:
        return f"{text}, and none touches."
    after = [_origin(sweep, member) + _duration(sweep, member) - first for member, first in firsts]
    some = "" if len(firsts) == len(done) else f" ({len(done) - len(firsts)} touch nothing)"
    return (
        f"{text}, {_reach(after, 's')} of it after the first contact{some}: what comes later is not known."
    )


def _duration(sweep: Sweep, member: Member) -> float:
    """Of a drop (s), from its shutdown on."""
    return _of_run(sweep, member, "duration", 1.0)


def _origin(sweep: Sweep, member: Member) -> float:
    """The zero of the duration (s, on the scale of the first contact): 0 where a zero is named."""
    return 0.0 if sweep.definition.scene.get("zero") else _of_run(sweep, member, "start_time", 0.0)


def _of_run(sweep: Sweep, member: Member, key: str, default: float) -> float:
    """A number of [run] that a drop was run with; `default` where an older sweep does not say."""
    row = sweep.definition.values[member.number - 1]
    for column, value in zip(sweep.definition.columns, row, strict=True):
        if f"run.{key}" in column.settings and (varied := finite_number(value)) is not None:
            return varied
    return float(sweep.definition.scene["run"].get(key, default))


def _reach(values: Sequence[float], unit: str) -> str:
    """From the least to the most, or what they all are, to three digits."""
    ends = dict.fromkeys(quantity(value, unit, 3) for value in (min(values), max(values)))
    return " to ".join(ends)


def _is_sample(about: str) -> bool:
    """Whether drops are drawn one by one; each point of a product with phases, say, has several."""
    return RANDOM_SAMPLE in about.lower() and "; " not in about


def _done(sweep: Sweep) -> list[Member]:
    return [member for member in sweep if member.summary and not member.failed]


def _with_verdict(sweep: Sweep) -> list[Member]:
    """Drops with a verdict."""
    return [member for member in _done(sweep) if has_verdict(member.summary)]


def _summary(sweep: Sweep) -> Data:
    done = _done(sweep)
    others = [replace(m, warnings=[w for w in m.warnings if not CLOSED.match(w)]) for m in sweep]
    return {
        "limits": _limits(sweep),
        "figures": [(*figure, False) for figure in _figures(sweep, done)],
        "partly": len(done) < len(sweep),
        "warnings": [*_rubbed(sweep), *(spelt(line.strip()) for line in warned(others))],
        "verdicts": [capital(line.strip()) for line in verdict_lines(sweep.members)],
    }


def _figures(sweep: Sweep, done: Sequence[Member]) -> Iterator[tuple[str, str, str]]:
    """What is seen first: label, value, note."""
    yield "Drops", str(len(sweep)), f"{len(done)} ran to their end"
    if asked_for := CAPTURE.counted(done):
        count, total = asked_for[Fate.CAPTURED], asked_for.total()
        yield "Captured", percentage(count / total, 3), f"{count} of {total}"
    if with_verdict := _with_verdict(sweep):
        count, total = sum(bool(worst_whirl(member.summary)) for member in with_verdict), len(with_verdict)
        yield "Whirl", percentage(count / total, 3), f"{count} of {total}"
    if forces := _forces(done, FORCE):
        yield "Largest contact force", quantity(max(forces), "N", 3), "of all drops"
        yield "Median of the largest", *_median(forces)
    if firsts := _forces(done, "first_impact_contact_force"):
        yield "Median of first impacts", *_median(firsts)


def _forces(members: Sequence[Member], key: str) -> list[float]:
    """The largest force (N) of each drop that has one."""
    return [force for member in members if (force := most(member.summary, key)) is not None]


def _median(forces: Sequence[float]) -> tuple[str, str]:
    """The median, and the range of which it is."""
    ends = f"{quantity(min(forces), 'N', 3)} to {quantity(max(forces), 'N', 3)}, drop by drop"
    return quantity(float(np.median(forces)), "N", 3), ends


def _varied(sweep: Sweep) -> Data:
    asked, columns = sweep.definition, sweep.definition.columns
    values = list(zip(*asked.values, strict=True))
    varied = {setting for column in columns for setting in column.settings}
    beside = [one for one in (*asked.changes, *asked.run_changes) if one.partition(" = ")[0] not in varied]
    return {
        "about": asked.about,
        "rows": [_column(column, varied) for column, varied in zip(columns, values, strict=True)],
        "scene": asked.scene["name"],
        "beside": "; ".join(beside),
        "length": _length(sweep),
        "macro_step": quantity(float(asked.scene["run"]["macro_step"]), "s"),
    }


def _column(column: Column, values: Sequence[object]) -> list[str]:
    name = joined(column.settings) or column.name
    distinct = list(dict.fromkeys(values))
    numbers = [value for one in distinct if (value := finite_number(one)) is not None]
    if not numbers:
        return [name, str(len(distinct)), str(distinct[0]), str(distinct[-1])]
    return [name, str(len(distinct)), *(_setting(column, end) for end in (min(numbers), max(numbers)))]


def _setting(column: Column, value: float) -> str:
    """A value of a setting, a speed as people say it."""
    if column.unit == "rad/s":
        turns, per = display_value(column.name, value)
        return f"{digits(turns, 5)} {per}"
    return quantity(value, column.unit or "1")


def _maps(sweep: Sweep) -> Data:
    """Maps by name, each a picture or why it is missing, and how many rotors are captured by place."""
    maps: Data = {}
    for name in MAPS:
        draw = partial(_map, draw=getattr(sweep.plot, name))
        try:
            svg = inline(draw, f"{name}-map", f"Map over the settings: {name}", themed=False)
            maps[name] = {"svg": svg, "why": ""}
        except TouchdownError as error:
            maps[name] = {"svg": "", "why": f"{error}."}
    return {"maps": maps, **(_places(sweep) if maps["capture"]["svg"] else {})}


def _places(sweep: Sweep) -> Data:
    """How many rotors are captured at each place of the map."""
    found = field(sweep.definition, sweep.members)
    rows = []
    for place, members in found.spots.items():
        counts = CAPTURE.counted(members)
        if not counts:
            continue
        part = CAPTURE.estimate(counts)
        share = percentage(part.value), f"{percentage(part.low)} to {percentage(part.high)}"
        rows.append([*map(_shown, place), *(f"{counts[one]}" for one in Fate), *share])
    return {"axes": list(found.labels), "fates": [one.value for one in Fate], "places": rows}


def _map(figure: Figure, draw: Callable[[Axes], object]) -> None:
    draw(sized(figure, 8.4, 5.4).subplots())


def _spread(sweep: Sweep) -> Data:
    """Quartiles of figures, of `others` that are details, and how often each place on a rotor comes."""
    done = _done(sweep)
    rows, others, places = list[list[str]](), list[list[str]](), list[list[str]]()
    for item in summary_items(*(m.summary for m in done)):
        one = item.quantity
        found = [one.factor * v for m in done if (v := finite_number(item.of(m.summary))) is not None]
        if not found or math.isclose(min(found), max(found), rel_tol=ALIKE, abs_tol=ALIKE):
            continue
        if (one.owner, one.unit) != NODE:
            (others if one.detail else rows).append([head(item), str(len(found)), *_quartiles(found)])
        elif not one.detail:
            places.append([head(item), _counts(found)])
    if not (rows or others or places):
        raise Absent("no figure differs from drop to drop.")
    return {"rows": rows, "places": places, "others": others}


def _counts(found: Sequence[float]) -> str:
    """How often each of some whole numbers comes, the most frequent first."""
    counts = Counter(found).most_common()
    return ", ".join(f"{value:.0f} in {count} drop{'s'[: count > 1]}" for value, count in counts)


def _quartiles(found: Sequence[float]) -> list[str]:
    """Least, quartiles and most, with so many digits that they can be told apart."""
    size, spread = max(map(abs, found)), max(found) - min(found)
    count = min(max(4, math.ceil(math.log10(size / spread)) + 2), MAX_DIGITS)
    return list(digits_of(np.percentile(found, [0, 25, 50, 75, 100]), count))


def _drops(sweep: Sweep) -> Data:
    shown, _ = picked(sweep.members, ())
    hardest = sorted(_done(sweep), key=lambda m: -(most(m.summary, FORCE) or 0.0))[:WORST_DROPS]
    if not hardest:
        raise Absent("no drop ran to its end.")
    return {
        "heads": [*hardest[0].settings, *map(head, shown)],
        "worst": list(_worst(sweep)),
        "folder": str(sweep.folder),
        "hardest": list(_rows(sweep, hardest, shown)),
        "every": list(_rows(sweep, sweep.members[:MAX_ROWS], shown)),
        "count": len(sweep),
    }


def _worst(sweep: Sweep) -> Iterator[list[str]]:
    """The drops that come nearest to each requirement or fail it, and the command that opens each."""
    for members, found in _required(sweep):
        for member, one in list(zip(members, found, strict=True))[:WORST_OF_EACH]:
            how = spelt(one.left()) if one.value else member.failed or "no such figure"
            words = capital(one.item.words), one.bound, str(member.number), one.value or NONE, how
            command = shlex.join(["touchdown", "run", str(sweep.folder), "--member", str(member.number)])
            yield [*map(spelt, words), command]


def _rows(sweep: Sweep, members: Sequence[Member], shown: Sequence[Item]) -> Iterator[list[str]]:
    columns = sweep.definition.columns
    for member in members:
        pairs = zip(member.settings.values(), columns, strict=True)
        settings = (as_given(value, column.unit, column.name) for value, column in pairs)
        found = (_shown(i.of(member.summary), i.quantity.factor) for i in shown)
        yield [str(member.number), *settings, *found]


def _shown(value: object, factor: float = 1.0) -> str:
    if value is None:
        return NONE
    known = finite_number(value)
    return str(value) if known is None else digits(factor * known, 5)


def _survival(sweep: Sweep) -> Data:
    """How many such drops the machine survives, and what drives that."""
    try:
        found = survival_of(sweep.definition, sweep.members)
    except TouchdownError:
        raise Absent("no drop has a static safety of its bearings.") from None
    draw = partial(draw_survival, found=found, drops=DROPS)
    return {
        "lines": [line.strip() for line in lines(found, ())],
        "rows": [
            [str(n), percentage(one.value, 3), f"{percentage(one.low, 3)} to {percentage(one.high, 3)}"]
            for n in DROPS
            for one in [found.after(n)]
        ],
        "warnings": [capital(line) for line in found.warnings],
        "chances": inline(draw, "survival", "Probability over drops", themed=False),
    }


def _failed(sweep: Sweep) -> Data:
    if why := [line.strip() for line in failures(sweep.members)]:
        return {"why": why}
    raise Absent("all drops ran to their end.")


def _machine(sweep: Sweep) -> Data:
    raise Absent(
        "it is the same for all drops but for what varies; `touchdown sweep --keep` keeps the folder of "
        "each drop, and `touchdown report` of one of them draws it, with all settings."
    )


CHAPTERS: tuple[tuple[str, str, Callable[[Sweep], Data]], ...] = (
    ("summary", "Summary", _summary),
    ("varied", "What varies", _varied),
    ("maps", "Maps", _maps),
    ("survival", "How many drops it survives", _survival),
    ("spread", "How figures spread", _spread),
    ("drops", "Drop by drop", _drops),
    ("failed", "What failed", _failed),
    ("machine", "The machine", _machine),
)
