"""The housing's line in the spectrum of a drop against the model's own linearisation.

The source expects a line at 972 Hz, sqrt(k/m)/2 pi with housing, bearing and disk as one mass of 6.70 kg.
But the disk is held by the housing through contacts that are softer than the support, so the model's line
is the housing's alone, stiffened a little. Printed: eigenfrequencies of the equations linearised at the end
of the run, and the largest line of the housing's velocity between 800 and 1400 Hz after the first second,
as well as that of the rotor's pendulum and its multiples in the ring's velocity.

    python benchmarks/housing_line.py [--scene disk-cageless-detailed] [--duration 3]
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from touchdown.master.coupling.observer import EveryStep
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.coupling.system import System
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.studies.drop.monolithic import Monolith

NAMES = ("housing.seat.vx", "housing.seat.vy", "bearing.ring.x")


def simulated(scene: Scene) -> tuple[System, np.ndarray, np.ndarray]:
    """(System at the end, times from the shutdown, rows of NAMES) at every macro step."""
    system = open_system(scene, in_process=True)
    rows: list[list[float]] = []
    keep = EveryStep(lambda now: rows.append([now.system.value(name) for name in NAMES]))
    simulate(scene, system, observers=[keep])
    zero = system.value(str(scene.zero))
    return system, scene.run.macro_step * (1 + np.arange(len(rows))) - zero, np.array(rows)


def line(values: np.ndarray, step: float, low: float, high: float) -> tuple[float, float]:
    """(Frequency in Hz, amplitude) of the largest line between low and high; Hann window."""
    window = np.hanning(len(values))
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * window)) * 2.0 / window.sum()
    frequency = np.fft.rfftfreq(len(values), step)
    band = np.flatnonzero((frequency >= low) & (frequency <= high))
    peak = band[np.argmax(spectrum[band])]
    return float(frequency[peak]), float(spectrum[peak])


def housing_modes(scene: Scene, system: System) -> list[tuple[float, float]]:
    """(Frequency in Hz, damping ratio) of the modes from 100 to 3000 Hz at the present state."""
    monolith = Monolith(scene)
    jacobian = monolith.jacobian(monolith.zero + 1.0, monolith.state_of(system))
    values = np.linalg.eigvals(jacobian)
    found = [
        (abs(v) / (2.0 * math.pi), -v.real / abs(v))
        for v in values
        if v.imag > 0.0 and 100.0 < abs(v) / (2.0 * math.pi) < 3000.0
    ]
    return sorted(found)


def main() -> None:
    """Print modes and lines."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scene", default="disk-cageless-detailed")
    parser.add_argument("--duration", type=float, default=3.0, help="s")
    options = parser.parse_args()
    scene = load_scene(options.scene).set({"run.duration": options.duration})
    system, time, rows = simulated(scene)
    mass = 1.65 + system.value("housing.mass") + system.value("housing.outer_ring")
    together = math.sqrt(system.value("housing.stiffness") / mass) / (2.0 * math.pi)
    print(f"{scene.name}, {options.duration:g} s; all masses as one: {together:.0f} Hz")
    for frequency, damping in housing_modes(scene, system):
        print(f"  linearised at the end: {frequency:7.1f} Hz, damping ratio {damping:.3g}")
    late = time > 1.0
    step = scene.run.macro_step
    for i, name in enumerate(NAMES[:2]):
        frequency, amplitude = line(rows[late, i], step, 800.0, 1400.0)
        print(f"  line of {name}: {frequency:7.1f} Hz, {amplitude:.2g} m/s")
    speed = np.diff(rows[late, 2]) / step
    first, amplitude = line(speed, step, 20.0, 35.0)
    print(f"  pendulum in the ring's velocity: {first:.2f} Hz, {amplitude:.2g} m/s; multiples:")
    for k in range(2, 7):
        frequency, amplitude = line(speed, step, (k - 0.2) * first, (k + 0.2) * first)
        print(f"    {k}: {frequency:7.2f} Hz = {frequency / first:.3f} times, {amplitude:.2g} m/s")


if __name__ == "__main__":
    main()
