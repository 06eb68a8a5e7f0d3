"""Results of cases: as a table for a terminal, as files, and as the pages of all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from ..master.common.errors import TouchdownError
from ..master.common.files import write_records, writing_to
from ..master.common.text import aligned, markdown, percent
from ..modelkit.kernel.writing import make_folder
from ..modelkit.kernel.writing import write as write_file
from ..reports.figures.style import save
from .case import Case, Found, Kind, Results, Row, UnavailableError, Value, Verdict, declared

COLUMNS = ("quantity", "theirs", "here", "deviation", "within", "verdict")
SAID = {
    Verdict.AGREES: "agree",
    Verdict.KNOWN: "differ for a reason that is stated",
    Verdict.DIFFERS: "differ",
    Verdict.OPEN: "without a value to compare",
}
DPI = 80


def listing(cases: Iterable[Case]) -> str:
    """Which cases there are, a line each."""
    return "\n".join(aligned([(one.name, one.label) for one in cases], indent="  "))


def absent() -> str:
    """Which figures of the dissertation there are not, and why."""
    return "figures " + ", ".join(f"{name} ({why})" for name, why in declared()["absent"].items())


def shown(value: Value | None, digits: int) -> str:
    """A value as text; a dash where there is none."""
    if isinstance(value, tuple):
        low, high = (f"{end:.{digits}g}" for end in value)
        return f"above {low}" if high == "inf" else f"{low} to {high}"
    return value if isinstance(value, str) else "-" if value is None else f"{value:.{digits}g}"


def relative(share: float | None, signed: str = "") -> str:
    """A share as text; nothing where there is none."""
    if share is None:
        return ""
    if abs(share) < (5e-5 if signed else 1e-4):
        return f"{share:{signed}.0e}"
    return f"{100.0 * share:+.2f} %" if signed else percent(share)


def cells(case: Case, row: Row) -> tuple[str, ...]:
    """A row as text, in COLUMNS; the dissertation's figures have four digits at most."""
    digits = 4 if case.kind is Kind.DISSERTATION else 6
    unit = f" {row.unit}" if row.unit else ""
    both = (
        shown(v, digits) + (unit if v is not None and not isinstance(v, str) else "")
        for v in (row.theirs, row.ours)
    )
    allowed = None if row.deviation is None else row.tolerance
    return (row.quantity, *both, relative(row.deviation, "+"), relative(allowed), row.conclusion)


def text(case: Case, result: Found | TouchdownError) -> str:
    """A case for a terminal."""
    head = f"{case.heading}: {case.label}"
    if isinstance(result, TouchdownError):
        return f"{head}\n  {failure(result)}"
    rows = [COLUMNS, *(cells(case, row) for row in result.rows)] if result.rows else []
    lines = [*aligned(rows, "<>>>><"), *result.lines, *(f"assumed: {note}" for note in result.notes)]
    return "\n  ".join([head, *lines])


def failure(error: TouchdownError) -> str:
    """Why there are no rows."""
    return f"{'not run' if isinstance(error, UnavailableError) else 'failed'}: {error}"


def failed(results: Results) -> bool:
    """Whether one failed, or a row that is not the dissertation's differs without a reason."""
    judged = {case: found for case, found in results.items() if case.kind is not Kind.DISSERTATION}
    errors = [r for r in results.values() if not isinstance(r, Found | UnavailableError)]
    return bool(errors) or counted(judged)[Verdict.DIFFERS] > 0


def counted(results: Results) -> Counter[Verdict]:
    """How many rows agree, and do not."""
    return Counter(
        row.verdict for found in results.values() if isinstance(found, Found) for row in found.rows
    )


def summary(results: Results) -> str:
    """One line over all that was run."""
    count = counted(results)
    ran = sum(isinstance(found, Found) for found in results.values())
    said = ", ".join(f"{count[v]} {SAID[v]}" for v in Verdict if count[v] or v is not Verdict.OPEN)
    missing = f"; {len(results) - ran} not run" if ran < len(results) else ""
    return f"{ran} case{'s' * (ran != 1)}, {count.total()} rows: {said}{missing}"


