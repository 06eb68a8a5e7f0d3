"""A quantity has the same value wherever it is told: summary, flat view, sweep, console, report."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from commands import records

import touchdown
from touchdown.master.quantities import Item, finite_number, owned, summary_items
from touchdown.master.results.result import Result
from touchdown.master.results.table import result_table, shown_value
from touchdown.reports.numbers import quantity
from touchdown.studies.sweep.results import Sweep

SCENES = {"rotor1-9000": "12 ms", "disk-upright-pair": "7 ms"}


@dataclass(frozen=True)
class Told:
    """A drop, and the same as the one drop of a sweep."""

    result: Result
    sweep: Sweep

    def numbers(self) -> list[tuple[Item, float]]:
        """All numbers of the summary."""
        found = [(i, finite_number(i.of(self.result.summary))) for i in summary_items(self.result.summary)]
        return [(item, value) for item, value in found if value is not None]


@pytest.fixture(scope="module", params=SCENES)
def told(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Told:
    folder, length = tmp_path_factory.mktemp("told"), {"run.duration": SCENES[request.param]}
    scene = touchdown.load(request.param)
    result = touchdown.run(scene.set(length), folder / "run", in_process=True, pictures=False)
    points = {name: [value] for name, value in length.items()}
    return Told(result, touchdown.sweep(scene, points, folder / "sweep", jobs=1, in_process=True))


def test_there_are_numbers_of_everything(told: Told) -> None:
    """Of the run, of its seats and of the rotor, many of each bearing: what follows compares something."""
    keys = [item.quantity.key for item, _ in told.numbers()]
    assert len(keys) > 40
    assert {"peak_ball_force", "speed_end", "end_time", "macro_step"} <= set(keys)


def test_the_flat_view(told: Told) -> None:
    flat = told.result.flat
    assert all(flat[item.path] == value for item, value in told.numbers())


def test_the_sweeps_files(told: Told) -> None:
    """To the last digit, with the SI unit; what differs from computer to computer is left out."""
    (row,) = records(told.sweep.folder / "sweep.csv")
    for item, value in told.numbers():
        path, unit = item.path, item.quantity.unit
        head = path if unit == "1" else f"{path} [{unit}]"
        if item.quantity.machine:
            assert not {head, path} & {*row, *told.sweep.data}
            continue
        assert float(row[head]) == value
        column = told.sweep.data[path]
        assert float(column[0]) == value
        assert column.attrs["units"] == unit


def test_the_console(told: Told) -> None:
    """In the line of its words and unit, of several seats in the column of its name."""
    summary = told.result.summary
    lines = [re.split(r" {2,}", line.strip()) for line in result_table(summary).splitlines()]
    for item, _ in told.numbers():
        one = item.quantity
        names = [name for name, values in owned(summary, one.owner).items() if one.key in values]
        cells = [line[1:] for line in lines if line[0] in (one.head, item.head)]
        assert [shown_value(item, summary)] in cells or [
            shown_value(Item(one, name), summary) for name in names
        ] in cells


def table_rows(page: str, caption: str) -> Iterator[list[str]]:
    """Texts of the cells of a table of a report, by rows."""
    (found,) = re.findall(rf"<caption>{caption}</caption>(.*?)</table>", page, re.DOTALL)
    for row in re.findall(r"<tr>(.*?)</tr>", found, re.DOTALL):
        cells = re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL)
        yield [html.unescape(re.sub(r"<[^>]+>", "", cell)).strip() for cell in cells]


def test_the_report(told: Told) -> None:
    """Verdict, first contact and peak force of every seat; a number is rounded to its digits."""
    (path,) = touchdown.report(told.result)
    rows = {row[0]: row[1:] for row in table_rows(Path(path).read_text("utf-8"), "Verdict at each .*?")}
    seats = told.result.summary["seats"]
    assert seats
    for name, seat in seats.items():
        verdict, _, _, first, _, peak, *_ = rows[f"{name} ({seat['bearing']})"]
        assert verdict == seat["whirl"]
        assert first == quantity(seat["first_contact_time"], "s")
        assert peak == quantity(seat["peak_contact_force"], "N", 3)
