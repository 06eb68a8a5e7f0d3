"""Results of cases: as a table for a terminal, as files, and as the pages of all of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
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
    names: dict[str, list[str]] = {}
    for name, why in declared()["absent"].items():
        names.setdefault(why, []).append(name)
    return "figures " + ", ".join(f"{', '.join(same)} ({why})" for why, same in names.items())


def _shown(value: Value | None, digits: int) -> str:
    """A value as text; a dash where there is none."""
    if isinstance(value, tuple):
        low, high = (f"{end:.{digits}g}" for end in value)
        return f"above {low}" if high == "inf" else f"{low} to {high}"
    return value if isinstance(value, str) else "-" if value is None else f"{value:.{digits}g}"


def _relative(share: float | None, signed: str = "") -> str:
    """A share as text; nothing where there is none."""
    if share is None:
        return ""
    if abs(share) < (5e-5 if signed else 1e-4):
        return f"{share:{signed}.0e}"
    return f"{100.0 * share:+.2f} %" if signed else percent(share)


def _cells(case: Case, row: Row) -> tuple[str, ...]:
    """A row as text, in COLUMNS; the dissertation's figures have four digits at most."""
    digits = 4 if case.kind is Kind.DISSERTATION else 6
    unit = f" {row.unit}" if row.unit else ""
    both = (
        _shown(v, digits) + (unit if v is not None and not isinstance(v, str) else "")
        for v in (row.theirs, row.ours)
    )
    allowed = None if row.deviation is None else row.tolerance
    return (row.quantity, *both, _relative(row.deviation, "+"), _relative(allowed), row.conclusion)


def text(case: Case, result: Found | TouchdownError) -> str:
    """A case for a terminal."""
    head = f"{case.heading}: {case.label}"
    if isinstance(result, TouchdownError):
        return f"{head}\n  {_failure(result)}"
    rows = [COLUMNS, *(_cells(case, row) for row in result.rows)] if result.rows else []
    why = [f"tolerance {_relative(case.tolerance)}: {case.why}"] if case.why else []
    notes = (f"assumed: {note}" for note in result.notes)
    lines = [*aligned(rows, "<>>>><"), *result.lines, *why, *notes]
    return "\n  ".join([head, *lines])


def _failure(error: TouchdownError) -> str:
    """Why there are no rows."""
    return f"{'not run' if isinstance(error, UnavailableError) else 'failed'}: {error}"


def failed(results: Results) -> bool:
    """Whether one failed, or a row that is not the dissertation's differs without a reason."""
    judged = {case: found for case, found in results.items() if case.kind is not Kind.DISSERTATION}
    errors = [r for r in results.values() if not isinstance(r, Found | UnavailableError)]
    return bool(errors) or _counted(judged)[Verdict.DIFFERS] > 0


def _counted(results: Results) -> Counter[Verdict]:
    """How many rows agree, and do not."""
    return Counter(
        row.verdict for found in results.values() if isinstance(found, Found) for row in found.rows
    )


def summary(results: Results) -> str:
    """One line over all that was run."""
    count = _counted(results)
    ran = sum(isinstance(found, Found) for found in results.values())
    said = ", ".join(f"{count[v]} {SAID[v]}" for v in Verdict if count[v] or v is not Verdict.OPEN)
    missing = f"; {len(results) - ran} not run" if ran < len(results) else ""
    return f"{ran} case{'s' * (ran != 1)}, {count.total()} rows: {said}{missing}"


def write(case: Case, found: Found, folder: Path) -> list[Path]:
    """The rows as NAME.csv, a picture as NAME.png and lines as NAME.txt in `folder`; returns the files."""
    files = [folder / f"{case.stem}.csv"]
    with writing_to(folder):
        write_records([_record(case, row) for row in found.rows], files[0])
        if found.figure is not None:
            files.append(folder / f"{case.stem}.png")
            save(found.figure, files[-1], DPI)
        if found.lines:
            files.append(folder / f"{case.stem}.txt")
            write_file(files[-1], "\n".join([*found.lines, ""]))
    return files


def _record(case: Case, row: Row) -> Mapping[str, object]:
    named = dict(zip(COLUMNS, _cells(case, replace(row, unit="")), strict=True))
    return {"quantity": row.quantity, "unit": row.unit} | named | {"deviation": row.deviation}


def write_page(name: str, results: Results, folder: Path) -> Path:
    """The page of `results`, "validation" or "reproduction", and its pictures; returns its path."""
    pictures = Path("pictures", name)  # beside the page
    frame, texts = declared()["pages"][name], _Texts(results)
    parts = [frame["head"], "## Overview\n", f"{summary(results)}.\n", _overview(results)]
    with writing_to(folder):
        make_folder(folder / pictures)
        for kind in Kind:
            chosen = {case: result for case, result in results.items() if case.kind is kind}
            if chosen and kind is not Kind.DISSERTATION:
                parts.append(f"## {kind.value[0].upper()}{kind.value[1:]}s\n")
            for case, result in chosen.items():
                parts.append(_section(case, result, pictures, texts))
                if isinstance(result, Found) and result.figure is not None:
                    save(result.figure, folder / pictures / f"{case.stem}.png", DPI)
        whole = "\n".join([*parts, frame["tail"].format(absent=absent()), *texts.footnotes()])
        write_file(folder / f"{name}.md", f"{whole.rstrip()}\n")
    return folder / f"{name}.md"


