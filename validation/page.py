"""Results of cases: as text for a terminal, and as the page docs/validation.md."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ..modelkit.kernel.writing import make_folder
from .case import Case, Curves, Kind, Row, Verdict

Shown = Mapping[str, Sequence[Row] | str]  # rows of cases by name, or why there are none
PICTURES = Path("pictures", "validation")  # beside the page

SAID = {
    Verdict.AGREES: "agree",
    Verdict.KNOWN: "differ for a reason that is stated",
    Verdict.DIFFERS: "differ",
}
HEAD = """# Verification and validation

Closed forms, other programs, published computations and measurements, each beside what this project
computes. `touchdown validate` runs every case and wrote this page (`touchdown validate -o docs`);
`touchdown validate NAME` runs one of them. It fails where a row leaves its tolerance without a reason
that is stated here. The figures of the models' own source are on a [page of their
own](reproduction.md), drops through other co-simulation tools on [another](peers.md).

How to read it:

- A tolerance is relative, and its reason stands with the case. "Set afterwards" says that it was chosen
  with the result known: such a row shows that nothing has changed since, and less that it is right.
- "Not looked at" says that the citation, or the figure, is from memory or from another text, and was
  not compared with the publication for this page. Figures of other programs are stored with the command
  that made them; a run does not need the program.
- A closed form shows that equations are solved right; a measurement alone, that they are the right
  ones.
"""

MISSING = """## Not yet possible

- A measured drop onto rolling touchdown bearings. `rotor-pulled` is the nearest: contacts of a rotor with a
  plain stator. Published drops, such as of L. Hawkins et al., ASME GT2007-28290, or M. Caprio et al., Spin
  Commissioning and Drop Tests of a 130 kW-hr Composite Flywheel, were within reach by their beginnings
  only, without mounts, friction and orbits in numbers.
