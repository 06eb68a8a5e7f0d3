"""A foundation's file: made by the command, taken by a scene's component."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from places import ROOT

import touchdown
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened

EXAMPLE = str(ROOT / "examples" / "frame_matrices")
SCENE = """
extends = "rotor1-foundation"
[components.foundation]
fmu = "foundation"
settings = "frame.toml"
[components.foundation.set]
"mode[2].damping_ratio" = 0.05
"""


def test_a_scene_takes_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its modes are those of the shipped scene; what the component sets itself counts before them."""
    asked = ["--at", "A=2,B=4", "--modes", "4", "-o", str(tmp_path / "frame.toml")]
    assert main(["import", "foundation", EXAMPLE, *asked]) == 0
    said = capsys.readouterr().out
    assert "mode 1: 257.7 Hz" in said
    assert "other modes, left out, make up to 21 %" in said
    (tmp_path / "own.toml").write_text(SCENE, encoding="utf-8")
    own, shipped = touchdown.load(tmp_path / "own.toml"), touchdown.load("rotor1-foundation")
    names = [f"foundation.mode[{k}].{what}" for k in (1, 2, 3, 4) for what in ("omega", "A.x", "B.y")]
    with opened(own, in_process=True) as one, opened(shipped, in_process=True) as other:
        told, wanted = ([system.value(name) for name in names] for system in (one, other))
        assert one.value("foundation.mode[2].damping_ratio") == 0.05
    np.testing.assert_allclose(told, wanted, rtol=1e-8)


def test_a_file_that_tells_nothing_of_the_component_is_refused(tmp_path: Path) -> None:
    text = '[set."housing_*"]\nmass = 1\n'
    (tmp_path / "frame.toml").write_text(text, encoding="utf-8")
    (tmp_path / "own.toml").write_text(SCENE, encoding="utf-8")
    with pytest.raises(TouchdownError, match=r"frame\.toml' says nothing of foundation"):
        touchdown.load(tmp_path / "own.toml")
    (tmp_path / "own.toml").write_text(SCENE.replace('"frame.toml"', "3"), encoding="utf-8")
    with pytest.raises(TouchdownError, match="settings = 3 must be text"):
        touchdown.load(tmp_path / "own.toml")
