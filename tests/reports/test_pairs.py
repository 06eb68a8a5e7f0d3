"""What is told of a clamped pair, and of the effects that are in a run or left out."""

from __future__ import annotations

from pathlib import Path

import pytest

import touchdown
from touchdown.reports.chapters.basis import model
from touchdown.reports.subject import Subject

PAIR = "disk-upright-pair"


def test_effects_are_in_or_left_out(tmp_path: Path) -> None:
    changes = {"bearing.ring.hoop": 1, "bearing.ring.growth": 1, "bearing.outer_ring.seat": "loose"}
    scene = touchdown.load(PAIR).set({"run.duration": "2 ms", **changes})
    effects = model(Subject(touchdown.run(scene, tmp_path, in_process=True)))["effects"]
    assert [row[1:] for row in effects] == [
        ["bearing", "–"],
        ["bearing (outer ring loose)", "–"],
        *(["–", "bearing"] for _ in ("orbit", "heat")),
        ["–", "rotor"],
    ]


def test_a_pair_states_its_preload(tmp_path: Path) -> None:
    scene = touchdown.load(PAIR).set({"run.duration": "1 ms", "bearing.ring.growth": 1})
    result = touchdown.run(scene, tmp_path / "sound", in_process=True)
    seat = result.summary["seats"]["A"]
    assert seat["pair_preload_standing"] == pytest.approx(100.0, rel=1e-6)
    assert seat["pair_preload_turning"] > 101.0
    assert seat["pair_interference_turning"] > seat["pair_interference_standing"] > 1e-6
    assert not any("clamped" in warning for warning in result.warnings)
    absurd = scene.set({"bearing.preload": 0.0, "bearing.interference": "200 um"})
    crushed = touchdown.run(absurd, tmp_path / "absurd", in_process=True)
    (said,) = (warning for warning in crushed.warnings if "clamped" in warning)
    assert "dents a race. Check bearing.preload or .interference" in said
