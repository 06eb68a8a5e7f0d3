"""Made orbits of a journal in its bearing, with the force that the bore would press back with.

Each generator is a function of a few numbers and gives an orbit of which the answer is known. The bearing's
centre is the origin, angles are counter-clockwise from x, lengths are over the clearance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from touchdown.master.results.whirl.verdict import OrbitVerdict, classify

CLEARANCE = 3e-4  # m
BOTTOM = -0.5 * math.pi
TURN = 2.0 * math.pi
STIFFNESS = 1e5  # N over the clearance
FRICTION = 0.15
TOUCHING = 1.02
HELD = 3e-4  # s that a hop's contact lasts


@dataclass(frozen=True)
class Made:
    """An orbit, z = x + iy over the clearance, in a bore whose centre may stand off."""

    time: np.ndarray  # s
    z: np.ndarray
    bore: complex = 0.0
    spin: float = 900.0  # rad/s

    @property
    def force(self) -> tuple[np.ndarray, np.ndarray]:
        """Of the bore on the journal (N): inwards where it is indented, and friction against the spin."""
        out = self.z - self.bore
        normal = STIFFNESS * np.maximum(np.abs(out) - 1.0, 0.0)
        inwards = -out / np.maximum(np.abs(out), 1e-12)
        f = normal * inwards * (1.0 + 1j * FRICTION * np.sign(self.spin))
        return np.real(f), np.imag(f)

    def judged(self, with_force: bool = True) -> OrbitVerdict:
        """What the classifier says of it."""
        x, y = CLEARANCE * np.real(self.z), CLEARANCE * np.imag(self.z)
        return classify(self.time, x, y, CLEARANCE, self.spin, self.force if with_force else None)

    def noisy(self, size: float, seed: int) -> Made:
        """With normal noise of `size` (over the clearance) in both directions."""
        random = np.random.default_rng(seed)
        noise = random.normal(0.0, size, (2, len(self.z)))
        return replace(self, z=self.z + noise[0] + 1j * noise[1])

    def spinning(self, spin: float) -> Made:
        """The same orbit of a rotor that spins so (rad/s)."""
        return replace(self, spin=spin)


def times(end: float, rate: float = 20e3) -> np.ndarray:
    """From 0 to `end` (s) at `rate` (Hz)."""
    return np.arange(round(end * rate) + 1) / rate


def along(time: np.ndarray, angle: np.ndarray, radius: np.ndarray | float = TOUCHING) -> Made:
    """By its angle (rad) and its radius."""
    return Made(time, radius * np.exp(1j * angle))


def circle(
    frequency: float, radius: float = TOUCHING, centre: complex = 0.0, end: float = 0.5, rate: float = 20e3
) -> Made:
    """About `centre`, at `frequency` (Hz, counter-clockwise)."""
    time = times(end, rate)
    return Made(time, centre + radius * np.exp(1j * (BOTTOM + TURN * frequency * time)))


def ellipse(frequency: float, ratio: float, tilt: float = 0.0, long: float = TOUCHING) -> Made:
    """With half axes `long` and ratio * long, tilted (degrees)."""
    time = times(0.5)
    phase = TURN * frequency * time
    return Made(time, long * (np.cos(phase) + 1j * ratio * np.sin(phase)) * np.exp(1j * math.radians(tilt)))


def star(
    hop: float, frequency: float, radius: float = TOUCHING, rate: float = 20e3, end: float = 0.5
) -> Made:
    """Straight flights from bore to bore, each `hop` degrees on; `frequency` counts whole turns (Hz)."""
    time = times(end, rate)
    each = hop / 360.0 / abs(frequency)  # s
    number, within = np.divmod(time, each)
    flown = np.clip((within - HELD) / (each - HELD), 0.0, 1.0)
    corner = math.copysign(math.radians(hop), frequency)
    z = radius * np.exp(1j * number * corner) * (1.0 + flown * (np.exp(1j * corner) - 1.0))
    return Made(time, z * np.exp(1j * BOTTOM))


def turns(count: float, frequency: float, begin: float = 0.1, end: float = 0.5, rate: float = 20e3) -> Made:
    """Rests at the bottom, turns `count` times at `frequency` (Hz, with its sign), and rests."""
    time = times(end, rate)
    turned = np.clip((time - begin) * abs(frequency), 0.0, count)
    return along(time, BOTTOM + math.copysign(TURN, frequency) * turned)


def pendulum(amplitude: float, decay: float = 0.0, frequency: float = 25.0, end: float = 0.5) -> Made:
    """Swings about the bottom, `amplitude` degrees to each side, dying at `decay` (1/s)."""
    time = times(end)
    swing = math.radians(amplitude) * np.exp(-decay * time) * np.sin(TURN * frequency * time)
    return along(time, BOTTOM + swing)


def after_one_another(*parts: tuple[float, float], rate: float = 20e3) -> Made:
    """Along the bore: stretches of (seconds, frequency in Hz with its sign), one after the other."""
    speeds = np.concatenate([np.full(round(length * rate), frequency) for length, frequency in parts])
    angle = BOTTOM + TURN * np.concatenate([[0.0], np.cumsum(speeds)]) / rate
    return along(np.arange(len(angle)) / rate, angle)


def bouncing(seed: int, height: float = 0.8, end: float = 0.5) -> Made:
    """Parabolas up from the bottom, each lower than the one before and a little aside."""
    random = np.random.default_rng(seed)
    time = times(end)
    y, x = np.zeros_like(time), np.zeros_like(time)
    begin, length, at = 0.0, 0.03, 0.0
    while begin < end:
        to = at + random.normal(0.0, 0.01)
        part = (time >= begin) & (time < begin + length)
        gone = (time[part] - begin) / length
        y[part] = height * 4.0 * gone * (1.0 - gone)
        x[part] = at + (to - at) * gone
        begin, length, height, at = begin + length, max(0.8 * length, 2e-3), 0.64 * height, to
    return Made(time, x + 1j * (y - TOUCHING))


def over_the_top(rate: float, end: float = 0.5) -> Made:
    """A pendulum along the bore that starts at the bottom at `rate` (rad/s), as gravity has it."""
    time = times(end)
    angle, speed = np.zeros_like(time), rate
    step = float(time[1] - time[0])
    for i in range(1, len(time)):
        speed -= 0.5 * step * 9.81 / CLEARANCE * math.sin(angle[i - 1])
        angle[i] = angle[i - 1] + step * speed
        speed -= 0.5 * step * 9.81 / CLEARANCE * math.sin(angle[i])
    return along(time, BOTTOM + angle)
