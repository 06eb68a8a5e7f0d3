"""Levitation: how near a magnetic bearing's loop is to instability."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from ..bearings.magnetic.linear import LinearActuator
from ..master.scene.file import load_scene
from ..studies.loop.linear_loops import ClosedLoops, Sampled, loops_of
from ..studies.loop.margins import margins
from ..studies.loop.over_speed import loops_in
from .case import Row

MASS, STIFFNESS, DAMPING = 5.0, 2e5, 400.0  # kg, N/m, N s/m
LINES = 2.0 * math.pi * np.geomspace(1.0, 1e4, 1500)  # rad/s
DELAYED = ((0.0, 100e-6), (0.0, 300e-6), (0.0, 600e-6), (1000.0, 150e-6))  # amplifier (Hz), delay (s)


def _looped(w: float, amplifier: float, delay: float) -> complex:
    """1/(1 + L) of a mass on k + c s, behind an amplifier (Hz; 0: none) and a delay (s)."""
    s = 1j * w
    lag = 1.0 + s / (2.0 * math.pi * amplifier) if amplifier else 1.0
    return 1.0 / (1.0 + (STIFFNESS + DAMPING * s) / (MASS * s * s) / lag * cmath.exp(-s * delay))


def _largest(amplifier: float, delay: float) -> float:
    """Largest size of it, over a fine grid and from there."""
    grid = np.linspace(50.0, 600.0, 20001)
    peak = grid[np.argmax([abs(_looped(w, amplifier, delay)) for w in grid])]
    found: Any = minimize_scalar(
        lambda w: -abs(_looped(w, amplifier, delay)), bounds=(peak - 0.1, peak + 0.1), method="bounded"
    )
    return -float(found.fun)


def sensitivity() -> list[Row]:
    """5 kg on 2e5 N/m and 400 N s/m: without a delay by `touchdown amb-margins` of a scene, with and
    without an amplifier of 500 Hz; with a delay the same search on the formula."""
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
        Row("peak sensitivity, amplifier 500 Hz", "", _largest(500.0, 0.0), slower.peak),
    ]
    for amplifier, delay in DELAYED:
        values = np.array([_looped(w, amplifier, delay) for w in LINES])
        found = margins(lambda w, a=amplifier, d=delay: _looped(w, a, d), LINES, values)
        behind = f"amplifier {amplifier:g} Hz, " if amplifier else ""
        name = f"peak sensitivity, {behind}delay {1e6 * delay:g} us"
        rows.append(Row(name, "", _largest(amplifier, delay), found.peak))
    return rows


def narrow_resonance() -> list[Row]:
    """A mode at 1234.5 Hz with r = 0.9; and rotor I at rest with a damping ratio of 0.001, whose first
    bending mode its controllers almost excite."""
    omega, rows = 2.0 * math.pi * 1234.5, list[Row]()
    for ratio in (1e-3, 1e-5):
        a = np.array([[0.0, 1.0], [-(omega**2), -0.2 * ratio * omega]])
        loops = ClosedLoops(a, np.array([[0.0], [1.0]]), np.array([[0.0, 1.8 * ratio * omega]]), 0.0)
        lines = loops.lines(1e5)
        found = margins(loops.one(0), lines, loops.sensitivity(lines)[:, 0, 0])
        rows.append(Row(f"peak sensitivity, damping ratio {ratio:g}", "", 10.0, found.peak))
    scene = load_scene("rotor1-relevitated").set({"rotor.speed": 0.0, "rotor.damping_ratio": 1e-3})
    found_in = loops_in(scene, [0.0])
    fine = 2.0 * math.pi * np.linspace(1599.05, 1600.05, 2001)
    exact = np.abs(found_in.loops.closed(0.0).balanced().sensitivity(fine)).max(axis=0)
    for axis, name in ((0, "A"), (2, "B")):
        peak = found_in.own.margins[axis].peak
        rows.append(Row(f"peak sensitivity, rotor I, {name}", "", float(exact[axis, axis]), peak))
    return rows


def unstable_loop() -> list[Row]:
    """Gains near 0 and no weight; and the axes that are given neither zone nor margin."""
    still = {f"controller.gain.{name}": 1e-9 for name in ("proportional", "integral", "derivative")}
    scene = load_scene("disk-caged-relevitated").set({"rotor.gravity": 0.0, **still})
    at_rest = loops_in(scene, [0.0]).own
    factor = 0.25 * 4e-7 * math.pi * 200.0**2 * 1e-4
    stiffness = 4.0 * factor * 2.0**2 / 0.6e-3**3 * math.cos(math.pi / 8.0) ** 2
    roots = np.roots([1.65 / (4000.0 * math.pi), 1.65, 0.0, -stiffness])
    grows = float(np.real(roots).max())
    without = len(scene.control) * 2 - len(at_rest.margins)
    return [
        Row("pole that grows", "1/s", grows, 0.0 if at_rest.unstable is None else at_rest.unstable.real),
        Row("axes without a zone", "", 2.0, float(without)),
    ]


def operating_point() -> list[Row]:
    """The disk of 1.65 kg: negative stiffness k_s (1 + (i_h/i_0)^2); with a bias of 0.4 A one coil alone,
    which pulls with half of the gain of two."""
    pole = math.cos(math.pi / 8.0)
    factor = 0.25 * 4e-7 * math.pi * 200.0**2 * 1e-4 * pole
    force, gap = 1.65 * 9.81 / math.sqrt(2.0), 0.6e-3
    hold = force * gap**2 / (4.0 * factor * 2.0)
    stiffness = -4.0 * factor * pole * (2.0**2 + hold**2) / gap**3
    coil = gap * math.sqrt(force / factor)
    both, alone = (_first_axis({"amb.amplifier.bias": bias}) for bias in (2.0, 0.4))
    return [
        Row("holding current, bias 2 A", "A", hold, both.hold),
        Row("k_s, bias 2 A", "N/m", stiffness, both.displacement_factor),
        Row("holding current, bias 0.4 A", "A", coil - 0.4, alone.hold),
        Row("k_i, bias 0.4 A", "N/A", 2.0 * factor * coil / gap**2, alone.current_factor),
        Row("k_s, bias 0.4 A", "N/m", -2.0 * factor * pole * coil**2 / gap**3, alone.displacement_factor),
    ]


def magnet_limits() -> list[Row]:
    """The disk's magnets saturated by the bias, without weight, and their largest force; under its weight
    with a bias above the current limit, where only the lower coil follows the control current."""
    mu0, pole, iron, gap = 4e-7 * math.pi, math.cos(math.pi / 8.0), 0.1, 0.6e-3
    weak = _first_axis({"amb.magnet.flux_limit": 0.35, "rotor.gravity": 0.0})
    high = _first_axis({"amb.amplifier.bias": 8.0})
    rises = mu0 * 200.0 / (2.0 * gap + iron)  # T/A
    dense = [rises * current + iron * 0.35 / (2.0 * gap + iron) for current in (2.0, 6.0)]
    gain, most = 4.0 * dense[0] * rises * 1e-4 / mu0 * pole, dense[1] ** 2 * 1e-4 / mu0 * pole
    return [
        Row("flux density by the bias", "T", dense[0], weak.density()),
        Row("k_i of saturated magnets", "N/A", gain, weak.current_factor),
        Row("largest force of saturated magnets", "N", most, weak.strongest),
        Row("coils that follow, bias 8 A", "", 1.0, float(sum(coil.follows for coil in high.coils))),
    ]


def _first_axis(changes: dict[str, float]) -> LinearActuator:
    """Of the disk's magnetic bearing."""
    loops = loops_of(load_scene("disk-caged-relevitated").set(changes))
    assert isinstance(loops, Sampled)
    return loops.bearings[0].axes[0]
