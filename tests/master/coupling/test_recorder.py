"""The file of a recording is whole after every write; what is recorded of which component."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import h5netcdf
import h5py
import numpy as np
import pytest

from touchdown.fmus.recipes import names, recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import Kind, Variable, reported
from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling.recorder import choose
from touchdown.master.coupling.recording_file import CHUNK, END, PAGE, TIME, Column, Contents, Table
from touchdown.master.coupling.system import System
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.modelkit.variables import Causality, Variability

COLUMNS = [Column(f"part{i % 2}/x{i}", "m", "a place " * (20 * i)) for i in range(4)]
CONTENTS = Contents({"title": "kept"}, COLUMNS, ["part0"])
MOST = 70 * CHUNK
APPENDED = (1, CHUNK, 2 * CHUNK + 7)  # rows at a time: the first, and over chunks


class KilledError(BaseException):
    """Stands for SIGKILL."""


def block(begin: int, count: int) -> np.ndarray:
    """Rows of times 0, 1, 2 ...; each column has a value of its own at each."""
    times = np.arange(begin, begin + count, dtype=float)
    return np.column_stack([times, *(times + 1e4 * (i + 1) for i in range(len(COLUMNS)))])


def lives(path: Path) -> Iterator[tuple[Table, int]]:
    """A table as it grows and ends, with the rows it was given."""
    with path.open("w+b") as file:
        table, rows = Table.created(file, CONTENTS, MOST), 0
    table.commit()
    yield table, rows
    for count in APPENDED:
        table.append(block(rows, count))
        rows += count
        yield table, rows
    for component in CONTENTS.keeping:
        table.keep(component, {f"ball[{i}].x": float(i) for i in range(12)})
    table.commit()
    yield table, rows


def check_whole(path: Path, rows: int) -> None:
    """Every column has `rows` rows at least, and nothing but what was written."""
    with h5py.File(path) as file:
        assert file.attrs["title"] == "kept"
        assert len(file[TIME]) >= rows
        there = len(file[TIME])
        expected = block(0, there).T
        for column, values in zip((TIME, *(c.name for c in COLUMNS)), expected, strict=True):
            np.testing.assert_array_equal(file[column][:there], values)
        assert {len(file[END][component].attrs) for component in CONTENTS.keeping} <= {0, 12}


@pytest.mark.parametrize("torn", [False, True])  # between two writes; amid one, at the end of a page
def test_a_kill_at_any_write_leaves_a_whole_file(
    torn: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "result.h5"
    pwrite, left = os.pwrite, 0

    def written(descriptor: int, data: memoryview, address: int) -> int:
        nonlocal left
        left -= 1
        if left < 0:
            if torn:
                pwrite(descriptor, data[: PAGE - address % PAGE], address)
            raise KilledError
        return pwrite(descriptor, data, address)

    killed = 0
    while True:
        left, known, life = 10**9, 0, lives(path)
        table, known = next(life)
        left = killed
        monkeypatch.setattr(os, "pwrite", written)
        try:
            for _, rows in life:
                known = rows
        except KilledError:
            check_whole(path, known)
            killed += 1
            continue
        finally:
            monkeypatch.undo()
        check_whole(path, sum(APPENDED))
        table.close()
        break
    assert killed > 40


def test_it_can_be_read_while_it_grows(tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    for table, rows in lives(path):
        check_whole(path, rows)
        with h5netcdf.File(path, "r") as file:
            assert file.dimensions[TIME].size == rows
            assert file["part1"].variables["x3"].dimensions == (TIME,)
        assert table.rows == rows
    table.close()


def test_a_full_disk_leaves_the_file_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "result.h5"
    table, _ = next(lives(path))
    table.append(block(0, 5))
    size = path.stat().st_size

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "pwrite", full)
        with pytest.raises(OSError, match="No space"):
            table.append(block(5, 4 * CHUNK))
    table.close()
    assert path.stat().st_size == size
    check_whole(path, 5)
    again = Table.reopened(path, CONTENTS)
    again.append(block(5, 2))
    again.close()
    check_whole(path, 7)


def test_a_disk_that_is_full_at_any_write_leaves_a_whole_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, pwrite, room = tmp_path / "result.h5", os.pwrite, 0
    left = 0

    def full(descriptor: int, data: memoryview, address: int) -> int:
        nonlocal left
        left -= 1
        if left < 0:
            raise OSError(28, "No space left on device")
        return pwrite(descriptor, data, address)

    while True:
        table, _ = next(lives(path))
        table.append(block(0, 300))
        left = room
        try:
            with monkeypatch.context() as patch:
                patch.setattr(os, "pwrite", full)
                table.append(block(300, 400))
        except OSError:
            table.close()
            check_whole(path, 300)
            again = Table.reopened(path, CONTENTS)
            rows = again.rows
            again.append(block(rows, 2))
            again.close()
            check_whole(path, rows + 2)
            room += 1
        else:
            table.close()
            break
    assert room > 10


def variable(name: str, causality: Causality) -> Variable:
    """A real one."""
    return Variable(
        name, 0, Kind.REAL, causality, Variability.CONTINUOUS, None, None, None, None, description=""
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
    also = with_changes(RunSpec(), {"record_also": "plant.cells.heat7,plant.cell[1]"})
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
# temperatures and gaps, which follow from the recorded heat
AT_END = re.compile(
    r"(^|\.)(peak_stroke|peak_stop_force|stop_time|stop_hits|mount_[A-D]\.heat\.\w+|modes_heat)$"
    r"|^temperature\.\w+$|^gaps\.(play|clearance)$"
)


@pytest.mark.parametrize("name", names())
def test_all_that_the_projects_models_report_is_recorded(name: str) -> None:
    found = InProcessComponent(name, recipe(name).model).variables.values()
    left = [v.name for v in found if v.causality is Causality.LOCAL and not reported(v.name)]
    assert [one for one in left if "[" not in one and not AT_END.search(one)] == []
