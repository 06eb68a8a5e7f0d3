"""Strokes, stops and heat of mounts in a run's figures and in its report."""

from __future__ import annotations

import pytest

import touchdown
from touchdown.master.results.result import Result
from touchdown.reports.blocks import Absent, Remark, Table
from touchdown.reports.chapters.bearings import mounts
from touchdown.reports.subject import Subject

SOFT = {"mass": 0.5, "spring.xx": 1e7, "spring.yy": 1e7, "damper.xx": 100.0, "damper.yy": 100.0}
RUBBED = {"slide[1].stiffness": 2e7, "slide[1].force": 20.0}
STOPPED = {"stop.gap": 5e-6, "stop.stiffness": 1e10, "stop.dissipation": 0.3}


def dropped(values: dict[str, float] | None) -> Result:
    """The first impacts of the disk, on a mount with these settings or on its housing."""
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "12 ms"})
    if values is not None:
        scene = scene.swap(housing="mount").set({f"housing.{k}": v for k, v in {**SOFT, **values}.items()})
    return touchdown.run(scene, in_process=True, pictures=False)


def test_a_stop_that_was_reached_is_told() -> None:
    """When and how hard, from the shutdown on; heat by element is all the heat there is."""
    result = dropped(RUBBED | STOPPED | {"x0": 1e-4})
    s = result.summary
    first = float(str(s["first_contact_time_s"]))
    assert first < float(str(s["stop_reached_time_s"])) < first + 1e-3
    assert int(str(s["stop_hits"])) >= 1
    assert 5.0 < float(str(s["housing_stroke_um"])) < 50.0  # not the 100 um that it is out of line
    expected = 1e10 * (1e-6 * float(str(s["housing_stroke_um"])) - 5e-6) ** 1.5
    assert float(str(s["peak_stop_force_N"])) == pytest.approx(expected, rel=0.05)  # damping adds to it
    heat = sum(float(str(v)) for k, v in s.items() if k.startswith("mount_heat_"))
    assert heat == pytest.approx(result.ending.value("housing.energy.dissipated"), rel=1e-12)
    assert "mount_heat_film_J" not in s
    blocks = mounts(Subject(result))
    rows = next(b for b in blocks if isinstance(b, Table)).rows
    assert rows[0][3].startswith("5")
    assert any(isinstance(b, Remark) and "the stop was reached" in b.text for b in blocks)


def test_a_stop_that_was_not_reached_is_told_as_well() -> None:
    result = dropped(RUBBED | STOPPED | {"stop.gap": 1e-3})
    assert result.summary["stop_reached_time_s"] is None
    assert result.summary["stop_hits"] == 0
    blocks = mounts(Subject(result))
    assert "not reached" in next(b for b in blocks if isinstance(b, Table)).rows[0]
    assert not any(isinstance(b, Remark) for b in blocks)


def test_a_housing_is_no_mount() -> None:
    result = dropped(None)
    assert not [key for key in result.summary if key.startswith(("mount_", "stop_"))]
    with pytest.raises(Absent, match="no bearing sits in a mount"):
        mounts(Subject(result))