class _Texts:
    """Texts of a page: a long one that stands there more than once becomes a footnote."""

    def __init__(self, results: Results) -> None:
        self._times = Counter(text for one in results.items() for text in _told(*one))
        self._numbers: dict[str, int] = {}

    def said(self, text: str) -> str:
        """The text, or the number of its footnote."""
        if self._times[text] < 2 or len(text) < SHORT:
            return text
        return f"[^{self._numbers.setdefault(text, len(self._numbers) + 1)}]"

    def footnotes(self) -> list[str]:
        """All of them, after the page's last line."""
        return [f"[^{number}]: {text.removesuffix('.')}." for text, number in self._numbers.items()]


SHORT = 25  # characters of a text that is repeated where it is needed


def _told(case: Case, found: Found | TouchdownError) -> Iterator[str]:
    """The texts of a case's section."""
    yield from (case.what if case.source else "", case.source, case.command)
    if isinstance(found, Found):
        yield from (row.why for row in found.rows)
        yield from found.notes


def _overview(results: Results) -> str:
    """How many rows agree of each case of which not all do."""
    verdicts = [verdict for verdict in SAID if _counted(results)[verdict]]
    lines = [
        f"| | {' | '.join(SAID[verdict] for verdict in verdicts)} |",
        f"|{'---|' * (len(verdicts) + 1)}",
    ]
    for case, found in results.items():
        start = f"| [{case.heading}](#{case.heading.lower().replace(' ', '-')}) |"
        count = _counted({case: found})
        if isinstance(found, TouchdownError):
            lines.append(f"{start} {_failure(found)}{' |' * len(verdicts)}")
        elif set(count) - {Verdict.AGREES}:
            lines.append(f"{start} {' | '.join(str(count[verdict] or '') for verdict in verdicts)} |")
    return "\n".join(lines) + "\n"


def _section(case: Case, found: Found | TouchdownError, pictures: Path, texts: _Texts) -> str:
    """A case on its page."""
    about = texts.said(case.what) if case.source else f"{case.title[0].upper()}{case.title[1:]}."
    parts = [f"### {case.heading}\n", f"{about}\n"]
    if case.source:
        unread = "" if case.looked_at else "*"  # the page's head explains it
        origin = f" Made by {texts.said(case.command)}." if case.command else ""
        late = " Set afterwards." if case.afterwards else ""
        parts += [
            f"Figures{unread}: {texts.said(case.source)}.{origin}"
            f" Tolerance {_relative(case.tolerance)}.{late}",
            "",
        ]
    if isinstance(found, TouchdownError):
        return "\n".join([*parts, f"{_failure(found)}.\n"])
    if found.figure is not None:
        parts.append(f"![{case.heading}]({(pictures / f'{case.stem}.png').as_posix()})\n")
    chosen = telling(case, found.rows)
    rows = [short_cells(case, row, texts.said(row.why)) for row in chosen]
    columns = [k for k in range(len(SHORT_COLUMNS)) if k < FEWEST or any(row[k] for row in rows)]
    head, *body = ([row[k] for k in columns] for row in (SHORT_COLUMNS, *rows))
    parts += markdown(head, body)
    assumed = [texts.said(note) for note in found.notes]
    short = " ".join(note for note in assumed if note.startswith("[^"))
    notes = [*(note for note in assumed if not note.startswith("[^")), *[short] * bool(short)]
    more = len(found.rows) - len(chosen)
    parts += [f"\n{more} more agree."] if more else []
    return "\n".join([*parts, "", *(f"- Assumed: {note}" for note in notes), *[""] * bool(notes)])


def telling(case: Case, rows: Sequence[Row]) -> list[Row]:
    """The rows that a page shows: of many that agree and need no remark those that deviate most."""
    every_digit = case.kind in (Kind.DISSERTATION, Kind.MEASUREMENT)  # only equal rows are left out
    plain = [
        (abs(row.deviation or 0.0), -place)
        for place, row in enumerate(rows)
        if row.verdict is Verdict.AGREES
        and not row.why
        and (row.ours == row.theirs or row.deviation is not None)
        and not (every_digit and _shown(row.ours, 4) != _shown(row.theirs, 4))
    ]
    left_out = {-place for _, place in sorted(plain)[:-MOST]}
    return [row for place, row in enumerate(rows) if place not in left_out]


MOST = 1  # of these rows


SHORT_COLUMNS = "quantity", "theirs", "here", "off by", "remark"
FEWEST = 3  # columns; the others where one has something in them


def short_cells(case: Case, row: Row, why: str) -> tuple[str, str, str, str, str]:
    """A row on its page: to four digits, "=" where these are the same, and a remark where there is one.

    Of the dissertation's figures only those that differ say by how much.
    """
    unit = f" {row.unit}" if row.unit not in ("", "1") else ""
    theirs, ours = _shown(row.theirs, 4), _shown(row.ours, 4)
    same = theirs == ours
    if row.theirs is None or isinstance(row.theirs, str):
        ours += unit if not isinstance(row.ours, str) else ""
    else:
        theirs += unit
    off = _relative(row.deviation, "+")
    if row.verdict in (Verdict.KNOWN, Verdict.DIFFERS):
        allowed = f" beyond {_relative(row.tolerance)}" if off and row.tolerance != case.tolerance else ""
        why = f"differs{allowed}: {why or 'unexplained'}"
    elif case.kind is Kind.DISSERTATION:
        off = ""
    return row.quantity, theirs, "=" if same else ours, off, why
