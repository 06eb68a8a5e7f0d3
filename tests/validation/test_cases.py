"""The cases say where their figures are from; those that are cheap hold; pages show what they give."""

from __future__ import annotations

import re
import zipfile
from dataclasses import replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from places import ROOT

from touchdown.command.cli import main
from touchdown.validation import bodies, page, references
from touchdown.validation.case import (
    Case,
    Found,
    Kind,
    Row,
    UnavailableError,
    Verdict,
    cases,
    curves,
    make_all,
)

CASES = cases()
PAGE = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("one", CASES.values(), ids=CASES)
def test_a_case_says_what_it_is(one: Case) -> None:
    assert re.fullmatch(r"[a-z0-9-]+", one.name)
    assert len(one.source) > 20
    assert len(one.what) > 40
    assert len(one.why) > 10
    assert 0.0 < one.tolerance < 1.0
    unknown = any(said in one.source for said in ("without program", "not said"))
    assert one.command or one.kind is not Kind.PROGRAM or unknown
    for text in (one.title, one.why, one.source):
        assert text == text.strip().removesuffix(".")
        assert "{" not in text


LONG = ("rig-held", "ross-rotor-example-with-damping", "ross-magnetic", "ross-compressor-example")
CHEAP = [
    pytest.param(case, marks=pytest.mark.slow if case.name in LONG else (), id=case.name)
    for case in CASES.values()
    if case.cheap
]


@pytest.mark.parametrize("one", CHEAP)
def test_a_cheap_case_holds_and_is_on_the_page(one: Case) -> None:
    rows = one.found().rows
    assert rows
    assert all(row.verdict is not Verdict.DIFFERS for row in rows)
    section = of_case(one.name)
    told = re.findall(r"^\| (?!quantity|---)(.+?) \| (.+?) \| (.+?) \|", section, re.MULTILINE)
    assert len(told) == len(page.telling(one, rows)) == len(rows) - int(more_of(section))
    here = {row.quantity: page.short_cells(one, row, "")[:3] for row in rows}
    for quantity, *figures in told:
        # the worst of several that agree to rounding is another on another machine
        assert "the worst of" in quantity or here[quantity] == (quantity, *figures)


def of_case(name: str) -> str:
    """A case's section of the page."""
    return re.split(r"\n##", PAGE.split(f"\n### {name}\n")[1])[0]


def more_of(section: str) -> str:
    """How many rows a section leaves out."""
    more = re.search(r"^(\d+) more agree\.$", section, re.MULTILINE)
    return more[1] if more else "0"


def test_every_case_is_on_the_page() -> None:
    assert re.findall(r"^### ([\w-]+)$", PAGE, re.MULTILINE) == [
        one.name for kind in Kind for one in CASES.values() if one.kind is kind
    ]


def test_pictures_are_on_the_page() -> None:
    pictures = re.findall(r"\]\((pictures/validation/[\w-]+\.png)\)", PAGE)
    assert len(pictures) == 3
    for picture in pictures:
        assert (ROOT / "docs" / picture).stat().st_size > 5000


def test_the_page_counts_its_rows() -> None:
    rows = differing = 0
    for name in CASES:
        section = of_case(name)
        shown = re.findall(r"^\| (?!quantity|---).+ \|$", section, re.MULTILINE)
        rows += len(shown) + int(more_of(section))
        differing += sum("| differs" in row for row in shown)
    assert f"\n{len(CASES)} cases, {rows} rows: {rows - differing} agree, " in PAGE
    assert f", 0 {page.SAID[Verdict.DIFFERS]}." in PAGE


def test_footnotes_are_there_and_used() -> None:
    numbers = re.findall(r"^\[\^(\d+)\]: .+\.$", PAGE, re.MULTILINE)
    assert len(numbers) > 5
    assert set(re.findall(r"\[\^(\d+)\](?!:)", PAGE)) == set(numbers)


def test_the_readme_shows_rows_of_the_page() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    told = re.findall(
        r"^\| \[`([\w-]+)`\]\(docs/validation\.md#\1\), [\w ]+ \| (.+) \| (.+) \| (.+) \|$",
        readme,
        re.MULTILINE,
    )
    assert len(told) == 8
    for name, quantity, theirs, ours in told:
        number, unit = theirs.split()
        here = "=" if ours == theirs else ours.removesuffix(f" {unit}")
        assert f"| {quantity} | {number} {unit} | {here} |" in of_case(name), name


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Case:
    """A case of which one row agrees, one differs and one differs for a reason, with a picture."""

    def compute(*_: object) -> Found:
        """Three figures."""
        rows = [
            Row("one", "m", 1.0, 1.001),
            Row("o|ther", "m", 1.0, 1.1),
            Row("third", "", 1.0, 1.1, why="wear"),
        ]
        points = [0.0, 1.0], [0.0, 1.0]
        return Found(rows, curves("x", "y", ("theirs", points), {"ours": points}), ["a note"])

    monkeypatch.setattr(Case, "compute", compute)
    return Case("made-up", "", "a made-up case", source="here", tolerance=0.01, why="to see it")


def test_a_row_outside_its_tolerance_is_shown(made: Case, tmp_path: Path) -> None:
    results = make_all([made])
    assert page.summary(results).endswith("1 agree, 1 differ for a reason that is stated, 1 differ")
    assert page.failed(results)
    written = page.write_page("validation", results, tmp_path).read_text(encoding="utf-8")
    assert "| o\\|ther | 1 m | 1.1 | +10.00 % | differs: unexplained |" in written
    assert "| third | 1 | 1.1 | +10.00 % | differs: wear |" in written
    assert "| [made-up](#made-up) | 1 | 1 | 1 |" in written
    printed = page.text(made, results[made])
    assert re.search(r"o\|ther +1 m +1\.1 m +\+10\.00 % +1 % +differs: unexplained", printed)
    assert "- Assumed: a note" in written
    assert "pictures/validation/made-up.png" in written
    assert (tmp_path / "pictures/validation/made-up.png").read_bytes().startswith(b"\x89PNG")


