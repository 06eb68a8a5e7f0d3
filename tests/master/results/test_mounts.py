"""Strokes, stops and heat of mounts in a run's figures and in its report."""

from __future__ import annotations

import pytest

import touchdown
from touchdown.master.quantities import MOUNT_HEATS
from touchdown.master.results.result import Result
from touchdown.reports.chapters.bearings import mounts
from touchdown.reports.contents import CHAPTERS, section
from touchdown.reports.layout import Absent
from touchdown.reports.subject import Subject

SOFT = {"mass": 0.5, "spring.xx": 1e7, "spring.yy": 1e7, "damper.xx": 100.0, "damper.yy": 100.0}
RUBBED = {"slide[1].stiffness": 2e7, "slide[1].force": 20.0}
REACHED = '<div class="remark grave"><strong>Careful:</strong> At A the stop was reached'
STOPPED = {"stop.gap": 5e-6, "stop.stiffness": 1e10, "stop.dissipation": 0.3}


def dropped(values: dict[str, float] | None) -> Result:
    """The first impacts of the disk, on a mount with these settings or on its housing."""
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "12 ms"})
    if values is not None:
        scene = scene.swap(housing="mount").set({f"housing.{k}": v for k, v in {**SOFT, **values}.items()})
    return touchdown.run(scene, in_process=True, pictures=False)


def said(result: Result) -> str:
    """The chapter on mounts."""
    chapter = next(c for c in CHAPTERS if c.name == "mounts")
    return section(chapter, Subject(result)).html


def test_a_stop_that_was_reached_is_told() -> None:
    """When and how hard, from the shutdown on; heat by element is all the heat there is."""
    result = dropped(RUBBED | STOPPED | {"x0": 1e-4})
    s = result.summary["seats"]["A"]
    first = s["first_contact_time"]
    assert first < s["stop_reached_time"] < first + 1e-3
    assert s["stop_hits"] >= 1
    assert 5e-6 < s["housing_stroke"] < 50e-6  # not the 100 um that it is out of line
    expected = 1e10 * (s["housing_stroke"] - 5e-6) ** 1.5
    assert s["peak_stop_force"] == pytest.approx(expected, rel=0.05)  # damping adds to it
    heat = sum(s.get(f"mount_heat_{element}", 0.0) for element in MOUNT_HEATS)
    assert heat == pytest.approx(result.ending.value("housing.energy.dissipated"), rel=1e-12)
    assert "mount_heat_film" not in s
    assert mounts(Subject(result))["rows"][0][3].startswith("5")
    assert REACHED in said(result)


def test_a_stop_that_was_not_reached_is_told_as_well() -> None:
    result = dropped(RUBBED | STOPPED | {"stop.gap": 1e-3})
    seat = result.summary["seats"]["A"]
    assert (seat["stop_reached_time"], seat["stop_hits"]) == (None, 0)
    assert "not reached" in mounts(Subject(result))["rows"][0]
    assert 'class="remark' not in said(result)


def test_a_housing_is_no_mount() -> None:
    result = dropped(None)
    assert not [key for key in result.summary if key.startswith(("mount_", "stop_"))]
    with pytest.raises(Absent, match="no bearing sits in a mount"):
        mounts(Subject(result))
