"""The file of a recording is whole whenever it is opened; what is recorded of which component."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
import xarray

from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import FmiType, ScalarVariable, reported
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling import recording_file
from touchdown.master.coupling.recorder import choose
from touchdown.master.coupling.recording_file import END, TIME, Contents, RecordedColumn, RecordedTable
from touchdown.master.coupling.system import System
from touchdown.master.results.recording import Recording
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.modelkit.variables import Causality, Variability

COLUMNS = [RecordedColumn(f"part{i % 2}/x{i}", "m", "a place " * (20 * i)) for i in range(2)]
CONTENTS = Contents({"title": "kept"}, COLUMNS)
ROOM = 4  # for rows, at first
APPENDED = (1, ROOM, 2 * ROOM + 3)  # rows at a time: the first, and twice more than there is room for
AT_END = {"part0": {f"ball[{i}].x": float(i) for i in range(12)}}


class KilledError(BaseException):
    """Stands for SIGKILL."""


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that grow soon."""
    monkeypatch.setattr(recording_file, "ROWS", ROOM)


def block(begin: int, count: int) -> np.ndarray:
    """Rows of times 0, 1, 2 ...; each column has a value of its own at each."""
    times = np.arange(begin, begin + count, dtype=float)
    return np.column_stack([times, *(times + 1e4 * (i + 1) for i in range(len(COLUMNS)))])


def lives(path: Path) -> Iterator[tuple[RecordedTable, int]]:
    """A table as it grows and ends, with the rows it was given."""
    table, rows = RecordedTable(path, CONTENTS, sum(APPENDED)), 0
    yield table, rows
    for count in APPENDED:
        table.append(block(rows, count))
        rows += count
        yield table, rows
    table.finish(AT_END)
    yield table, rows


def check_whole(path: Path, rows: int) -> int:
    """As xarray opens it: columns of one length, `rows` rows at least, and nothing but what was written.

    Returns how many rows there are.
    """
    with xarray.open_datatree(path, engine="h5netcdf") as tree:
        return check_tree(tree, rows)


def check_tree(tree: xarray.DataTree, rows: int) -> int:
    tree.load()
    assert tree.attrs["title"] == "kept"
    there = int(tree.to_dataset()[TIME].count())
    assert there >= rows
    read = tree.isel({TIME: slice(there)})  # as docs/results.md says
    for column, values in zip((TIME, *(c.name for c in COLUMNS)), block(0, there).T, strict=True):
        np.testing.assert_array_equal(read[column].values, values)
    if END in tree:
        assert {name: dict(node.attrs) for name, node in tree[END].children.items()} == AT_END
        assert tree.sizes[TIME] == there
    return there


