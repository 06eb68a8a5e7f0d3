"""The cases say where their figures are from; those that are cheap hold; pages show what they give."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import fmpy
import pytest
from places import ROOT

from touchdown.command.cli import main
from touchdown.validation import bodies, page, references
from touchdown.validation.case import Case, Curves, Kind, Row, UnavailableError, Verdict, case, cases

CASES = cases()
PAGE = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("one", CASES.values(), ids=CASES)
def test_a_case_says_what_it_is(one: Case) -> None:
    assert re.fullmatch(r"[a-z0-9-]+", one.name)
    assert len(one.source) > 20
    assert len(one.what) > 40
    assert len(one.why) > 10
    assert 0.0 < one.tolerance < 1.0
    assert one.command or one.kind is not Kind.PROGRAM or "command" in one.source or "maker" in one.source
    for text in (one.title, one.what, one.why, one.source):
        assert text == text.strip().removesuffix(".") or text is one.what


@pytest.mark.parametrize("one", [c for c in CASES.values() if c.cheap], ids=lambda one: one.name)
def test_a_cheap_case_holds_and_is_on_the_page(one: Case) -> None:
    rows = one.rows()
    assert rows
    for row in rows:
        assert one.verdict(row) is not Verdict.DIFFERS
        quantity, theirs, ours, *_ = page.cells(one, row)
        # the worst of several that agree to rounding is another on another machine
        worst_of_some = "the worst of" in quantity
        assert (f"| {quantity} |" if worst_of_some else f"| {quantity} | {theirs} | {ours} |") in PAGE


def test_every_case_is_on_the_page() -> None:
    assert set(re.findall(r": `touchdown validate ([\w-]+)`\.$", PAGE, re.MULTILINE)) == set(CASES)


@pytest.mark.parametrize("one", [c for c in CASES.values() if c.drawn], ids=lambda one: one.name)
def test_a_picture_is_on_the_page(one: Case) -> None:
    assert f"]({page.picture_path(one).as_posix()})" in PAGE
    assert (ROOT / "docs" / page.picture_path(one)).stat().st_size > 5000


def test_curves_are_drawn(tmp_path: Path) -> None:
    target = tmp_path / "folder" / "one.png"
    page.draw_picture(
        Curves("x", "y", ([0.0, 1.0], [0.0, 1.0]), {"ours": ([0.0, 1.0], [0.0, 1.1])}, "theirs"), target
    )
    assert target.read_bytes().startswith(b"\x89PNG")


def test_the_page_counts_its_rows() -> None:
    rows = re.findall(
        r"^\| .+ \| (agrees|differs, known|differs) \|$", PAGE.split("\n## Closed forms")[1], re.MULTILINE
    )
    said = page.SAID
    counts = ", ".join(f"{rows.count(verdict.value)} {said[verdict]}" for verdict in Verdict)
    assert f"\n{len(CASES)} cases, {len(rows)} rows: {counts}.\n" in PAGE


def test_the_readme_shows_rows_of_the_page() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    told = re.findall(
        r"^\| \[`([\w-]+)`\]\(docs/validation\.md#\1\), [\w ]+ \| (.+) \|$", readme, re.MULTILINE
    )
    assert len(told) == 8
    for name, figures in told:
        of_case = PAGE.split(f"\n### {name}\n")[1].split("\n### ")[0]
        assert f"| {figures} | " in of_case, name


def made(known: str = "") -> Case:
    """A case of which one row agrees and one does not."""

    @case("made-up", "a made-up case", Kind.CLOSED_FORM, source="here", tolerance=0.01, why="to see it")
    def rows() -> list[Row]:
        """Two figures."""
        return [Row("one", "m", 1.0, 1.001), Row("other", "m", 1.0, 1.1, known=known)]

    return rows


@pytest.mark.parametrize(
    ("known", "verdict", "count"),
    [("", "differs", Verdict.DIFFERS), ("it is", "differs, known", Verdict.KNOWN)],
)
def test_a_row_outside_its_tolerance_is_shown(known: str, verdict: str, count: Verdict) -> None:
    one = made(known)
    shown = {one.name: one.rows()}
    assert page.counted({one.name: one}, shown) == {
        **dict.fromkeys(Verdict, 0),
        Verdict.AGREES: 1,
        count: 1,
    }
    written = page.page({one.name: one}, shown)
    assert f"| other | 1 m | 1.1 m | +10.00 % | 1 % | {verdict} |" in written
    assert f"| 2 | +10.00 % | {verdict} |" in written


def test_what_is_no_number_differs() -> None:
    assert made("known").verdict(Row("x", "", 1.0, float("nan"), known="it is")) is Verdict.DIFFERS
    assert made("known").verdict(Row("x", "", 0.0, 1e-9, known="it is")) is Verdict.DIFFERS
    assert made("known").verdict(Row("x", "", 1.0, -5.0, known="it is")) is Verdict.DIFFERS


def test_the_command_runs_one_and_lists_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "hertz-impact", "--quiet"]) == 0
    assert "1 case, 3 rows: 3 agree, " in capsys.readouterr().out
    assert main(["validate", "list"]) == 0
    listed = capsys.readouterr().out
    assert all(f"  {name} " in listed for name in CASES)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("herz-impact",), "touchdown: unknown case herz-impact; did you mean hertz-impact"),
        (("hertz-impact", "-o", "x"), "touchdown: -o writes the page of all cases; name none of them"),
    ],
)
def test_what_cannot_be_asked_for_is_one_line(
    arguments: tuple[str, ...], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["validate", *arguments]) == 2
    complaint = capsys.readouterr().err
    assert complaint.startswith(said)
    assert complaint.count("\n") == 1


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
    assert {references.reference_fmus.verdict(row) for row in rows} == {verdict}


@pytest.mark.parametrize(
    ("folder", "said"), [("", "set TOUCHDOWN_REF"), ("none", "is no folder"), (".", "no FMU in")]
)
def test_without_fmus_it_is_not_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, folder: str, said: str
) -> None:
    monkeypatch.setenv(references.VARIABLE, str(tmp_path / folder) if folder else "")
    with pytest.raises(UnavailableError, match=said):
        references.reference_fmus.rows()
