"""Figures and tables of the dissertation by name: their rows and verdicts, files and page."""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

import pytest
from matplotlib.colors import to_hex

from touchdown.command.cli import main
from touchdown.master.common.errors import STOPPED, TouchdownError
from touchdown.master.scene.file import load_scene
from touchdown.reports.figures.style import DARK, sheet
from touchdown.validation import case, page
from touchdown.validation.case import Case, Found, Kind, Row, declared, figures, find_figure, make
from touchdown.validation.dissertation.drop_cache import Drops, at_phases
from touchdown.validation.dissertation.rotor1 import SETTLES, WHIRLS, nearest_lines, verdict_row

ABSENT = declared()["absent"]
FIGURES, TABLES = 33, 7  # of the dissertation
QUICK = ("12", "18", "19", "22", "table1", "table2", "table3", "table5", "table6")  # run nothing


@pytest.fixture
def drops(tmp_path: Path) -> Drops:
    return Drops(tmp_path / "drops", jobs=1)


def test_every_figure_and_table_of_the_dissertation_is_there_or_has_a_reason() -> None:
    source = {str(k + 1) for k in range(FIGURES)} | {f"table{k + 1}" for k in range(TABLES)}
    assert set(figures()) | set(ABSENT) == source
    assert not set(figures()) & set(ABSENT)
    assert all(ABSENT.values())
    assert all(callable(one.compute) for one in figures(studies=True).values())


def test_a_figure_is_found_however_it_is_called_or_refused_with_a_reason() -> None:
    assert {find_figure(n).heading for n in ("25", "fig25", "Fig. 25", "figure_25")} == {"Fig 25"}
    assert find_figure("Table 7").stem == "table_7"
    with pytest.raises(TouchdownError, match="figure 16 is a sketch of how the rotor was measured"):
        find_figure("16")
    with pytest.raises(TouchdownError, match="no figure table71; did you mean table7 or"):
        find_figure("table71")


class Whirling:
    """A run that whirls, or not."""

    def __init__(self, whirls: bool) -> None:
        b = [{"goes_on": True}] * whirls
        self.summary = {"seats": {"A": {"whirl_episodes": []}, "B": {"whirl_episodes": b}}}


@pytest.mark.parametrize(
    ("whirls", "source", "agrees", "told"),
    [
        (0, SETTLES, True, ""),
        (1, SETTLES, False, "so at 3 of 4 phases; edge"),
        (2, SETTLES, False, "so at 2 of 4 phases; edge"),
        (2, WHIRLS, False, "so at 2 of 4 phases; edge"),
        (3, SETTLES, False, "so at 1 of 4 phases; edge"),
        (3, WHIRLS, False, "so at 3 of 4 phases; edge"),
        (4, WHIRLS, True, ""),
        (0, WHIRLS, False, "edge"),
    ],
)
def test_it_agrees_where_all_phases_do(whirls: int, source: str, agrees: bool, told: str) -> None:
    runs: list[Any] = [Whirling(k < whirls) for k in range(4)]
    row = verdict_row("", source, runs, why="edge")
    assert row.ours == f"{whirls} of 4 whirl"
    assert (row.agrees, row.why) == (agrees, told)


def test_a_line_stands_beside_the_one_it_is_nearest_to() -> None:
    """Two lines near 30 Hz are not Halminen's 30 and 40: what is missing is said to be missing."""
    found = [(31.15, 5.0), (25.92, 3.0)]
    assert list(nearest_lines((30.0, 40.0), found)) == [(30.0, 31.15), (40.0, None)]
    assert list(nearest_lines((30.0, 40.0), [*found, (37.8, 1.0)])) == [(30.0, 31.15), (40.0, 37.8)]
    assert list(nearest_lines((30.0, 40.0), [*found, (37.8, 0.01)])) == [(30.0, 31.15), (40.0, None)]
    assert list(nearest_lines((30.0,), [])) == [(30.0, None)]


@pytest.mark.parametrize("name", QUICK)
def test_rows_of_what_runs_nothing(name: str, drops: Drops, tmp_path: Path) -> None:
    """They agree with the dissertation, or say why not; where there is a picture, it can be saved."""
    chosen = find_figure(name)
    found = make(chosen, drops)
    assert found.rows
    assert not any("unexplained" in row.conclusion for row in found.rows)
    if name == "22":
        dark = make(chosen, drops, dark=True).figure
        assert dark is not None
        assert to_hex(dark.get_facecolor()) == DARK
    files = page.write(chosen, found, tmp_path)
    assert [file.suffix for file in files] == [".csv", ".png"][: 1 + (found.figure is not None)]
    with files[0].open(encoding="utf-8") as file:
        assert len(list(csv.DictReader(file))) == len(found.rows)


def test_a_drop_is_run_once_however_often_it_is_asked_for(drops: Drops) -> None:
    scene = load_scene("disk-caged-simplified").set({"run.duration": "8 ms"})
    other = scene.set({"bearing.clearance": "0.2 mm"})
    first, again, different = drops.of([scene, scene, other])
    assert first is again is drops.of([scene])[0]
    assert different is not first
    assert len(list(drops.folder.iterdir())) == 2
    assert first.recording["rotor.A.y"].min() < -200e-6
    with pytest.raises(TouchdownError, match=r"friction\.kind"):  # one that stops is named
        drops.of([scene.set({"bearing.friction.kind": 9})])
    phases = [
        one.components["rotor"].set["unbalance_angle"] for one in at_phases(load_scene("rotor1-9000"), 4)
    ]
    assert phases == ["0 deg", "90 deg", "180 deg", "270 deg"]


def test_the_page_has_every_row_and_every_reason(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of a figure that can be made and one that cannot."""

    def found(self: Case, *_: object) -> Found:
        if self.name == "2":
            raise TouchdownError("its drop stopped")
        rows = [Row("a", "N", 2.0, 2.5, 0.05, "stiffer"), Row("c", "", None, 1.0)]
        return Found(rows, sheet(), ["a note"])

    two = {name: Case(name, "", f"figure {name}", Kind.DISSERTATION) for name in "12"}
    monkeypatch.setattr(Case, "found", found)
    monkeypatch.setattr(case, "figures", lambda: two)
    assert main(["figure", "all", "--quiet", "-o", str(tmp_path)]) == STOPPED
    text = (tmp_path / "reproduction.md").read_text(encoding="utf-8")
    assert "| a | 2 N | 2.5 | +25.00 % | differs: stiffer |" in text
    assert "| c | - | 1 |  |  |" in text
    assert "| [Fig 1](#fig-1) | 1 | 1 |" in text
    assert "\nfailed: its drop stopped" in text
    assert all(re.search(rf"\b{name}\b[\d, ]* \({re.escape(why)}\)", text) for name, why in ABSENT.items())
    assert "](pictures/reproduction/fig_1.png)" in text
    assert (tmp_path / "pictures/reproduction/fig_1.png").is_file()
    assert "Fig 2: figure 2\n  failed: its drop stopped" in capsys.readouterr().out


def test_the_command_lists_and_makes_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figure"]) == 0
    listed = capsys.readouterr().out
    assert all(f"  {one.name:<8}  {one.title}\n" in listed for one in figures(studies=True).values())
    assert main(["figure", "table1", "-o", str(tmp_path), "--quiet"]) == 0
    assert "6904: pitch diameter " in capsys.readouterr().out
    assert (tmp_path / "table_1.csv").is_file()
