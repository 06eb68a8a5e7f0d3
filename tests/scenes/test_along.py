"""The scenes that leave the plane, taken by the verbs that run, show and hand on a scene."""

from __future__ import annotations

from pathlib import Path

import pytest

from touchdown.master.cli import main

SCENES = ("disk-upright-pair", "disk-thrust", "rotor1-upright")


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_verbs_take_it(name: str, tmp_path: Path) -> None:
    run = str(tmp_path / "run")
    assert main(["scenes", name]) == 0
    assert main(["run", name, "--in-process", "--duration", "6 ms", "-o", run, "--quiet"]) == 0
    assert main(["report", run]) == 0
    assert (tmp_path / "run/report.html").stat().st_size > 10_000
    assert main(["loop", name, "-o", str(tmp_path / "loop")]) == 0
    assert main(["ssp", name, "-o", str(tmp_path / "it.ssp")]) == 0
    assert (tmp_path / "it.ssp").is_file()
