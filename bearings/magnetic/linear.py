"""Actuator and controller for small motion about the centre, an axis at a time.

The actuator is taken at its operating point: at the centre, with the static load held, coils that the load
switches off, set points at the current limit, and saturated iron. With the flux linkage lambda0 of a coil
there, its sign +-1 and the slopes of `magnet.current_of`, for each coil that carries a current

    F = +-2 pull lambda0 lambda         i = di/dlambda lambda + di/dg dg/du u
    lambda' = w_a L0 (+-i_c - i + w_r zeta)        zeta' = +-i_c - i        s' = w_s (u - s)

where a set point at its limit does not follow i_c. u is the journal's displacement, i_c the control
current, lambda, i and zeta deviations of a coil, s the sensor's signal. The negative stiffness acts
through the amplifier's bandwidth. Where nothing is at a limit, a holding current i_h leaves k_i unchanged
and multiplies k_s by 1 + (i_h/i_0)^2; beyond i_h = i_0 only one coil is left.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from ...modelkit.kernel import interpret
from ...modelkit.ports import NO_LOAD
from ...modelkit.variables import as_record, flatten, from_values, layout
from . import amplifier, magnet
from .amplifier import Amplifier
from .law import Channel, ChannelMemory, FilterSection, Gain, update
from .magnet import EDDIES, EDDY_DIRECT, EDDY_FACTORS, EDDY_RATES, Magnet
from .sensing import Sensor

Values = Callable[[str], float]  # of a component's parameters, by name, SI


ROUNDING = 1e-9  # of a force
SIGNAL = 0  # which of an actuator's states its sensor's signal is


def _plain(kernel: Any) -> Callable[..., Any]:
    """A kernel as the Python function that it was."""
    return getattr(kernel, "py_func", kernel)


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
    """An axis of `amb_actuator` about its operating point.

    Its state is s (m), then the flux linkages of its coils (V s), with w_r their zeta (A s), and with eddy
    currents the linkages of their windings (V s).
    """

    magnet: Magnet
    amplifier: Amplifier
    sensing: Sensor
    circuit: Any  # `magnet.Circuit`
    coils: tuple[Coil, ...]
    hold: float  # A, the control current at the operating point; 0 where the load cannot be held
    load: float  # N, static, along the axis
    strongest: float  # N, largest force that the limits allow at the centre
    voltage: float  # V

    @classmethod
    def of(cls, value: Values, axis: int) -> LinearActuator:
        """Axis 1 or 2 with the parameters of the model, and what it gives once initialised."""
        p, a = from_values(Magnet, value, "magnet."), from_values(Amplifier, value, "amplifier.")
        d, hold = SimpleNamespace(), value(f"axis[{axis}].hold")
        _plain(magnet.lay_out_circuit)(d, p, a.bias, math.cos(p.pole_angle))
        d.cosine, d.sine = math.cos(p.angle), math.sin(p.angle)
        fx, fy = value("journal.fx"), value("journal.fy")
        load = d.cosine * fx + d.sine * fy if axis == 1 else d.cosine * fy - d.sine * fx
        strongest = d.pull * _plain(magnet.flux_of)(a.current_limit, p.gap, p, d) ** 2  # the other coil off
        if abs(load) <= NO_LOAD:
            load = hold = 0.0
        elif abs(load) > strongest * (1.0 + ROUNDING):
            hold = 0.0
        coils, sensor = tuple(_coils(p, d, a, axis, hold)), from_values(Sensor, value, "sensing.")
        return cls(p, a, sensor, d, coils, hold, load, strongest, value("link"))

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
        """One of the sensor; of each coil one, one with an integral part, and those of eddy currents."""
        return self._eddies + (EDDIES * len(self.coils) if self.circuit.eddy > 0.0 else 0)

    @property
    def force(self) -> np.ndarray:
        """Force per state (states,)."""
        found = [0.0, *(c.per_linkage for c in self.coils)]
        return np.array(found + [0.0] * (self.states - len(found)))

    @property
    def rates(self) -> np.ndarray:
        """Rates of the state per state (states, states)."""
        return self._rates[:, :-2]

    @property
    def moved(self) -> np.ndarray:
        """Rates of the state per displacement of the journal (states,), the sensor's apart."""
        return self._rates[:, -2]

    @property
    def driven(self) -> np.ndarray:
        """Rates of the state per control current (states,)."""
        return self._rates[:, -1]

    def electrical(self, state: np.ndarray, u: complex, control: complex) -> tuple[np.ndarray, np.ndarray]:
        """Amplitudes of the coils' currents (A) and voltages (V).

        By those of the state (states,), the journal's displacement u (m) and the control current (A).
        """
        by = np.append(state, [u, control])
        currents = self._currents @ by
        return currents, self.amplifier.resistance * currents + self._rates[1 : 1 + len(self.coils)] @ by

    @property
    def _eddies(self) -> int:
        """Which of the states is the first of the eddy currents, those of a coil one after another."""
        return 1 + len(self.coils) * (2 if self.amplifier.reset > 0.0 else 1)

    @property
    def _wanted(self) -> np.ndarray:
        """What currents follow, as `_currents`: set points, and errors' integrals times w_r."""
        n, found = len(self.coils), np.zeros((len(self.coils), self.states + 2))
        found[:, -1] = [c.sign if c.follows else 0.0 for c in self.coils]
        if self.amplifier.reset > 0.0:
            found[:, 1 + n : 1 + 2 * n] = self.amplifier.reset * np.eye(n)
        return found

    @property
    def _currents(self) -> np.ndarray:
        """Currents (A) of the coils per state, displacement and control current (coils, states + 2)."""
        n, eddy = len(self.coils), self.circuit.eddy
        held, direct = np.zeros((n, self.states + 2)), self._gain * eddy * EDDY_DIRECT
        held[:, 1 : 1 + n] = np.diag([c.per_flux + eddy * sum(EDDY_FACTORS) for c in self.coils])
        held[:, -2] = [c.per_metre for c in self.coils]
        if eddy > 0.0:
            held[:, self._eddies : -2] = np.kron(np.eye(n), -eddy * EDDY_FACTORS)
        return (held + direct * self._wanted) / (1.0 + direct)

    @property
    def _rates(self) -> np.ndarray:
        """Rates of the state per state, displacement and control current (states, states + 2)."""
        n, first, found = len(self.coils), self._eddies, np.zeros((self.states, self.states + 2))
        found[0, 0] = -self.sensing.bandwidth
        found[1 : 1 + n] = self._gain * (self._wanted - self._currents)
        if self.amplifier.reset > 0.0:
            found[1 + n : 1 + 2 * n] = -self._currents
            found[1 + n : 1 + 2 * n, -1] += self._wanted[:, -1]
        if self.circuit.eddy > 0.0:
            found[first:, 1 : 1 + n] = np.kron(np.eye(n), EDDY_RATES[:, None])
            found[first:, first:-2] = -np.diag(np.tile(EDDY_RATES, n))
        return found

    @property
    def _gain(self) -> float:
        """w_a L0, V/A."""
        return self.amplifier.bandwidth * self.circuit.inductance

    def shortfalls(self, control: float = 0.0, fluxes: Sequence[float] = ()) -> Iterator[str]:
        """What the limits do not allow, or change, a line each.

        control: amplitude (A) of a swinging control current; fluxes: of the coils' flux linkages (V s).
        """
        if not self.holds:
            yield (
                f"its magnets give {self.strongest:.4g} N at most at the centre, and its static load is "
                f"{abs(self.load):.4g} N"
            )
        bias, limit, most = self.amplifier.bias, self.amplifier.current_limit, self.magnet.flux_limit
        if bias > limit:
            yield f"its bias of {bias:g} A is above amplifier.current_limit = {limit:g} A"
        elif self.demand(control) > limit:
            swing = f", unbalance {control:.4g}" if len(fluxes) else ""
            yield (
                f"a coil is to carry {self.demand(control):.4g} A (bias {bias:.4g}, holding "
                f"{abs(self.hold):.4g}{swing} A), and amplifier.current_limit is {limit:g} A"
            )
        if self.density(fluxes) > most:
            made_by = "bias, static load and unbalance" if len(fluxes) else "bias and static load"
            yield (
                f"its iron saturates: {made_by} make {self.density(fluxes):.4g} T, and "
                f"magnet.flux_limit is {most:g} T; k_i at rest is {self.current_factor:.4g} N/A"
            )
        if abs(self.hold) > bias:
            yield (
                f"its static load takes {abs(self.hold):.4g} A, more than the bias of {bias:g} A, and "
                f"switches one coil off; k_i is {self.current_factor:.4g} N/A"
            )

    def demand(self, control: float) -> float:
        """Largest set point (A) of a coil, before its limit; control: amplitude of its swing (A)."""
        return self.amplifier.bias + abs(self.hold) + control

    @property
    def resting_voltage(self) -> float:
        """Of the coil that carries most at the operating point (V)."""
        return self.amplifier.resistance * (self.amplifier.bias + abs(self.hold))

    def density(self, fluxes: Sequence[float] = ()) -> float:
        """Largest flux density (T); fluxes: amplitudes of the coils' flux linkages (V s)."""
        swings = fluxes if len(fluxes) else [0.0] * len(self.coils)
        flux = max((c.flux + s for c, s in zip(self.coils, swings, strict=True)), default=0.0)
        return flux / (self.magnet.turns * self.magnet.area)

    def lifting_current(self, load: float, clearance: float, angle: float) -> float:
        """Coil current (A) that lifts a load (N) from the bottom of a clearance (m), without saturation.

        angle: of the first axis, rad. The upper coils of both axes pull.
        """
        upwards = np.abs([math.sin(angle), math.cos(angle)])
        d, gap = self.circuit, self.magnet.gap
        pull = d.factor * d.pole * np.sum(upwards / (gap + d.pole * clearance * upwards) ** 2)
        return math.sqrt(load / pull)


