"""The recording as other tools see it: netCDF-4, with dimension, units and what was run."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray

from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.recorder import Recorder
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.results.recording import Recording
from touchdown.master.scene.file import load_scene

SCENE = load_scene("disk-caged-detailed").set({"run.duration": 2e-3})
HEADING = {
    "title": "Rigid disk dropped on a detailed caged bearing",
    "scene": "disk-caged-detailed",
    "scheme": "interface",
    "macro_step_s": SCENE.run.macro_step,
}


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of a recording."""
    made = tmp_path_factory.mktemp("run") / "result.h5"
    with opened(SCENE, in_process=True) as system:
        simulate(SCENE, system, made)
    return made


def test_xarray_opens_it(path: Path) -> None:
    recording = Recording(path)
    with xarray.open_datatree(path, engine="h5netcdf") as tree:
        groups = {name: node.to_dataset() for name, node in tree.children.items()}
        assert tree.attrs.items() >= HEADING.items()
        assert tree.attrs["version"]
        assert tree["time"].attrs == {"units": "s", "long_name": "time from the scene's zero"}
        for name, unit in recording.columns():
            component, _, variable = name.partition(".")
            column = groups[component][variable]
            assert column.dims == ("time",)
            assert column.attrs["units"] == unit
            assert column.attrs["long_name"]
            assert column.values.tobytes() == recording[name].tobytes()
            np.testing.assert_array_equal(column["time"], recording.time)
    recording.close()


def test_the_netcdf_library_opens_it(path: Path) -> None:
    library = pytest.importorskip("netCDF4")
    with library.Dataset(path) as file:
        force = file["bearing"]["contact.force"]
        assert (force.dimensions, force.units) == (("time",), "N")
        assert "ball[1].x" in file["at_end"]["bearing"].ncattrs()


def test_elements_of_arrays_are_kept_of_the_end(path: Path) -> None:
    recording = Recording(path)
    with xarray.open_datatree(path, engine="h5netcdf") as tree:
        kept = tree["at_end/bearing"].attrs
        assert recording.at_end("bearing.ball[1].y") == kept["ball[1].y"] != 0.0
    assert "bearing.ball[1].y" not in recording
    recording.close()


@pytest.mark.parametrize("name", ["time", "at_end"])
def test_a_component_cannot_take_the_file_s_own_names(name: str, tmp_path: Path) -> None:
    with opened(SCENE, in_process=True) as system:
        system.components[name] = system.components["housing"]
        with pytest.raises(TouchdownError, match=f"cannot be called {name}"):
            Recorder(tmp_path / "result.h5", SCENE, system, 1)
        del system.components[name]


def replaced(made: Callable[[int], object]) -> Callable[[h5py.File, Path], None]:
    """Puts what is made of the number of rows in place of a column."""

    def replace(file: h5py.File, _: Path) -> None:
        rows = len(file["time"])
        del file["rotor/A.y"]
        file["rotor/A.y"] = made(rows)

    return replace


def stored_elsewhere(file: h5py.File, theirs: Path) -> None:
    rows = len(file["time"])
    del file["rotor/A.y"]
    file["rotor"].create_dataset("A.y", (rows,), "f8", external=[(str(theirs), 0, 8 * rows)])


def swollen(file: h5py.File, _: Path) -> None:
    del file["rotor/A.y"]
    file["rotor"].create_dataset("A.y", (10**11,), "f8", chunks=(10**6,), compression="gzip")


DAMAGES: dict[str, Callable[[h5py.File, Path], None]] = {
    "stored elsewhere": stored_elsewhere,
    "swollen": swollen,
    "text": replaced(lambda rows: ["a"] * rows),
    "two columns": replaced(lambda rows: np.zeros((rows, 2))),
    "short": replaced(lambda rows: np.zeros(rows - 1)),
    "external link": replaced(lambda rows: h5py.ExternalLink("theirs.h5", "/x")),
    "link to nowhere": replaced(lambda rows: h5py.SoftLink("/nowhere")),
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_column_that_is_not_the_file_s_own_is_refused(
    damage: Callable[[h5py.File, Path], None], path: Path, tmp_path: Path
) -> None:
    theirs, copy = tmp_path / "theirs.h5", Path(shutil.copy(path, tmp_path / "copy.h5"))
    rows = len(Recording(path).time)
    with h5py.File(theirs, "w") as file:
        file["x"] = np.zeros(rows)
    with h5py.File(copy, "r+") as file:
        damage(file, theirs)
    with pytest.raises(TouchdownError, match=r"cannot read .*copy\.h5"):
        Recording(copy)["rotor.A.y"]


@pytest.mark.parametrize("times", [0.0, np.inf])
def test_times_that_do_not_follow_each_other(times: float, path: Path, tmp_path: Path) -> None:
    copy = shutil.copy(path, tmp_path / "copy.h5")
    with h5py.File(copy, "r+") as file:
        file["time"][:] = times
    with pytest.raises(TouchdownError, match="times do not follow"):
        Recording(Path(copy))
