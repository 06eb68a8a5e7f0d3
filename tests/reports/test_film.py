"""A drop as a film."""

from __future__ import annotations

import base64
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import touchdown
from touchdown.reports.animation import write_film
from touchdown.reports.motion import Motion, motions, moving
from touchdown.reports.subject import Subject


def unpacked(text: str, width: int) -> np.ndarray:
    """Numbers of a page, in rows."""
    return np.frombuffer(base64.b64decode(text), "<f4").reshape(-1, width)


@pytest.fixture(scope="module")
def short(tmp_path_factory: pytest.TempPathFactory) -> touchdown.Result:
    """A drop that ends just after it touched."""
    scene = touchdown.load("disk-caged-simplified").set(
        {"run.duration": "8.4 ms", "run.macro_step": "20 us"}
    )
    return touchdown.run(scene, in_process=True)


@pytest.fixture(scope="module")
def motion(short: touchdown.Result) -> Motion:
    """Of its bearing."""
    ((found,), lacking) = motions(Subject(short))
    assert not lacking
    return found


def test_what_moves_is_what_was_recorded(short: touchdown.Result, motion: Motion) -> None:
    rows = short.recording.time
    y = np.interp(motion.time, rows, short.recording["rotor.A.y"] - short.recording["housing.seat.y"])
    assert motion.journal[:, 1] == pytest.approx(y, abs=1e-15)
    turned = np.diff(motion.journal[:, 2]) / np.diff(motion.time)
    assert turned == pytest.approx(942.5, rel=1e-3)
    assert np.ptp(np.diff(motion.balls, axis=1)) < 1e-12
    assert np.all(np.diff(motion.time) > 0.0)
    (told,) = json.loads(moving([motion])["data"])["seats"]  # a page gets the same
    unit = motion.shape.magnified / motion.shape.journal
    assert unpacked(told["journal"], 3)[:, 0] == pytest.approx(motion.journal[:, 0] * unit, abs=1e-6)


def test_a_journal_that_presses_is_drawn_at_the_bore(motion: Motion) -> None:
    s, pressed = motion.shape, np.hypot(*motion.force.T) > 1.0
    assert pressed.any()
    away = np.hypot(*motion.journal[pressed, :2].T) * s.magnified + s.journal
    assert away == pytest.approx(s.bore, rel=0.03)


@pytest.fixture(scope="module")
def upright() -> touchdown.Result:
    """A fall along the shaft that ends just after the shoulder landed."""
    scene = touchdown.load("disk-upright-pair").set({"run.duration": "6.2 ms"})
    return touchdown.run(scene, in_process=True)


def test_a_shoulder_that_presses_is_drawn_at_the_face(upright: touchdown.Result) -> None:
    ((found,), lacking) = motions(Subject(upright))
    assert not lacking
    assert found.side is not None
    side, bottom = found.side, max(z for _, z in found.side.parts.ring[0])
    assert side.upright
    shoulder = sorted({z for _, z in side.parts.rotor})[1]  # the lower edge of its collar
    presses = side.force > 0.2 * side.largest_force
    assert 5 < np.sum(presses) < 0.8 * len(presses)
    gaps = np.array([
        side.moved([(1.0, shoulder)], side.rotor[k])[0, 1] - side.moved([(1.0, bottom)], side.ring[k])[0, 1]
        for k in range(len(found.time))
    ])  # fmt: skip
    assert np.max(np.abs(gaps[presses])) < 0.02  # some micrometres of indentation, magnified
    assert gaps[0] == pytest.approx(0.16, abs=0.001)  # the film begins a little after the fall
    (seat,) = json.loads(moving([found])["data"])["seats"]  # all arrows have one scale
    told = seat["side"]
    assert len(unpacked(told["moves"], 3)) == len(unpacked(told["rings"], 3)) == len(found.time)
    assert unpacked(told["force"], 1).max() == 1.0
    assert told["largest"] == pytest.approx(side.largest_force)
    assert np.abs(unpacked(told["force"], 1)).max() > 1e3 * np.abs(unpacked(seat["force"], 2)).max()


@pytest.mark.parametrize(("suffix", "run"), [(".gif", "short"), (".mp4", "short"), (".gif", "upright")])
def test_a_film_is_made(request: pytest.FixtureRequest, tmp_path: Path, suffix: str, run: str) -> None:
    if suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg")
    ((motion,), _) = motions(Subject(request.getfixturevalue(run)))
    few = slice(None, None, max(1, len(motion.time) // 8))
    fewer = {name: values[few] for name, values in vars(motion).items() if isinstance(values, np.ndarray)}
    seen: list[int] = []
    path = write_film(
        [replace(motion, **fewer)], "A drop", tmp_path / f"drop{suffix}", lambda: seen.append(1)
    )
    assert path.stat().st_size > 5_000
    assert len(list(tmp_path.iterdir())) == 1
    if suffix == ".gif":
        with Image.open(path) as film:
            assert film.n_frames == len(seen) > 2