"""


def listing(cases: Iterable[Case]) -> str:
    """Which cases there are, a line each."""
    return "\n".join(f"  {one.name:<34}{one.title} ({one.kind.value})" for one in cases)


def number(value: float) -> str:
    """As a person reads it: six digits."""
    return f"{value:.6g}"


def apart(row: Row) -> str:
    """The deviation, signed."""
    percent = 100.0 * row.deviation
    return f"{percent:+.2f} %" if abs(percent) >= 0.005 else f"{row.deviation:+.0e}"


def within(tolerance: float) -> str:
    """A tolerance in words."""
    return f"{100.0 * tolerance:g} %" if tolerance >= 1e-4 else f"{tolerance:.0e}"


COLUMNS = ("quantity", "theirs", "here", "deviation", "within", "verdict")


def cells(one: Case, row: Row) -> tuple[str, ...]:
    """A row as text: quantity, theirs, ours, deviation, tolerance, verdict."""
    unit = f" {row.unit}" if row.unit else ""
    allowed = one.tolerance if row.tolerance is None else row.tolerance
    return (
        row.quantity,
        number(row.theirs) + unit,
        number(row.ours) + unit,
        apart(row),
        within(allowed),
        one.verdict(row).value,
    )


def text(one: Case, rows: Sequence[Row] | str) -> str:
    """A case for a terminal."""
    head = f"{one.name}: {one.title} ({one.kind.value})"
    if isinstance(rows, str):
        return f"{head}\n  not run: {rows}"
    lines = [COLUMNS, *(cells(one, row) for row in rows)]
    widths = [max(len(line[k]) for line in lines) for k in range(6)]
    body = ["  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() for line in lines]
    known = [f"known: {row.known}" for row in rows if one.verdict(row) is Verdict.KNOWN]
    return "\n".join([head, *(f"  {line}" for line in [*body, *known])])


def counted(cases: Mapping[str, Case], shown: Shown) -> dict[Verdict, int]:
    """How many rows agree, and do not."""
    count = dict.fromkeys(Verdict, 0)
    for name, rows in shown.items():
        for row in () if isinstance(rows, str) else rows:
            count[cases[name].verdict(row)] += 1
    return count


def summary(cases: Mapping[str, Case], shown: Shown) -> str:
    """One line over all that was run."""
    count = counted(cases, shown)
    absent = sum(isinstance(rows, str) for rows in shown.values())
    text = ", ".join(f"{n} {SAID[verdict]}" for verdict, n in count.items())
    ran = len(shown) - absent
    return f"{ran} case{'s' * (ran != 1)}, {sum(count.values())} rows: {text}" + (
        f"; {absent} not run" if absent else ""
    )


def page(cases: Mapping[str, Case], shown: Shown) -> str:
    """The page of `shown`, as Markdown."""
    parts = [HEAD, "## Overview\n", f"{summary(cases, shown)}.\n", _overview(cases, shown)]
    for kind in Kind:
        parts.append(f"## {kind.value[0].upper()}{kind.value[1:]}s\n")
        parts += [_section(cases[name], rows) for name, rows in shown.items() if cases[name].kind is kind]
    return "\n".join([*parts, MISSING]).rstrip() + "\n"


def _overview(cases: Mapping[str, Case], shown: Shown) -> str:
    lines = [
        "| case | what | figure of | rows | largest deviation | verdict |",
        "|---|---|---|---|---|---|",
    ]
    for name, rows in shown.items():
        one = cases[name]
        start = f"| [`{name}`](#{name}) | {one.title} | {one.kind.value} |"
        if isinstance(rows, str):
            lines.append(f"{start} 0 | | not run |")
            continue
        worst = max(rows, key=lambda row: abs(row.deviation))
        verdicts = {one.verdict(row) for row in rows}
        (said,) = [v for v in reversed(Verdict) if v in verdicts][:1]
        lines.append(f"{start} {len(rows)} | {apart(worst)} | {said.value} |")
    return "\n".join(lines) + "\n"


def _section(one: Case, rows: Sequence[Row] | str) -> str:
    source = f"Figures: {one.source}{'' if one.looked_at else ' (not looked at)'}."
    title = f"{one.title[0].upper()}{one.title[1:]}: `touchdown validate {one.name}`."
    parts = [f"### {one.name}\n", f"{title}\n", f"{one.what}\n", f"{source}\n"]
    if one.command:
        parts.append(f"Made by: {one.command}.\n")
    late = " Set afterwards." if one.afterwards else ""
    parts.append(f"Tolerance {within(one.tolerance)}: {one.why}.{late}\n")
    if isinstance(rows, str):
        return "\n".join([*parts, f"Not run: {rows}.\n"])
    columns = ("quantity", "theirs", "here", "deviation", "within", "verdict")
    table = [columns, ("---",) * 6, *(cells(one, row) for row in rows)]
    parts += [*(f"| {' | '.join(line)} |" for line in table), ""]
    if one.drawn:
        parts.append(f"![{one.title}]({picture_path(one).as_posix()})\n")
    parts += [f"{row.quantity}: {row.known}.\n" for row in rows if one.verdict(row) is Verdict.KNOWN]
    return "\n".join(parts)


def picture_path(one: Case) -> Path:
    """Where the picture of a case is, from the page's folder."""
    return PICTURES / f"{one.name}.png"


def draw_picture(curves: Curves, target: Path) -> None:
    """Their figures as points, ours as lines, as a PNG file; makes its folder."""
    from matplotlib.figure import Figure

    from ..reports.figures.style import save

    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    for label, line in curves.ours.items():
        axes.plot(*line, lw=1.2, label=label)
    axes.plot(*curves.theirs, "k.", ms=5, label=curves.points)
    axes.set(xlabel=curves.x, ylabel=curves.y)
    if curves.equal:
        axes.set_aspect("equal")
    figure.legend(fontsize=8, loc="outside lower center", ncols=2)
    make_folder(target.parent)
    save(figure, target, dpi=100)
