"""Recordings as files of other programs, read back by what reads such files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pytest
from scipy.io import loadmat

import touchdown
from touchdown.command.cli import main
from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.master.common.errors import TouchdownError
from touchdown.master.results import export
from touchdown.master.results.recording import INSTANTS
from touchdown.master.results.result import Result
from touchdown.master.scene.file import load_scene
from touchdown.modelkit.variables import flatten

FORCE = "bearing.contact.force"


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    scene = load_scene("disk-caged-simplified").set({"run.duration": "8 ms"})
    found = touchdown.run(scene, tmp_path_factory.mktemp("run"), in_process=True)
    assert found.recording[FORCE].max() > 0.0
    return found


@pytest.mark.parametrize(
    ("to", "library", "read"),
    [
        ("csv", "pandas", pandas.read_csv),
        ("xlsx", "openpyxl", pandas.read_excel),
        ("parquet", "pyarrow", lambda path: pandas.read_parquet(path).reset_index()),
    ],
)
def test_tables_say_what_was_recorded_to_the_bit(to, library, read, result: Result) -> None:
    pytest.importorskip(library)
    assert main(["export", str(result.folder), "--to", to]) == 0
    table = read(result.folder / f"result.{to}")
    time = "time from amb.shutdown_time [s]"
    assert list(table) == [time, *(f"{name} [{unit}]" for name, unit in result.recording.columns())]
    # a sheet has 16 digits
    near = np.testing.assert_allclose if to == "xlsx" else np.testing.assert_array_equal
    near(table[time], result.recording.time)
    near(table[f"{FORCE} [N]"], result.recording[FORCE])
    first = table["bearing.contact.first_time [s]"]  # on the clock of the rows, not that of the simulation
    assert first[0] != first[0]  # NaN: not yet
    near(first.iloc[-1], result.summary["seats"]["A"]["first_contact_time"])
    assert 0.0 <= table[time][first.first_valid_index()] - first.iloc[-1] < 1e-3


def test_matlab_gets_a_vector_for_each_column(result: Result, tmp_path: Path) -> None:
    path = touchdown.export(result, tmp_path / "drop.mat")
    found = loadmat(path)
    np.testing.assert_array_equal(found["bearing_contact_force"].ravel(), result.recording[FORCE])
    heads = {str(name[0]): str(head[0]) for name, head in found["heads"]}
    assert heads["time"] == "time from amb.shutdown_time [s]"
    assert heads["bearing_contact_force"] == f"{FORCE} [N]"
    assert len(heads) == len(result.recording.columns()) + 1
    assert heads.keys() < found.keys()


def test_names_that_matlab_does_not_take(tmp_path: Path) -> None:
    heads = ["a.b [m]", "a_b [m]", "a[1].b [m]", "1.x [m]", "heads [1]", f"{'long' * 30} [m]"]
    frame = pandas.DataFrame(np.ones((2, 6)), pandas.Index([0.0, 1.0], name="time [s]"), heads)
    with (tmp_path / "x.mat").open("wb") as file:
        export._to_mat(frame, file)
    found = loadmat(tmp_path / "x.mat")
    names = [str(name[0]) for name, _ in found["heads"]]
    assert names[:6] == ["time", "a_b", "a_b_", "a_1_b", "x1_x", "heads_"]
    assert [len(found[name]) for name in names] == [2] * 7
    assert max(map(len, names)) < 64


def test_what_cannot_be_written(result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TouchdownError, match="there is no export to 'ods'"):
        touchdown.export(result, tmp_path / "drop.ods")
    (tmp_path / "file").touch()
    with pytest.raises(TouchdownError, match="file: File exists; choose another folder"):
        touchdown.export(result, tmp_path / "file" / "drop.csv")
    monkeypatch.setattr(export, "MAX_SHEET", (100, 16_384))
    monkeypatch.setattr(export, "find_spec", lambda name: None if name == "pyarrow" else name)
    with pytest.raises(TouchdownError, match=r"has \d+ rows and \d+ columns, more than a sheet"):
        touchdown.export(result, tmp_path / "drop.xlsx")
    with pytest.raises(
        TouchdownError, match="parquet takes pyarrow, which is not installed: pip install pyarrow"
    ):
        touchdown.export(result, tmp_path / "drop.parquet")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_every_instant_of_a_model_is_known_as_one() -> None:
    """So that none is shown on the simulation's clock."""
    lengths = {"current_time", "voltage_time", "limited_time", "reach", "period"}
    for name in sorted(fmu_names()):
        for variable in flatten(recipe(name).model.outputs()):
            if variable.spec.unit == "s":
                assert variable.name.rpartition(".")[2] in {*INSTANTS, *lengths}, (name, variable.name)


def test_frames_and_datasets_have_units(result: Result) -> None:
    assert result.to_pandas(FORCE).attrs["units"] == {FORCE: "N"}
    assert result.to_xarray()[FORCE].attrs["units"] == "N"
    assert replace(result).to_xarray()["time"].attrs["units"] == "s"
