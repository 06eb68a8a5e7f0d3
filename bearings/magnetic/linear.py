"""Actuator and controller for small motion about the centre, an axis at a time.

With delta half the difference of the flux linkages of an axis' coils, lambda0 = L0 i0 and alpha half the
angle between a magnet's poles:

    F = (lambda0 / K) cos(alpha) delta          i = (delta - lambda0 cos(alpha) u / s0) / L0
    delta' = w_a L0 (i_c - i + w_r zeta)        zeta' = i_c - i
    s' = w_s (u - s)

u is the journal's displacement, i_c the control current, i the current's deviation, s the sensor's signal.
The negative stiffness acts through the amplifier's bandwidth.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .law import SECTIONS
from .magnet import MU0

Values = Callable[[str], float]  # of a component's parameters, by name, SI


SIGNAL = 1  # which of an actuator's states its sensor's signal is


@dataclass(frozen=True)
class LinearActuator:
    """An axis of `surroundings.amb_actuator`. Its state is delta (V s), s (m) and, with w_r, zeta (A s)."""

    factor: float  # K, N m2/A2
    inductance: float  # L0, V s/A
    bias: float  # A
    gap: float  # m
    pole: float  # cos(alpha)
    amplifier: float  # w_a, rad/s
    reset: float  # w_r, rad/s
    sensor: float  # w_s, rad/s
    gain: float  # of the sensor
    voltage: float  # V

    @classmethod
    def of(cls, value: Values) -> LinearActuator:
        """With the parameters of the model."""
        factor = 0.25 * MU0 * value("magnet.turns") ** 2 * value("magnet.area")
        gap = value("magnet.gap")
        return cls(
            factor=factor,
            inductance=2.0 * factor / gap,
            bias=value("amplifier.bias"),
            gap=gap,
            pole=math.cos(value("magnet.pole_angle")),
            amplifier=value("amplifier.bandwidth"),
            reset=value("amplifier.reset"),
            sensor=value("sensing.bandwidth"),
            gain=value("sensing.gain"),
            voltage=value("supply.voltage"),
        )

    @property
    def current_factor(self) -> float:
        """k_i, N/A."""
        return 4.0 * self.factor * self.bias / self.gap**2 * self.pole

    @property
    def displacement_factor(self) -> float:
        """k_s, N/m; below zero."""
        return -4.0 * self.factor * self.bias**2 / self.gap**3 * self.pole**2

    @property
    def slew(self) -> float:
        """Largest rate of the force at the centre, N/s."""
        return self.current_factor * self.voltage / self.inductance

    @property
    def states(self) -> int:
        """3 with an integral part of the current control, 2 without."""
        return 3 if self.reset > 0.0 else 2

    @property
    def force(self) -> np.ndarray:
        """Force per state (states,)."""
        return np.array([self.inductance * self.bias / self.factor * self.pole, 0.0, 0.0])[: self.states]

    @property
    def rates(self) -> np.ndarray:
        """Rates of the state per state (states, states)."""
        w = self.amplifier
        every = np.array(
            [
                [-w, 0.0, w * self.inductance * self.reset],
                [0.0, -self.sensor, 0.0],
                [-1.0 / self.inductance, 0.0, 0.0],
            ]
        )
        return every[: self.states, : self.states]

    @property
    def moved(self) -> np.ndarray:
        """Rates of the state per displacement of the journal (states,), the sensor's apart."""
        per_gap = np.array([self.amplifier * self.inductance * self.bias, 0.0, self.bias])
        return per_gap[: self.states] * self.pole / self.gap

    @property
    def driven(self) -> np.ndarray:
        """Rates of the state per control current (states,)."""
        return np.array([self.amplifier * self.inductance, 0.0, 1.0])[: self.states]

    def lifting_current(self, load: float, clearance: float, angle: float) -> float:
        """Coil current (A) that lifts a load (N) from the bottom of a clearance (m), without saturation.

        angle: of the first axis, rad. The upper coils of both axes pull.
        """
        upwards = np.abs([math.sin(angle), math.cos(angle)])
        pull = self.factor * self.pole * np.sum(upwards / (self.gap + self.pole * clearance * upwards) ** 2)
        return math.sqrt(load / pull)


@dataclass(frozen=True)
class LinearLaw:
    """A channel of `surroundings.amb_controller`: x+ = A x + B m, u = C x + D m, m = -y at a tick."""

    A: np.ndarray  # (n, n)
    B: np.ndarray  # (n,)
    C: np.ndarray  # (n,)
    D: float

    @classmethod
    def of(cls, value: Values, channel: int, period: float) -> LinearLaw:
        """Channel 1 to 4 with the parameters of the model; period: s."""
        own = f"channel[{channel}]"
        kp, ki, kd = (
            value(f"gain.{name}") * value(f"{own}.{name}")
            for name in ("proportional", "integral", "derivative")
        )
        cut = value("gain.filter")
        lag = 1.0 + cut * period
        law = cls(  # states: I, D, the last m
            A=np.array([[1.0, 0.0, 0.0], [0.0, 1.0 / lag, -kd * cut / lag], [0.0, 0.0, 0.0]]),
            B=np.array([ki * period, kd * cut / lag, 1.0]),
            C=np.array([1.0, 1.0 / lag, -kd * cut / lag]),
            D=kp + ki * period + kd * cut / lag,
        )
        for n in range(1, SECTIONS + 1):
            b0, b1, b2, a1, a2 = (
                value(f"{own}.section[{n}].{name}") for name in ("b0", "b1", "b2", "a1", "a2")
            )
            if (b0, b1, b2, a1, a2) != (1.0, 0.0, 0.0, 0.0, 0.0):
                law = law.then(
                    cls(
                        A=np.array([[-a1, 1.0], [-a2, 0.0]]),
                        B=np.array([b1 - a1 * b0, b2 - a2 * b0]),
                        C=np.array([1.0, 0.0]),
                        D=b0,
                    )
                )
        return law

    def then(self, after: LinearLaw) -> LinearLaw:
        """This one with another behind it."""
        n, m = len(self.B), len(after.B)
        whole = np.zeros((n + m, n + m))
        whole[:n, :n], whole[n:, n:] = self.A, after.A
        whole[n:, :n] = np.outer(after.B, self.C)
        return LinearLaw(
            whole,
            np.concatenate((self.B, after.B * self.D)),
            np.concatenate((after.D * self.C, after.C)),
            after.D * self.D,
        )

    def response(self, z: complex) -> complex:
        """C(z), A/m."""
        return complex(self.C @ np.linalg.solve(z * np.eye(len(self.B)) - self.A, self.B) + self.D)
