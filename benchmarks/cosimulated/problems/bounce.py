"""A ball of 1 kg that falls by 1 mm, twenty times, on an undamped one-sided spring of 1e6 N/m."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cosimulated.problems.coupled import Coupled
from cosimulated.runs import Motion, Tried
from touchdown.validation import bodies

RATE = 1000.0  # rad/s, at which it would swing on the spring
GRAVITY, HEIGHT = 9.81, 1e-3  # m/s2, m
SPEED = (2.0 * GRAVITY * HEIGHT) ** 0.5  # m/s, at the spring
FALL = SPEED / GRAVITY  # s
CONTACT = (np.pi + 2.0 * np.arctan(GRAVITY / (RATE * SPEED))) / RATE  # s
PERIOD = 2.0 * FALL + CONTACT  # s


@dataclass(frozen=True)
class Bounce(Coupled):
    """The ground gives force, the ball takes it."""

    duration: float = 20.0 * PERIOD

    title = "Ball on an undamped one-sided spring, 20 bounces; in 1 ms it would swing on it by 1 rad"
    giver, taker = "s1", "s2"
    tried = Tried((1e-3, 3e-4, 1e-4), 1e-3, (1e-6, 1e-8, 1e-10), (1e-2, 1e-3, 1e-4))

    def parts(self) -> Mapping[str, bodies.Settings]:
        """Ground and ball."""
        return bodies.bounce(RATE)

    def exact(self, times: np.ndarray) -> np.ndarray:
        """By pieces: fall, swing, rise."""
        t = np.mod(times, PERIOD)
        swing = RATE * np.clip(t - FALL, 0.0, CONTACT)
        sag = GRAVITY / RATE**2
        pressed = sag * (np.cos(swing) - 1.0) - SPEED / RATE * np.sin(swing)
        leaving = -RATE * sag * np.sin(swing) - SPEED * np.cos(swing)
        up, down = t < FALL, t > FALL + CONTACT
        away = np.where(up, t, t - PERIOD)  # from the highest place
        free = up | down
        x = np.where(free, HEIGHT - 0.5 * GRAVITY * away**2, pressed)
        v = np.where(free, -GRAVITY * away, leaving)
        return np.stack([0.0 * x, 0.0 * v, x, v], axis=1)

    def stored(self, states: np.ndarray) -> np.ndarray:
        """In motion, height and spring."""
        _, _, x, v = states.T
        return 0.5 * v**2 + GRAVITY * x + 0.5 * (RATE * np.minimum(x, 0.0)) ** 2

    def energy(self, motion: Motion) -> float:
        """The largest change there is on the way."""
        change = self.stored(motion.rows[:, :4]) / (GRAVITY * HEIGHT) - 1.0
        return float(change[np.argmax(np.abs(change))])