def _coils(p: Magnet, d: SimpleNamespace, a: Amplifier, axis: int, hold: float) -> Iterator[Coil]:
    """Those of an axis, from 1, that carry a current with the control current `hold` (A)."""
    for side, sign in enumerate((1, -1)):
        coil = 2 * (axis - 1) + side
        current, _ = _plain(amplifier.set_point)(coil, hold, a)
        flux = _plain(magnet.flux_of)(current, p.gap, p, d)
        if flux == 0.0:
            continue
        per_flux, per_gap = magnet.current_slopes(flux, p.gap, p, d)
        ahead, behind = (_plain(magnet.gap_of)(coil, (u, u), p, d) for u in (0.125 * p.gap, -0.125 * p.gap))
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
    """A channel of `amb_controller`: x+ = A x + B m, u = C x + D m, m = -y at a tick."""

    A: np.ndarray  # (n, n)
    B: np.ndarray  # (n,)
    C: np.ndarray  # (n,)
    D: float

    @classmethod
    def of(cls, value: Values, channel: int, period: float) -> LinearLaw:
        """Channel 1 to 4 with the parameters of the model; period: s.

        As `law.update` answers a state of one and all others of zero, without a limit.
        """
        terms = from_values(Channel, value, f"channel[{channel}].")
        gain = from_values(Gain, value, "gain.")
        memory = np.zeros(1, layout(ChannelMemory))
        words, names = memory.view("f8"), [variable.name for variable in flatten(ChannelMemory())]
        used = [f"section[{n}]." for n, one in enumerate(terms.section, 1) if one != FilterSection()]
        states = [
            i for i, name in enumerate(names) if name.startswith(("integral", "deriv", "last", *used))
        ]
        position, output = names.index("position"), names.index("output")
        columns = list[np.ndarray]()
        for place in (*states, position):
            words[:] = 0.0
            words[place] = -1.0 if place == position else 1.0
            interpret(update, memory[0], 0.0, period, math.inf, as_record(gain), as_record(terms))
            columns.append(words[[*states, output]])
        whole = np.array(columns).T
        return cls(whole[:-1, :-1], whole[:-1, -1], whole[-1, :-1], float(whole[-1, -1]))
