"""Modes of a spinning rotor in bearings: linear ones that damp, lag, and may look elsewhere than they act.

In the coordinates of `Basis`, p = x + i y, and with the modal damping that the rotor's model has,

    p'' + (2 zeta omega - i speed G) p' + omega^2 p = shape^T f

where each bearing gives the journal a force f, and what it stands on the opposite one. With u the motion
it senses, less that of what it stands on,

    lag f' + f = -(stiffness u + damping u')

which without a lag is a spring and a damper, and with one a controller behind an amplifier of the
bandwidth 1 / lag. What it stands on is the ground, or a mass on springs and dampers.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...modelkit.model import ModelError
from ..beams.shaft import Support
from .modes import Basis

MIN_DAMPING_RATIO = 1e-6  # damping ratio (either sign) below which rounding may be all there is
# Of the largest root that swings: what swings less does not, and what is less is next to zero
MIN_ROOT_RATIO = 1e-7


@dataclass(frozen=True)
class Foundation:
    """The support of bearings: a mass on equal springs and dampers in both directions."""

    mass: float  # kg
    stiffness: float  # N/m
    damping: float = 0.0  # N s/m
    name: str = ""  # bearings stand on one mass where its name is the same; "": each on its own


@dataclass(frozen=True)
class LinearBearing:
    """A bearing for small motion. Rows are the force's directions (x, y), columns the motion's.

    Raises ModelError for matrices that are not two by two.
    """

    node: int  # where its force acts, from 1
    stiffness: np.ndarray  # (2, 2), N/m
    damping: np.ndarray  # (2, 2), N s/m
    lag: float = 0.0  # s, of the force behind the motion
    sensed: int | None = None  # the node whose motion it answers; None: its own
    foundation: Foundation | None = None  # None: the ground

    def __post_init__(self) -> None:
        for name in ("stiffness", "damping"):
            matrix = np.asarray(getattr(self, name), dtype=float)
            if matrix.shape != (2, 2):
                raise ModelError(f"{name} of a bearing has the shape {matrix.shape}; it must be (2, 2)")
            object.__setattr__(self, name, matrix)

    @classmethod
    def of(cls, support: Support) -> LinearBearing:
        """Springs and dampers to the ground."""
        k, c = support.stiffness, support.damping
        k_y = k if support.stiffness_y is None else support.stiffness_y
        c_y = c if support.damping_y is None else support.damping_y
        return cls(support.node, np.diag([k, k_y]), np.diag([c, c_y]))

    def dynamic_stiffness(self, omega: float) -> np.ndarray:
        """Force against small motion at `omega` (rad/s) over that motion (2, 2), complex, N/m."""
        return dynamic_stiffness(self.stiffness, self.damping, self.lag, omega)


def dynamic_stiffness(
    stiffness: np.ndarray, damping: np.ndarray, lag: float, omega: float | np.ndarray
) -> np.ndarray:
    """Of springs and dampers (N/m, N s/m) behind a lag (s) at `omega` (rad/s), complex, N/m."""
    return (stiffness + 1j * omega * damping) / (1.0 + 1j * omega * lag)


def static_stiffness(bearings: Iterable[LinearBearing]) -> np.ndarray:
    """Stiffness (2, 2) of bearings at one node with what they stand on in series, N/m.

    As if each looked where it acts. Those on one foundation add up before it gives way.
    """
    whole = np.zeros((2, 2))
    for on_it in _by_foundation(bearings):
        k, foundation = sum((b.stiffness for b in on_it), np.zeros((2, 2))), on_it[0].foundation
        if foundation is not None:  # force k (u - v) = s v gives v = (k + s)^-1 k u
            k = foundation.stiffness * np.linalg.pinv(k + foundation.stiffness * np.eye(2)) @ k
        whole += k
    return whole


def _by_foundation(bearings: Iterable[LinearBearing]) -> list[list[LinearBearing]]:
    """Bearings that stand on one mass together. Raises ModelError where one name means two masses."""
    groups: list[list[LinearBearing]] = []
    named: dict[str, list[LinearBearing]] = {}
    for b in bearings:
        name = "" if b.foundation is None else b.foundation.name
        if name in named:
            if b.foundation != named[name][0].foundation:
                raise ModelError(
                    f"there are two foundations called {name}; they must have names of their own"
                )
            named[name].append(b)
        else:
            groups.append([b])
            if name:
                named[name] = groups[-1]
    return groups


@dataclass(frozen=True)
class DampedModes:
    """Modes of a spinning rotor, by their size: one of each conjugate pair, M in all."""

    roots: np.ndarray  # (M,), complex, 1/s: damping and whirl speed, imaginary part positive
    sense: np.ndarray  # (M,), 1 circular whirl counter-clockwise, -1 circular clockwise, 0 in a plane
    aperiodic: (
        np.ndarray
    )  # (A,), real parts of roots that do not swing, or swing less than `MIN_ROOT_RATIO`, 1/s
    free: int  # roots next to zero: of what nothing holds, which may drift
    vectors: np.ndarray  # (coordinates, M), complex, by the root of their masses, of unit length

    @property
    def frequencies(self) -> np.ndarray:
        """Damped whirl frequencies (M,), Hz."""
        return np.imag(self.roots) / (2.0 * np.pi)

    @property
    def damping_ratios(self) -> np.ndarray:
        """Share of critical damping (M,); below 0 a mode grows."""
        return damping_ratios(self.roots)

    @property
    def stable(self) -> bool:
        """Whether nothing grows, by more than what rounding makes of no damping at all."""
        return not self.pushed_away and bool(np.all(self.damping_ratios > -MIN_DAMPING_RATIO))

    @property
    def pushed_away(self) -> bool:
        """Whether something grows without a swing."""
        return bool(np.any(self.aperiodic > 0.0))


def damping_ratios(roots: np.ndarray) -> np.ndarray:
    """Share of critical damping of complex roots (1/s), of any shape; 0 where a root is."""
    size = np.abs(roots)
    return np.divide(-np.real(roots), size, out=np.zeros_like(size), where=size > 0.0)


def log_decrements(roots: np.ndarray) -> np.ndarray:
    """Logarithmic decrements of complex roots (1/s), of any shape: ln of a swing over the next one."""
    return -2.0 * np.pi * np.real(roots) / np.imag(roots)


class HeldRotor:
    """A rotor in bearings, as equations of the first order.

    The state is x (n), y (n) and the foundations' (x, y), their rates, and the forces that lag (x, y).
    """

    def __init__(self, basis: Basis, bearings: Sequence[LinearBearing], damping_ratio: float = 0.0) -> None:
        """damping_ratio: of the elastic modes, as in the rotor's model."""
        n = len(basis.omega)
        groups = _by_foundation(bearings)
        standing = [on_it for on_it in groups if on_it[0].foundation is not None]
        self.n, self.bearings, self.basis = n, bearings, basis
        self.places = 2 * n + 2 * len(standing)
        lagging = [b for on_it in groups for b in on_it if b.lag > 0.0]
        self.states = 2 * self.places + 2 * len(lagging)
        self.K = np.zeros((self.places, self.places))
        self.C = np.zeros((self.places, self.places))
        self.mass = np.ones(self.places)
        for plane in (slice(0, n), slice(n, 2 * n)):
            self.K[plane, plane] = np.diag(basis.omega**2)
            self.C[plane, plane] = np.diag(2.0 * damping_ratio * basis.omega)
        self.forced = np.zeros((self.places, 2 * len(lagging)))  # what the lagging forces push
        self.asked = np.zeros((2 * len(lagging), 2 * self.places))  # what they follow
        self.lag = np.repeat([b.lag for b in lagging], 2)
        seat, force = 2 * n, 0
        for on_it in groups:
            foundation = on_it[0].foundation
            if foundation is not None:
                self._stand(foundation, seat)
            for b in on_it:
                self._add(b, seat, force)
                force += 2 if b.lag > 0.0 else 0
            seat += 2 if foundation is not None else 0

    def _stand(self, foundation: Foundation, seat: int) -> None:
        """A mass on its springs and dampers, at the place `seat`."""
        rows = slice(seat, seat + 2)
        self.mass[rows] = foundation.mass
        self.K[rows, rows] = foundation.stiffness * np.eye(2)
        self.C[rows, rows] = foundation.damping * np.eye(2)

    def _add(self, b: LinearBearing, seat: int, force: int) -> None:
        """Force of a bearing: on its node, and back on what it stands on, at the place `seat`."""
        acts = self._motion(b.node, b, seat)
        sees = self._motion(b.node if b.sensed is None else b.sensed, b, seat)
        if b.lag > 0.0:
            rows = slice(force, force + 2)
            self.forced[:, rows] = acts.T
            self.asked[rows, : self.places] = -b.stiffness @ sees
            self.asked[rows, self.places :] = -b.damping @ sees
        else:
            self.K += acts.T @ b.stiffness @ sees
            self.C += acts.T @ b.damping @ sees

    def _motion(self, node: int, b: LinearBearing, seat: int) -> np.ndarray:
        """Motion (x, y) of a node against what the bearing stands on, per place (2, places)."""
        motion = np.zeros((2, self.places))
        motion[0, : self.n] = motion[1, self.n : 2 * self.n] = self.basis.deflections([node])[0]
        if b.foundation is not None:
            motion[:, seat : seat + 2] = -np.eye(2)
        return motion

    def damped_modes(self, speed: float) -> DampedModes:
        """Modes at spin `speed` (rad/s, counter-clockwise), by their size."""
        n, places = self.n, self.places
        C = self.C.copy()
        C[:n, n : 2 * n] += speed * self.basis.gyroscopic
        C[n : 2 * n, :n] -= speed * self.basis.gyroscopic
        by_mass = 1.0 / self.mass[:, None]
        A = np.zeros((self.states, self.states))
        A[:places, places : 2 * places] = np.eye(places)
        A[places : 2 * places, :places] = -by_mass * self.K
        A[places : 2 * places, places : 2 * places] = -by_mass * C
        A[places : 2 * places, 2 * places :] = by_mass * self.forced
        by_lag = 1.0 / self.lag[:, None] if len(self.lag) else np.zeros((0, 1))
        A[2 * places :, : 2 * places] = by_lag * self.asked
        A[2 * places :, 2 * places :] = -by_lag * np.eye(len(self.lag))
        return self._sorted(*np.linalg.eig(A))

    def _sorted(self, roots: np.ndarray, vectors: np.ndarray) -> DampedModes:
        """Of each conjugate pair one, by size; what a rotor that nothing holds leaves is not a mode."""
        size = np.abs(roots)
        fast = np.imag(roots) > MIN_ROOT_RATIO * np.max(size)
        small = MIN_ROOT_RATIO * np.max(
            size[fast] if fast.any() else size
        )  # a short lag's root counts for no mode
        least = np.maximum(small, MIN_ROOT_RATIO * size)
        swinging = np.imag(roots) > least
        aperiodic = np.sort(np.real(roots[(np.abs(np.imag(roots)) <= least) & (size > small)]))
        free = int(np.count_nonzero(size <= small))
        order = np.flatnonzero(swinging)[np.argsort(np.abs(roots[swinging]))]
        moving = vectors[self.places : 2 * self.places, order]
        x, y = moving[: self.n], moving[self.n : 2 * self.n]
        turning = -2.0 * np.imag(np.sum(np.conj(x) * y, axis=0))
        size = np.sum(np.abs(x) ** 2 + np.abs(y) ** 2, axis=0)
        sense = np.divide(turning, size, out=np.zeros_like(turning), where=size > 0.0)
        moving = np.sqrt(self.mass)[:, None] * moving
        return DampedModes(roots[order], sense, aperiodic, free, moving / np.linalg.norm(moving, axis=0))
