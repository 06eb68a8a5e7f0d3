"""The scenes that leave the plane: what they tell of the third direction, and by which verbs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import touchdown
from touchdown.command.cli import main

SCENES = {  # and how long each falls until it has landed, and a little more
    "disk-upright-pair": "6 ms",
    "disk-upright-cageless": "6 ms",
    "disk-upright-caged": "6 ms",
    "disk-thrust": "3 ms",
    "rotor1-upright": "6 ms",
    "compressor-upright": "6 ms",
}

SILICON_NITRIDE = 3200.0  # kg/m3, ISO 20056


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_verbs_take_it(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Run, report and film, each of which tells of the landing."""
    run, film = tmp_path / "run", tmp_path / "drop.gif"
    begun = ["run", name, "--in-process", "--duration", SCENES[name], "--quiet"]
    assert main(["scenes", name]) == 0
    assert main([*begun, "-o", str(run)]) == 0
    assert "first landing on a face" in capsys.readouterr().out
    assert list(run.glob("along*.png"))
    assert main(["report", str(run)]) == 0
    assert "Gap towards −z" in (run / "report.html").read_text(encoding="utf-8")
    assert main(["animate", str(run), "-o", str(film), "--quiet"]) == 0
    assert film.stat().st_size > 20_000


@pytest.mark.parametrize(
    ("name", "push"), [("compressor", 150.0), ("compressor-upright", 150.0 + 14.056 * 9.81)]
)
def test_the_compressor_lands_along_its_shaft(name: str, push: float) -> None:
    """After sqrt(2 m s/F), by its thrust and weight; the impeller stays clear, and so do the seals."""
    scene = touchdown.load(name).set({"run.duration": "6 ms"})
    summary = touchdown.run(scene, in_process=True).summary
    fall = np.sqrt(2.0 * 14.056 * 0.12e-3 / push)
    assert summary["seats"]["A"]["face_landing_time"] == pytest.approx(fall, rel=0.01)
    assert summary["seats"]["A"]["peak_face_force"] > 500.0
    assert 0.1e-3 < summary["gaps"]["impeller"]["least"] < 0.18e-3
    assert min(summary["gaps"][f"seal {end}"]["least"] for end in "AB") > 0.05e-3
    assert {round(gap["least_rotor_speed"] * 30.0 / np.pi, -2) for gap in summary["gaps"].values()} == {
        32e3
    }


def test_fast_balls_are_warned_of() -> None:
    """The mean centrifugal force over the mean load since the landing, beside the recorded rows."""
    speed = {"rotor.speed": "36000 rpm", "bearing.friction.dynamic": 0.5, "run.duration": "0.1 s"}
    scene = touchdown.load("disk-upright-pair").set(speed)
    result = touchdown.run(scene, in_process=True)
    seat, recording = result.summary["seats"]["A"], result.recording
    share, after = seat["ball_centrifugal_share"], recording.time > seat["face_landing_time"]
    pitch, ball = 28.5e-3, 4.8e-3
    mass = SILICON_NITRIDE * np.pi / 6.0 * ball**3
    orbit = recording["bearing.ring.omega"][after] * 0.5 * (1.0 - ball / pitch * np.cos(np.radians(25.0)))
    thrown = mass * 0.5 * pitch * orbit**2
    assert share == pytest.approx(
        np.sum(thrown) / np.sum(recording["bearing.balls.force"][after]), rel=0.05
    )
    assert 0.05 < share < 0.5
    (line,) = [line for line in result.warnings if "centrifugal force is on average" in line]
    slope = np.radians(25.0)  # triangle of the inner race's force, 1, the centrifugal one, the outer's
    outer = np.sqrt(1.0 + share**2 + 2.0 * share * np.cos(slope))
    assert f"about {outer:.3g} times that load" in line
    assert f"at {np.degrees(np.arcsin(np.sin(slope) / outer)):.3g} deg instead of 25 deg" in line


@pytest.mark.slow
def test_studies_take_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Sweep, survival, loop and package of one of them; no drop is said to end in the air."""
    name, folder = "disk-upright-pair", str(tmp_path / "sweep")
    vary = ["--vary", "bearing.shoulder.gap_minus=0.1,0.15 mm"]
    short = ["--in-process", "--duration", "6 ms", "--jobs", "1"]
    assert main(["sweep", name, *vary, *short, "-o", folder]) == 0
    assert "face" in capsys.readouterr().out.splitlines()[1].split()
    assert main(["survival", folder, "--drops", "5"]) == 0
    assert "before the rotor touched" not in capsys.readouterr().out
    assert main(["report", folder]) == 0
    assert main(["compare", name, "--of", "steps", "-o", str(tmp_path / "steps")]) == 0
    assert main(["amb-margins", name, "-o", str(tmp_path / "loop")]) == 0
    swapped = ["--swap", "bearing=angular_caged", *short[:3], "-o", str(tmp_path / "swapped")]
    assert main(["run", name, *swapped, "--quiet"]) == 0  # which has no rating of its own
    assert main(["ssp", name, "-o", str(tmp_path / "it.ssp")]) == 0
    assert (tmp_path / "it.ssp").is_file()
    assert main(["compare", name, "--of", "models", *short[:3], "-o", str(tmp_path / "models")]) != 0
    assert "no journal touches its bore" in capsys.readouterr().err