def test_a_reader_finds_a_whole_file_amid_any_write(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each is of two parts, between which the reader looks, as before. A kill leaves one of these, too."""
    path, write, known, seen = tmp_path / "result.h5", os.write, 0, []

    def written(descriptor: int, data: memoryview) -> int:
        if path.exists():
            seen.append(check_whole(path, known))
        return write(descriptor, data[: len(data) // 16 * 8] if len(data) > 8 else data)

    monkeypatch.setattr(os, "write", written)
    for table, rows in lives(path):
        known = rows
        assert table.rows == check_whole(path, rows) == rows
    table.close()
    assert len(seen) > 15
    assert set(seen) >= {0, 1, ROOM + 1, sum(APPENDED)}
    with xarray.open_datatree(path, engine="h5netcdf") as tree:
        assert tree.sizes[TIME] == sum(APPENDED)


def test_a_reader_goes_on_while_the_run_does(tmp_path: Path) -> None:
    """What it opened once stays one recording, however late it reads what."""
    path, opened = tmp_path / "result.h5", []
    for table, rows in lives(path):  # noqa: B007
        opened.append((xarray.open_datatree(path, engine="h5netcdf"), rows))
    table.close()
    for tree, rows in opened:
        check_tree(tree, rows)
        tree.close()


def test_a_kill_leaves_the_recording_that_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Wherever a file with more room, or the last one, is being made."""
    path, write = tmp_path / "result.h5", os.write
    for allowed in range(30):
        left, known = allowed, 0

        def written(descriptor: int, data: memoryview) -> int:
            nonlocal left
            left -= 1
            if left < 0:
                raise KilledError
            return write(descriptor, data)

        with monkeypatch.context() as patch, suppress(KilledError):
            for table, rows in lives(path):  # noqa: B007
                if not known:
                    patch.setattr(os, "write", written)
                known = rows
        table.close()
        assert check_whole(path, known) <= sum(APPENDED)
        assert list(tmp_path.iterdir()) == [path]


def test_our_reader_leaves_out_the_room_for_more_rows(tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    for table, rows in lives(path):  # noqa: B007
        if not rows:
            with pytest.raises(TouchdownError, match="it has no rows"):
                Recording(path)
            continue
        recording = Recording(path)
        np.testing.assert_array_equal(recording.time, block(0, rows)[:, 0])
        np.testing.assert_array_equal(recording["part1.x1"], block(0, rows)[:, 2])
        recording.close()
    table.close()


def test_a_disk_that_is_full_at_any_write_leaves_a_whole_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, write, room = tmp_path / "result.h5", os.write, 0
    failed = True
    while failed:
        left, failed = room, False

        def full(descriptor: int, data: memoryview) -> int:
            nonlocal left
            left -= 1
            if left < 0:
                raise OSError(28, "No space left on device")
            return write(descriptor, data)

        table = RecordedTable(path, CONTENTS, 9)
        table.append(block(0, 3))
        with monkeypatch.context() as patch:
            patch.setattr(os, "write", full)
            try:
                table.append(block(3, 8))
            except OSError:
                failed = True
        assert check_whole(path, 3) == table.rows
        table.append(block(table.rows, 2))
        table.finish({})
        table.close()
        assert check_whole(path, 5) == table.rows
        room += 1
    assert room > 8


def variable(name: str, causality: Causality) -> ScalarVariable:
    """A real one."""
    return ScalarVariable(
        name, 0, FmiType.REAL, causality, Variability.CONTINUOUS, None, None, None, None, description=""
    )


def system(locals_: int) -> System:
    """A stand-in for one with a single component of many locals."""
    cells = [f"cell[{k}].heat" for k in range(1, 6)]
    outputs = [variable(name, Causality.OUTPUT) for name in ("journal.fx", "flow", *cells)]
    inner = [variable(f"cells.heat{i}", Causality.LOCAL) for i in range(locals_)]
    known = [variable(name, Causality.LOCAL) for name in ("journal.work", "contact.force", "wired")]
    plant = SimpleNamespace(variables={v.name: v for v in (*outputs, *inner, *known)})
    wire = SimpleNamespace(source_name="plant.wired")
    return cast(System, SimpleNamespace(components={"plant": plant}, connections=[wire]))


DEFAULT = ["journal.fx", "flow", "journal.work", "contact.force", "wired"]


def test_locals_that_nothing_reads_are_recorded_on_request() -> None:
    plain = choose(RunSpec(), system(20_000))["plant"]
    assert plain.recorded == DEFAULT
    assert len(plain.at_end) == 20_005
    listed = with_changes(RunSpec(), {"record_also": '["plant.cells.heat7", "plant.cell[1]"]'})
    also = with_changes(RunSpec(), {"record_also": "plant.cells.heat7,plant.cell[1]"})
    assert listed == also  # as it stands in a file, by --set
    assert choose(also, system(9))["plant"].recorded == [
        *("journal.fx", "flow", "cell[1].heat", "cells.heat7", "journal.work", "contact.force", "wired")
    ]
    assert (
        choose(with_changes(RunSpec(), {"record_arrays": True}), system(9))["plant"].recorded[6]
        == "cell[5].heat"
    )
    alone = with_changes(RunSpec(), {"record": "plant.cells"})
    assert choose(alone, system(2))["plant"].recorded == ["cells.heat0", "cells.heat1"]


def test_members_of_short_arrays_are_recorded() -> None:
    """As the axes of a magnetic bearing are; up to four."""
    outputs = [
        variable(f"{name}[{k}].set", Causality.OUTPUT) for name in ("axis", "row") for k in range(1, 6)
    ]
    plant = SimpleNamespace(variables={v.name: v for v in outputs if v.name != "axis[5].set"})
    found = choose(RunSpec(), cast(System, SimpleNamespace(components={"plant": plant}, connections=[])))
    assert found["plant"].recorded == [f"axis[{k}].set" for k in range(1, 5)]


def test_what_is_asked_for_must_be_there() -> None:
    wrong = with_changes(RunSpec(), {"record_also": "plant.cell"})
    with pytest.raises(TouchdownError, match=r"run\.record_also: there is nothing called plant\.cell; did"):
        choose(wrong, system(3))


# of mounts: what happened up to then, of which a drop keeps the last; heat of a foundation; of bearings,
# temperatures and gaps, which follow from the recorded heat; of magnets, heat of their eddy currents, and
# what is injected, which its lines state
ONLY_AT_END = re.compile(
    r"(^|\.)(peak_stroke|peak_stop_force|stop_time|stop_hits|mount_[A-D]\.heat\.\w+|modes_heat|eddy_loss|injected)$"
    r"|^temperature\.\w+$|^gaps\.(play|clearance)$"
)


@pytest.mark.parametrize("name", fmu_names())
def test_all_that_the_projects_models_report_is_recorded(name: str) -> None:
    found = InProcessComponent(name, recipe(name).model).variables.values()
    left = [v.name for v in found if v.causality is Causality.LOCAL and not reported(v.name)]
    assert [one for one in left if "[" not in one and not ONLY_AT_END.search(one)] == []
