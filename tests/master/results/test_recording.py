"""The recording as other tools see it: netCDF-4, with dimension, units and what was run."""

from __future__ import annotations

from pathlib import Path

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