def write(case: Case, found: Found, folder: Path) -> list[Path]:
    """The rows as NAME.csv, a picture as NAME.png and lines as NAME.txt in `folder`; returns the files."""
    made = [folder / f"{case.stem}.csv"]
    with writing_to(folder):
        write_records([_record(case, row) for row in found.rows], made[0])
        if found.figure is not None:
            made.append(folder / f"{case.stem}.png")
            save(found.figure, made[-1], DPI)
        if found.lines:
            made.append(folder / f"{case.stem}.txt")
            write_file(made[-1], "\n".join([*found.lines, ""]))
    return made


def _record(case: Case, row: Row) -> Mapping[str, object]:
    named = dict(zip(COLUMNS, cells(case, replace(row, unit="")), strict=True))
    return {"quantity": row.quantity, "unit": row.unit} | named | {"deviation": row.deviation}


def write_page(name: str, results: Results, folder: Path) -> Path:
    """The page of `results`, "validation" or "reproduction", and its pictures; returns its path."""
    pictures = Path("pictures", name)  # beside the page
    frame = declared()["pages"][name]
    parts = [frame["head"], "## Overview\n", f"{summary(results)}.\n", _overview(results)]
    with writing_to(folder):
        make_folder(folder / pictures)
        for kind in Kind:
            own = {case: result for case, result in results.items() if case.kind is kind}
            if own and kind is not Kind.DISSERTATION:
                parts.append(f"## {kind.value[0].upper()}{kind.value[1:]}s\n")
            for case, result in own.items():
                parts.append(_section(case, result, pictures))
                if isinstance(result, Found) and result.figure is not None:
                    save(result.figure, folder / pictures / f"{case.stem}.png", DPI)
        write_file(
            folder / f"{name}.md",
            "\n".join([*parts, frame["tail"].format(absent=absent())]).rstrip() + "\n",
        )
    return folder / f"{name}.md"


def _overview(results: Results) -> str:
    """How many rows of each agree, and how far off the worst is."""
    lines = [f"| | what | rows | {' | '.join(SAID.values())} | largest deviation |", f"|{'---|' * 8}"]
    for case, found in results.items():
        anchor = case.heading.lower().replace(" ", "-")
        start = f"| [{case.heading}](#{anchor}) | {case.title} |"
        if isinstance(found, TouchdownError):
            lines.append(f"{start} {failure(found)} | | | | | |")
            continue
        count = counted({case: found})
        worst = max((row.deviation or 0.0 for row in found.rows), key=abs, default=0.0)
        numbers = (count.total(), *(count[verdict] for verdict in SAID))
        lines.append(f"{start} {' | '.join(map(str, numbers))} | {relative(worst, '+')} |")
    return "\n".join(lines) + "\n"


def _section(case: Case, found: Found | TouchdownError, pictures: Path) -> str:
    """A case on its page."""
    verb = "figure" if case.kind is Kind.DISSERTATION else "validate"
    title = f"{case.title[0].upper()}{case.title[1:]}"
    parts = [f"### {case.heading}\n", f"{title}: `touchdown {verb} {case.name}`.\n"]
    if case.source:
        parts.append(
            f"{case.what}\n\nFigures: {case.source}{'' if case.looked_at else ' (not looked at)'}.\n"
        )
        parts += [f"Made by: {case.command}.\n"] if case.command else []
        late = " Set afterwards." if case.afterwards else ""
        parts.append(f"Tolerance {relative(case.tolerance)}: {case.why}.{late}\n")
    if isinstance(found, TouchdownError):
        return "\n".join([*parts, f"{failure(found)}.\n"])
    if found.figure is not None:
        parts.append(f"![{title}]({(pictures / f'{case.stem}.png').as_posix()})\n")
    parts += markdown(COLUMNS, (cells(case, row) for row in found.rows))
    return "\n".join(
        [*parts, "", *(f"- Assumed: {note}" for note in found.notes), *[""] * bool(found.notes)]
    )