def test_of_many_rows_those_that_tell_most_are_shown(made: Case) -> None:
    rows = [Row(str(k), "m", 1.0, 1.0 + 1e-3 * k, 0.1) for k in range(8)]
    assert [row.quantity for row in page.telling(made, rows)] == ["7"]
    rows[0] = replace(rows[0], why="wear")
    assert [row.quantity for row in page.telling(made, rows)] == ["0", "7"]
    dissertation = replace(made, kind=Kind.DISSERTATION)  # there only equal rows are left out
    assert page.telling(dissertation, rows) == rows
    assert len(page.telling(dissertation, [Row("a", "", 1.0, 1.0)] * 8)) == page.MOST


@pytest.mark.parametrize(
    ("row", "verdict", "conclusion"),
    [
        (Row("", "", 2.0, 2.09), Verdict.AGREES, "agrees"),
        (Row("", "", 2.0, 2.11), Verdict.DIFFERS, "differs: unexplained"),
        (Row("", "", 2.0, 2.11, 0.1, "fitted"), Verdict.AGREES, "agrees; fitted"),
        (Row("", "", 2.0, 2.11, why="worn"), Verdict.KNOWN, "differs: worn"),
        (Row("", "", 2.0, 3.0, why="worn"), Verdict.DIFFERS, "differs: worn"),
        (Row("", "", 0.0, 0.0), Verdict.AGREES, "agrees"),
        (Row("", "", 0.0, 1e-9, why="worn"), Verdict.DIFFERS, "differs: worn"),
        (Row("", "", 1.0, float("nan"), why="worn"), Verdict.DIFFERS, "differs: worn"),
        (Row("", "", (1.0, 2.0), 2.0), Verdict.AGREES, "agrees"),
        (Row("", "", (1.0, 2.0), (1.5, 2.5), why="wider"), Verdict.KNOWN, "differs: wider"),
        (Row("", "", (1.0, 2.0), (0.5, 1.5), why="wider"), Verdict.DIFFERS, "differs: wider"),
        (Row("", "", (1.0, 2.0), float("nan"), why="worn"), Verdict.DIFFERS, "differs: worn"),
        (Row("", "", (1.0, float("inf")), 0.9, why="worn"), Verdict.KNOWN, "differs: worn"),
        (Row("", "", 1.0, (1.0, 9.0), why="worn"), Verdict.DIFFERS, "differs: worn"),
        (Row("", "", np.float32(2.0), np.int64(9), why="worn"), Verdict.DIFFERS, "differs: worn"),
        (Row("", "", 1.0, None, why="lost"), Verdict.DIFFERS, "differs: lost"),
        (Row("", "", "low", 2.0, why="high"), Verdict.DIFFERS, "differs: high"),
        (Row("", "", "low", "high", why="high"), Verdict.KNOWN, "differs: high"),
        (Row("", "", "settles", "0 of 8 whirl", holds=True), Verdict.AGREES, "agrees"),
        (Row("", "", "settles", "8 of 8 whirl", holds=False), Verdict.DIFFERS, "differs: unexplained"),
        (Row("", "", 2.0, None), Verdict.DIFFERS, "differs: unexplained"),
        (
            Row("", "", None, 2.0),
            Verdict.OPEN,
            "no value to compare: the dissertation has it in its picture alone",
        ),
    ],
)
def test_verdicts(row: Row, verdict: Verdict, conclusion: str) -> None:
    row = replace(row, tolerance=row.tolerance or 0.05)
    assert (row.verdict, row.conclusion) == (verdict, conclusion)
    assert Row("", "", 2.0, 2.1).deviation == pytest.approx(0.05)  # only numbers deviate
    assert Row("", "", (1.0, 3.0), 2.0).deviation is Row("", "", "low", 2.0).deviation is None


def test_the_command_runs_one_and_lists_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "hertz-impact", "--quiet"]) == 0
    assert "1 case, 3 rows: 3 agree, " in capsys.readouterr().out
    assert main(["validate", "list"]) == 0
    listed = capsys.readouterr().out
    assert all(f"  {name} " in listed for name in CASES)


@pytest.mark.parametrize(("end", "verdict"), [("2", Verdict.AGREES), ("2.001", Verdict.DIFFERS)])
def test_published_results_are_compared(tmp_path: Path, end: str, verdict: Verdict) -> None:
    """Of an FMU that tells how much time it was stepped through."""
    if bodies.COMPILER is None or fmpy.platform != bodies.PLATFORM:
        pytest.skip(f"needs a C compiler for {bodies.PLATFORM}")
    path = bodies.fmu(bodies.compiled(tmp_path))
    results = references.RESULTS.format("body")
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr(results, f"time,elapsed,v,note\n0,0,0,on\n1,1,0,on\n2,{end},0,off\n")
    rows = references.rows_in(tmp_path)
    assert [row.quantity for row in rows] == ["FMI 2 body, elapsed, the worst of 3"]
    assert {replace(row, tolerance=1e-12).verdict for row in rows} == {verdict}


@pytest.mark.parametrize(
    ("folder", "said"), [("", "set TOUCHDOWN_REF"), ("none", "is not a folder"), (".", "no FMU in")]
)
def test_without_fmus_it_is_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str, said: str
) -> None:
    monkeypatch.setenv(references.VARIABLE, str(tmp_path / folder) if folder else "")
    with pytest.raises(UnavailableError, match=said):
        references.reference_fmus()
