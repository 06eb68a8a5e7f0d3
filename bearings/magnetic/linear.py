"""Actuator and controller for small motion about the centre, an axis at a time.

The actuator is taken at its operating point: at the centre, with the static load held, coils that the load
switches off, set points at the current limit, and saturated iron. With the flux linkage lambda0 of a coil
there, its sign +-1 and the slopes of `magnet.current_of`, for each coil that carries a current

    F = +-2 pull lambda0 lambda         i = di/dlambda lambda + di/dg dg/du u
    lambda' = w_a L0 (+-i_c - i + w_r zeta)        zeta' = +-i_c - i        s' = w_s (u - s)

where a set point at its limit does not follow i_c. u is the journal's displacement, i_c the control
current, lambda, i and zeta deviations of a coil, s the sensor's signal. The negative stiffness acts
through the amplifier's bandwidth. Where nothing is at a limit, a holding current i_h leaves k_i as it is
and multiplies k_s by 1 + (i_h/i_0)^2; beyond i_h = i_0 only one coil is left.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from ...modelkit.ports import NO_LOAD
from . import amplifier, magnet
from .amplifier import Amplifier
from .law import SECTIONS
from .magnet import Magnet

Values = Callable[[str], float]  # of a component's parameters, by name, SI


ROUNDING = 1e-9  # of a force
SIGNAL = 0  # which of an actuator's states its sensor's signal is


def _plain(kernel: Any) -> Callable[..., Any]:
    """A kernel as the Python function that it was."""
    return getattr(kernel, "py_func", kernel)


def _group(value: Values, name: str, described: type) -> SimpleNamespace:
    """A group of the model's parameters, as its kernels read it."""
    return SimpleNamespace(**{key: value(f"{name}.{key}") for key in described.__dataclass_fields__})


@dataclass(frozen=True)
class Coil:
    """A coil that carries a current, about its operating point."""

    sign: int  # of its pull along the axis
    set_point: float  # A
    follows: bool  # its set point follows the control current: it is within its limits
    flux: float  # V s
    per_flux: float  # di/dlambda, A/(V s)
    per_metre: float  # di/du with the flux linkage held, A/m
    per_linkage: float  # dF/dlambda along the axis, N/(V s)


