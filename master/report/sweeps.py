"""The report of a sweep: how many of its drops whirl, how hard they hit, and over which settings."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from touchdown.master.common.errors import TouchdownError
from touchdown.master.report.facts.numbers import NONE, digits, quantity, share
from touchdown.master.report.facts.subject import number
from touchdown.master.report.page.blocks import (
    Absent,
    Block,
    Folded,
    Lacking,
    Picture,
    Points,
    Remark,
    Section,
    Table,
    Text,
    Tile,
    Tiles,
)
from touchdown.master.report.page.writing import Page, made_now
from touchdown.master.report.pictures.svg import inline
from touchdown.master.results.figures.style import sized
from touchdown.master.results.whirl.share import clopper_pearson
from touchdown.master.results.whirl.told import has_verdict, whirling
from touchdown.master.studies.sweep.definition import Column
from touchdown.master.studies.sweep.journal import Member
from touchdown.master.studies.sweep.report import failures, largest, picked, verdict_lines
from touchdown.master.studies.sweep.results import Sweep

FORCE, STRESS = "peak_contact_force_N", "peak_bending_stress_MPa"
DRAWN = "random"  # drops that stand for all that may be; those of other samples hang on each other
MOST_ROWS = 300  # of the table of drops
WORST = 10  # drops that are listed by their force
MAPS = {
    "whirl": "Which part of the drops whirls, with its 95 % interval where a place stands for several.",
    "force": "Largest contact force of the drops at each place.",
    "stress": "Largest bending stress of the drops at each place.",
}


def report_on_sweep(sweep: Sweep) -> Page:
    """The report of a sweep, whole or as far as it went."""
    scene = sweep.definition.scene
    return Page(
        kind="Report on many drops",
        title=f"{scene['title']}, over {', '.join(c.name for c in sweep.definition.columns)}",
        headline=headline(sweep),
        made=made_now(f"Sweep of scene {scene['name']}"),
        sections=[_section(*chapter, sweep) for chapter in CHAPTERS],
        about="",
    )


def headline(sweep: Sweep) -> str:
    """How many drops whirl, in one sentence."""
    told = _told(sweep)
    left = len(sweep) - len(_done(sweep))
    unsaid = f" {left} of {len(sweep)} drops failed or were not run." if left else ""
    if not told:
        return f"No drop of {len(sweep)} has a verdict.{unsaid}"
    count = sum(bool(whirling(member.summary)) for member in told)
    part = clopper_pearson(count, len(told))
    said = share(part.value)
    if _is_sample(sweep.definition.about):
        said += f"; {share(part.low)} to {share(part.high)} of all with 95 % confidence"
    return f"{count} of {len(told)} drops whirl ({said}).{unsaid}"


def _is_sample(about: str) -> bool:
    """Whether drops are drawn one by one; each point of a product with phases, say, has several."""
    return DRAWN in about.lower() and "; " not in about


def _done(sweep: Sweep) -> list[Member]:
    return [member for member in sweep if member.summary and not member.failed]


def _told(sweep: Sweep) -> list[Member]:
    """Drops with a verdict."""
    return [member for member in _done(sweep) if has_verdict(member.summary)]


def _section(name: str, title: str, blocks: Callable[[Sweep], list[Block]], sweep: Sweep) -> Section:
    try:
        return Section(name, title, blocks(sweep))
    except Absent as absent:
        return Section(name, title, lacking=str(absent))


def _summary(sweep: Sweep) -> list[Block]:
    done, told = _done(sweep), _told(sweep)
    tiles = [Tile("Drops", str(len(sweep)), f"{len(done)} ran to their end")]
    if told:
        count = sum(bool(whirling(member.summary)) for member in told)
        tiles.append(Tile("Whirl", share(count / len(told), 3), f"{count} of {len(told)}"))
    forces = [force for member in done if (force := largest(member.summary, FORCE)) is not None]
    if forces:
        tiles.append(Tile("Largest contact force", quantity(max(forces), "N", 3), "of all drops"))
        tiles.append(
            Tile("Median of the largest", quantity(float(np.median(forces)), "N", 3), "drop by drop")
        )
    blocks: list[Block] = [Tiles(tiles)]
    if len(done) < len(sweep):
        blocks.append(Remark("Shares and figures are of the drops that ran to their end.", grave=True))
    lines = [line.strip() for line in verdict_lines(sweep.members)]
    return [*blocks, Text("Verdicts, seat by seat:"), Points(lines)] if lines else blocks


def _varied(sweep: Sweep) -> list[Block]:
    columns = sweep.definition.columns
    values = list(zip(*sweep.definition.values, strict=True))
    rows = [_column(column, given) for column, given in zip(columns, values, strict=True)]
    head, run = ["Setting", "Values", "from", "to"], sweep.definition.scene["run"]
    return [
        Text(f"How the drops were chosen: {sweep.definition.about}."),
        Table("What varies", head, rows, 1),
        Text(
            f"Each is followed for {quantity(float(run['duration']), 's')} from the shutdown on, in "
            f"macro steps of {quantity(float(run['macro_step']), 's')}."
        ),
    ]


def _column(column: Column, given: Sequence[object]) -> list[str]:
    name = " and ".join(column.settings) if column.settings else column.name
    distinct = list(dict.fromkeys(given))
    numbers = [value for one in distinct if (value := number(one)) is not None]
    if not numbers:
        return [name, str(len(distinct)), str(distinct[0]), str(distinct[-1])]
    ends = (quantity(end, column.unit or "1") for end in (min(numbers), max(numbers)))
    return [name, str(len(distinct)), *ends]


def _maps(sweep: Sweep) -> list[Block]:
    blocks: list[Block] = []
    for name, caption in MAPS.items():
        drawn = getattr(sweep.plot, name)
        try:
            svg = inline(
                partial(_map, draw=drawn), f"{name}-map", f"Map over the settings. {caption}", themed=False
            )
        except TouchdownError as error:
            blocks.append(Lacking(f"The map of {name}", f"{error}."))
            continue
        blocks.append(Picture(svg, caption))
    return blocks


def _map(figure: Figure, draw: Callable[[Axes], object]) -> None:
    draw(sized(figure, 8.4, 5.4).subplots())


def _spread(sweep: Sweep) -> list[Block]:
    done = _done(sweep)
    rows = []
    for key in dict.fromkeys(key for member in done for key in member.summary):
        found = [
            v for member in done if (v := number(member.summary.get(key))) is not None and math.isfinite(v)
        ]
        if found and min(found) < max(found):
            quartiles = np.percentile(found, [0, 25, 50, 75, 100])
            rows.append([key, str(len(found)), *(digits(float(value)) for value in quartiles)])
    if not rows:
        raise Absent("no figure differs from drop to drop.")
    head = ["Figure, with its unit", "Drops", "least", "quarter below", "median", "quarter above", "most"]
    return [Table("How figures spread over the drops", head, rows, 1)]


def _drops(sweep: Sweep) -> list[Block]:
    figures, _ = picked(sweep.members, ())
    hardest = sorted(_done(sweep), key=lambda m: -(largest(m.summary, FORCE) or 0.0))[:WORST]
    if not hardest:
        raise Absent("no drop ran to its end.")
    every = list(_rows(sweep.members[:MOST_ROWS], figures))
    of = f"the first {MOST_ROWS} of {len(sweep)} drops" if len(sweep) > MOST_ROWS else "All drops"
    head = ["Drop", *hardest[0].settings, *figures]
    return [
        Table("The drops that hit hardest", head, list(_rows(hardest, figures))),
        Folded(f"{of}, {len(every)} rows", [Table(of, head, every)]),
    ]


def _rows(members: Sequence[Member], figures: Sequence[str]) -> Iterator[list[str]]:
    for member in members:
        settings = (str(value) for value in member.settings.values())
        yield [str(member.number), *settings, *(_shown(member.summary.get(key)) for key in figures)]


def _shown(value: object) -> str:
    if value is None:
        return NONE
    known = number(value)
    return str(value) if known is None else digits(known)


def _failed(sweep: Sweep) -> list[Block]:
    why = [line.strip() for line in failures(sweep.members)]
    if not why:
        raise Absent("all drops ran to their end.")
    return [Points(why)]


def _machine(sweep: Sweep) -> list[Block]:
    raise Absent(
        "it is the same for all drops but for what varies; `touchdown sweep --keep` keeps the folder of "
        "each drop, and `touchdown report` of one of them draws it, with all settings."
    )


CHAPTERS: tuple[tuple[str, str, Callable[[Sweep], list[Block]]], ...] = (
    ("summary", "Summary", _summary),
    ("varied", "What varies", _varied),
    ("maps", "Maps", _maps),
    ("spread", "How figures spread", _spread),
    ("drops", "Drop by drop", _drops),
    ("failed", "What failed", _failed),
    ("machine", "The machine", _machine),
)
