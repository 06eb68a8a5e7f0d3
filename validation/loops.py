"""Levitation: how near a magnetic bearing's loop is to instability."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from ..master.scene.file import load_scene
from ..master.studies.loop.margins import margins
from ..master.studies.loop.over_speed import loops_in
from .case import Kind, Row, case

MASS, STIFFNESS, DAMPING = 5.0, 2e5, 400.0  # kg, N/m, N s/m
LINES = 2.0 * math.pi * np.geomspace(1.0, 1e4, 1500)  # rad/s
DELAYED = ((0.0, 100e-6), (0.0, 300e-6), (0.0, 600e-6), (1000.0, 150e-6))  # amplifier (Hz), delay (s)


def sensitivity(w: float, amplifier: float, delay: float) -> complex:
    """1/(1 + L) of a mass on k + c s, behind an amplifier (Hz; 0: none) and a delay (s)."""
    s = 1j * w
    lag = 1.0 + s / (2.0 * math.pi * amplifier) if amplifier else 1.0
    return 1.0 / (1.0 + (STIFFNESS + DAMPING * s) / (MASS * s * s) / lag * cmath.exp(-s * delay))


def largest(amplifier: float, delay: float) -> float:
    """Largest size of it, over a fine grid and from there."""
    grid = np.linspace(50.0, 600.0, 20001)
    at = grid[np.argmax([abs(sensitivity(w, amplifier, delay)) for w in grid])]
    found: Any = minimize_scalar(
        lambda w: -abs(sensitivity(w, amplifier, delay)), bounds=(at - 0.1, at + 0.1), method="bounded"
    )
    return -float(found.fun)


@case(
    "sensitivity",
    "sensitivity of the levitated loop, as ISO 14839-3 judges it",
    Kind.CLOSED_FORM,
    source="ISO 14839-3:2006 (zones of the largest |S|); S = 1/(1 + L), for a mass on a spring and a "
    "damper 1/(2 z sqrt(1 - z^2)) and a delay margin of atan(c w/k)/w at |L(w)| = 1",
    looked_at=False,
    tolerance=1e-5,
    why="peaks are found between lines 0.6 % apart, then to 1e-9 of the frequency",
)
def loop_sensitivity() -> list[Row]:
    """5 kg on 2e5 N/m and 400 N s/m. Without a delay it is the loop of a scene, as `touchdown loop` takes
    it, with and without an amplifier of 500 Hz; with a delay the same search on the formula."""
    scene = load_scene("disk-caged-simplified").set({"rotor.mass": MASS})
    ideal = loops_in(scene, [0.0]).own.margins[0]
    slower = loops_in(scene.set({"amb.bandwidth": 1000.0 * math.pi}), [0.0]).own.margins[0]
    ratio = DAMPING / (2.0 * math.sqrt(STIFFNESS * MASS))
    k, c = STIFFNESS / MASS, DAMPING / MASS
    crossing = math.sqrt(0.5 * (c * c + math.sqrt(c**4 + 4.0 * k * k)))
    rows = [
        Row("peak sensitivity", "", 0.5 / (ratio * math.sqrt(1.0 - ratio**2)), ideal.peak),
        Row("crossing", "rad/s", crossing, ideal.crossings[0]),
        Row("delay margin", "ms", 1e3 * math.atan(c * crossing / k) / crossing, 1e3 * ideal.delay),
        Row("peak sensitivity, amplifier 500 Hz", "", largest(500.0, 0.0), slower.peak),
    ]
    for amplifier, delay in DELAYED:
        values = np.array([sensitivity(w, amplifier, delay) for w in LINES])
        found = margins(lambda w, a=amplifier, d=delay: sensitivity(w, a, d), LINES, values)
        behind = f"amplifier {amplifier:g} Hz, " if amplifier else ""
        name = f"peak sensitivity, {behind}delay {1e6 * delay:g} us"
        rows.append(Row(name, "", largest(amplifier, delay), found.peak))
    return rows