@dataclass(frozen=True)
class LinearActuator:
    """An axis of `surroundings.amb_actuator` about its operating point.

    Its state is s (m), then the flux linkages of its coils (V s), and with w_r their zeta (A s).
    """

    coils: tuple[Coil, ...]
    bias: float  # A
    hold: float  # A, the control current at the operating point; 0 where the load cannot be held
    load: float  # N, static, along the axis
    strongest: float  # N, largest force that the limits allow at the centre
    current_limit: float  # A
    flux_limit: float  # T
    linked: float  # m2, N A: flux linkage over flux density
    factor: float  # K, N m2/A2
    inductance: float  # L0, V s/A
    gap: float  # m
    pole: float  # cos(alpha)
    amplifier: float  # w_a, rad/s
    reset: float  # w_r, rad/s
    sensor: float  # w_s, rad/s
    gain: float  # of the sensor
    voltage: float  # V

    @classmethod
    def of(cls, value: Values, axis: int) -> LinearActuator:
        """Axis 1 or 2 with the parameters of the model, and what it gives once initialised."""
        p, a = _group(value, "magnet", Magnet), _group(value, "amplifier", Amplifier)
        d, hold = SimpleNamespace(), value(f"axis[{axis}].hold")
        _plain(magnet.lay_out)(d, p, a.bias)
        fx, fy = value("journal.fx"), value("journal.fy")
        load = d.cosine * fx + d.sine * fy if axis == 1 else d.cosine * fy - d.sine * fx
        strongest = d.pull * _plain(magnet.flux_of)(a.current_limit, p.gap, p, d) ** 2  # the other coil off
        if abs(load) <= NO_LOAD:
            load = hold = 0.0
        elif abs(load) > strongest * (1.0 + ROUNDING):
            hold = 0.0
        return cls(
            coils=tuple(_coils(p, d, a, axis, hold)),
            bias=a.bias,
            hold=hold,
            load=load,
            strongest=strongest,
            current_limit=a.current_limit,
            flux_limit=p.flux_limit,
            linked=p.turns * p.area,
            factor=d.factor,
            inductance=d.inductance,
            gap=p.gap,
            pole=math.cos(p.pole_angle),
            amplifier=a.bandwidth,
            reset=a.reset,
            sensor=value("sensing.bandwidth"),
            gain=value("sensing.gain"),
            voltage=value("supply.voltage"),
        )

    @property
    def holds(self) -> bool:
        """Whether its magnets can hold the static load at the centre."""
        return abs(self.load) <= self.strongest * (1.0 + ROUNDING)

    @property
    def current_factor(self) -> float:
        """k_i, N/A."""
        return sum(c.sign * c.per_linkage / c.per_flux for c in self.coils if c.follows)

    @property
    def displacement_factor(self) -> float:
        """k_s, N/m, of settled currents; below zero."""
        return sum(c.per_linkage * c.per_metre / c.per_flux for c in self.coils)

    @property
    def slew(self) -> float:
        """Largest rate of the force, N/s."""
        return self.voltage * sum(abs(c.per_linkage) for c in self.coils)

    @property
    def states(self) -> int:
        """One of the sensor; of each coil two with an integral part of the current control, else one."""
        return 1 + len(self.coils) * (2 if self.reset > 0.0 else 1)

    @property
    def force(self) -> np.ndarray:
        """Force per state (states,)."""
        return self._of_coils([c.per_linkage for c in self.coils], [0.0 for _ in self.coils])

    @property
    def rates(self) -> np.ndarray:
        """Rates of the state per state (states, states)."""
        n, gain = len(self.coils), self.amplifier * self.inductance
        slopes = np.diag([c.per_flux for c in self.coils])
        every = np.zeros((1 + 2 * n, 1 + 2 * n))
        every[0, 0] = -self.sensor
        every[1 : 1 + n, 1 : 1 + n], every[1 + n :, 1 : 1 + n] = -gain * slopes, -slopes
        every[1 : 1 + n, 1 + n :] = gain * self.reset * np.eye(n)
        return every[: self.states, : self.states]

    @property
    def moved(self) -> np.ndarray:
        """Rates of the state per displacement of the journal (states,), the sensor's apart."""
        per_metre = np.array([-c.per_metre for c in self.coils])
        return self._of_coils(self.amplifier * self.inductance * per_metre, per_metre)

    @property
    def driven(self) -> np.ndarray:
        """Rates of the state per control current (states,)."""
        follow = np.array([c.sign if c.follows else 0.0 for c in self.coils])
        return self._of_coils(self.amplifier * self.inductance * follow, follow)

    def _of_coils(
        self, fluxes: Sequence[float] | np.ndarray, integrals: Sequence[float] | np.ndarray
    ) -> np.ndarray:
        return np.array([0.0, *fluxes, *integrals])[: self.states]

    def shortfalls(self, control: float = 0.0, fluxes: Sequence[float] = ()) -> Iterator[str]:
        """What the limits do not allow, or change, a line each.

        control: amplitude (A) of a swinging control current; fluxes: of the coils' flux linkages (V s).
        """
        if not self.holds:
            yield (
                f"its magnets give {self.strongest:.4g} N at most at the centre, and its static load is "
                f"{abs(self.load):.4g} N"
            )
        if self.bias > self.current_limit:
            yield f"its bias of {self.bias:g} A is above amplifier.current_limit = {self.current_limit:g} A"
        elif self.demand(control) > self.current_limit:
            swing = f", unbalance {control:.4g}" if len(fluxes) else ""
            yield (
                f"a coil is to carry {self.demand(control):.4g} A (bias {self.bias:.4g}, holding "
                f"{abs(self.hold):.4g}{swing} A), and amplifier.current_limit is "
                f"{self.current_limit:g} A"
            )
        if self.density(fluxes) > self.flux_limit:
            made_by = "bias, static load and unbalance" if len(fluxes) else "bias and static load"
            yield (
                f"its iron saturates: {made_by} make {self.density(fluxes):.4g} T, and "
                f"magnet.flux_limit is {self.flux_limit:g} T; k_i at rest is {self.current_factor:.4g} N/A"
            )
        if abs(self.hold) > self.bias:
            yield (
                f"its static load takes {abs(self.hold):.4g} A, more than the bias of {self.bias:g} A, and "
                f"switches one coil off; k_i is {self.current_factor:.4g} N/A"
            )

    def demand(self, control: float) -> float:
        """Largest set point (A) of a coil, before its limit; control: amplitude of its swing (A)."""
        return self.bias + abs(self.hold) + control

    def density(self, fluxes: Sequence[float] = ()) -> float:
        """Largest flux density (T); fluxes: amplitudes of the coils' flux linkages (V s)."""
        swings = fluxes if len(fluxes) else [0.0] * len(self.coils)
        return max((c.flux + s for c, s in zip(self.coils, swings, strict=True)), default=0.0) / self.linked

    def lifting_current(self, load: float, clearance: float, angle: float) -> float:
        """Coil current (A) that lifts a load (N) from the bottom of a clearance (m), without saturation.

        angle: of the first axis, rad. The upper coils of both axes pull.
        """
        upwards = np.abs([math.sin(angle), math.cos(angle)])
        pull = self.factor * self.pole * np.sum(upwards / (self.gap + self.pole * clearance * upwards) ** 2)
        return math.sqrt(load / pull)


def _coils(
    p: SimpleNamespace, d: SimpleNamespace, a: SimpleNamespace, axis: int, hold: float
) -> Iterator[Coil]:
    """Those of an axis, from 1, that carry a current with the control current `hold` (A)."""
    for side, sign in enumerate((1, -1)):
        coil = 2 * (axis - 1) + side
        current, _ = _plain(amplifier.set_point)(coil, hold, a)
        flux = _plain(magnet.flux_of)(current, p.gap, p, d)
        if flux == 0.0:
            continue
        per_flux, per_gap = magnet.current_slopes(flux, p.gap, p, d)
        ahead, behind = (_plain(magnet.gap_of)(coil, u, u, p, d) for u in (0.125 * p.gap, -0.125 * p.gap))
        yield Coil(
            sign,
            current,
            current < a.current_limit,
            flux,
            per_flux,
            per_gap * (ahead - behind) / (0.25 * p.gap),
            2.0 * sign * d.pull * flux,
        )


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
