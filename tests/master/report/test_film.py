"""A drop as a film."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import touchdown
from touchdown.master.report.animation import Motion, motions, write_film
from touchdown.master.report.subject import Subject


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


def test_a_journal_that_presses_is_drawn_at_the_bore(motion: Motion) -> None:
    s, pressed = motion.shape, np.hypot(*motion.force.T) > 1.0
    assert pressed.any()
    away = np.hypot(*motion.journal[pressed, :2].T) * s.magnified + s.journal
    assert away == pytest.approx(s.bore, rel=0.03)


def test_a_page_gets_the_same(motion: Motion) -> None:
    told = json.loads(motion.for_page())
    assert len(told["time"]) == len(told["journal"]) == len(motion.time)
    unit = motion.shape.magnified / motion.shape.journal
    assert np.array(told["journal"])[:, 0] == pytest.approx(motion.journal[:, 0] * unit, abs=1e-4)


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_a_film_is_made(motion: Motion, tmp_path: Path, suffix: str) -> None:
    if suffix == ".mp4":
        pytest.importorskip("imageio_ffmpeg")
    few = slice(None, None, max(1, len(motion.time) // 8))
    parts = {name: getattr(motion, name)[few] for name in vars(motion) if name != "shape"}
    seen: list[int] = []
    path = write_film(
        [Motion(motion.shape, **parts)], "A drop", tmp_path / f"drop{suffix}", lambda: seen.append(1)
    )
    assert path.stat().st_size > 5_000
    assert len(list(tmp_path.iterdir())) == 1
    if suffix == ".gif":
        with Image.open(path) as film:
            assert film.n_frames == len(seen) > 2
