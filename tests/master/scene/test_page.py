"""The page of the scene file has every key that is read."""

from __future__ import annotations

import re
from pathlib import Path

from touchdown.master.scene.file import OTHERS
from touchdown.master.scene.gaps import RotorGap
from touchdown.master.scene.requirements import KINDS
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit.reader import kinds

PAGE = (Path(__file__).parents[3] / "docs" / "scene-file.md").read_text(encoding="utf-8")


def test_every_key_is_there() -> None:
    declared = [name for one in (RotorGap, Scene, ComponentSpec, RunSpec) for name in kinds(one)]
    keys = {*OTHERS, *KINDS, *declared}
    assert {"impact_step", "sampled", "energy_scale"} <= keys
    assert {key for key in keys if not re.search(rf"(?m)(^|[`\[.]){key}[`\]. ]", PAGE)} == set()
