"""A run's result, as Python and notebooks look at it."""

from __future__ import annotations

import gc
import pickle
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.coupling.simulation import open_system
from touchdown.master.results import run
from touchdown.master.results.recording import NotRecordedError, Recording
from touchdown.master.results.result import Result
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene


def short(name: str, duration: float = 0.01) -> Result:
    """A short run in a temporary folder."""
    return run_scene(load_scene(name).set({"run.duration": duration}), None, in_process=True)


@pytest.fixture(scope="module")
def detailed() -> Result:
    """Of a bearing that tells of each ball."""
    return short("disk-caged-detailed", 0.012)


def test_the_data_are_the_recording_s(detailed: Result) -> None:
    recording = Recording(detailed.folder / "result.h5")
    data = detailed.data
    assert data.sizes == {"time": len(recording.time)}
    assert data.attrs["scheme"] == "interface"
    assert set(data) == {name for name, _ in recording.columns()}
    for name, unit in recording.columns():
        assert data[name].attrs["units"] == unit
        assert data[name].values.tobytes() == recording.as_read(name).tobytes()
    np.testing.assert_array_equal(data["rotor.A.y"][5:9], recording["rotor.A.y"][5:9])
    assert float(data["rotor.A.y"].sel(time=0.0, method="nearest")) == pytest.approx(0.0, abs=1e-6)
    recording.close()


def test_data_are_read_when_they_are_looked_at(detailed: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[str] = []
    get = Recording.__getitem__

    def watched(self: Recording, name: str) -> np.ndarray:
        read.append(name)
        return get(self, name)

    monkeypatch.setattr(Recording, "__getitem__", watched)
    data = replace(detailed).data
    assert "units" in repr(data["bearing.contact.force"])
    assert read == []
    data["rotor.A.x"].max()
    assert set(read) == {"rotor.A.x"}


def test_columns_as_pandas_has_them(detailed: Result) -> None:
    frame = detailed.to_pandas(["rotor.A.x", "bearing.contact.force"])
    assert list(frame) == ["rotor.A.x", "bearing.contact.force"]
    assert frame.index.name == "time"
    assert frame["bearing.contact.force"].max() == float(detailed.data["bearing.contact.force"].max())
    assert set(detailed.to_pandas()) == set(detailed.data)
    with pytest.raises(NotRecordedError, match=r"rotor\.A\.q was not recorded"):
        detailed.to_pandas(["rotor.A.q"])
    with pytest.raises(NotRecordedError, match=r"rotor was not recorded"):
        detailed.to_pandas(["rotor"])
    assert list(detailed.to_pandas("rotor.A.x")) == ["rotor.A.x"]


def test_a_temporary_folder_lasts_as_long_as_its_data() -> None:
    result = short("disk-caged-simplified", 1e-3)
    folder, column = result.folder, result.data["rotor.A.y"]
    del result
    gc.collect()
    assert folder.is_dir()
    assert float(column.min()) < 0.0
    del column
    gc.collect()
    assert not folder.exists()


def test_a_result_stays_its_own_run_s(tmp_path: Path) -> None:
    scene = load_scene("disk-caged-simplified").set({"run.duration": 1e-3})
    first = run_scene(scene, tmp_path, in_process=True)
    kept = pickle.dumps(first)
    np.testing.assert_array_equal(pickle.loads(kept).data["rotor.A.y"], first.data["rotor.A.y"])
    assert len(pickle.dumps(first)) == len(kept)  # without the data that were looked at
    run_scene(scene.set({"run.duration": 2e-3}), tmp_path, in_process=True)
    assert float(first.data["time"][-1]) == pytest.approx(1e-3)
    with pytest.raises(TouchdownError, match="is of another run by now"):
        pickle.loads(kept)
    shutil.rmtree(tmp_path)
    assert first.to_pandas("rotor.A.x").size == first.data.sizes["time"]
    with pytest.raises(TouchdownError, match="cannot read"):
        pickle.loads(kept)


def test_a_result_in_a_temporary_folder_is_not_pickled(detailed: Result) -> None:
    with pytest.raises(TouchdownError, match="give the run a folder"):
        pickle.dumps(detailed)


@pytest.mark.parametrize(
    "look",
    [
        lambda d: d.isel(time=slice(4, 40, 3)).isel(time=[0, 2]),
        lambda d: d.where(d["rotor.A.y"] < -1e-4, drop=True),
        lambda d: pickle.loads(pickle.dumps(d)).isel(time=[2, 1]),
        lambda d: d.load().rolling(time=3).mean(),
    ],
)
def test_data_are_looked_at_as_in_memory(look: Callable[..., Any], detailed: Result) -> None:
    names = ["rotor.A.y", "bearing.contact.force"]
    frame = detailed.to_pandas(names)
    memory = xarray.Dataset({n: ("time", frame[n].to_numpy()) for n in names}, {"time": frame.index})
    xarray.testing.assert_equal(look(replace(detailed).data[names]), look(memory))


def test_what_the_ending_knows_has_a_value(detailed: Result) -> None:
    scene_input = "bearing.journal.omega"
    assert scene_input in detailed.ending
    for name, component in detailed.ending.components.items():
        assert all(detailed.ending.value(f"{name}.{v}") is not None for v in component.variables)
    assert "rotor.nothing" not in detailed.ending
    with pytest.raises(TouchdownError, match=r"no value of rotor\.nothing"):
        detailed.ending.value("rotor.nothing")


@pytest.mark.parametrize("failing", ["rotor", "bearing"])
def test_a_component_that_answers_nothing_after_it_failed(
    failing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise TouchdownError("it answers no more")

    def fail(time: float, step: float) -> None:
        if time > 1e-3:
            monkeypatch.setattr(component, "read", refuse)
            raise TouchdownError("it broke")
        stepped(time, step)

    scene = load_scene("disk-caged-detailed").set({"run.duration": 2e-3})
    system = open_system(scene, in_process=True)
    component = system.components[failing]
    stepped = component.step
    monkeypatch.setattr(component, "step", fail)
    monkeypatch.setattr(run, "open_system", lambda *_: system)
    result = run_scene(scene, None, in_process=True)
    assert (result.ended, result.stopped_because) == (Ended.STOPPED, "it broke")
    assert len(result.data["time"]) > 5
    assert not result.ending.components[failing].values


def test_it_tells_how_the_run_ended(detailed: Result) -> None:
    assert detailed.ended is Ended.COMPLETED
    assert repr(detailed).startswith("Result of disk-caged-detailed. No whirl within 0.012 s.\n")
    assert "largest contact force [N]" in repr(detailed)
    html = detailed._repr_html_()
    assert html.startswith("<p>No whirl within 0.012 s.</p><table>")
    assert html.count("<tr>") == len(detailed.flat)


def test_a_bearing_that_is_touched_before_the_shutdown_is_said() -> None:
    """A disk pushed down at 0.1 m/s, which a magnetic bearing without stiffness does not hold back."""
    brief = {"run.duration": "1 ms", "run.macro_step": "100 us", "amb.shutdown_time": "20 ms"}
    scene = load_scene("disk-caged-simplified").set(brief)
    pushed = {"amb.stiffness": 0.0, "amb.damping": 0.0, "rotor.vy": -0.1}
    for more, said in ((pushed, True), ({}, False)):
        warnings = run_scene(scene.set(more), None, in_process=True).warnings
        assert any("before the shutdown: the magnetic bearings do not hold" in w for w in warnings) == said
