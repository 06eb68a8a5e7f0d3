"""A detailed bearing in the augmented form of multibody dynamics, with Baumgarte's stabilisation.

The models eliminate the one constraint they have: the outer ring does not turn. Here it keeps its
rotation, and a multiplier holds it (2.18-2.28),

    [ m    C_q^T ] [ q''    ]   [ Q_a                                     ]
    [ C_q  0     ] [ lambda ] = [ Q_d - 2 alpha C' - beta^2 C             ]

with C = r sin(theta), the height by which a pin at the rim of the outer race (radius r) has left its
place, so that C_q = r cos(theta) and Q_d = r sin(theta) theta'^2. (2.28) prints lambda-dot for lambda.

A reference for checks: the whole matrix is solved at every evaluation. Journal and outer ring, the latter
with its housing on the support, are bodies beside those of the bearing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...modelkit.instance import Instance
from .. import seat
from . import ring
from .ball_bodies import ANGLE, SIZE, SPIN, VX, VY, X, Y
from .ring import BALLS


def accelerations(
    mass: np.ndarray, forces: np.ndarray, jacobian: np.ndarray, right: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(Accelerations, multipliers) of (2.23) or, with its `right`, (2.28).

    mass: (n,) masses and inertias; forces: (n,) generalised forces Q_a; jacobian: (c, n) C_q;
    right: (c,) what C_q q'' has to be.
    """
    n, c = len(mass), len(right)
    matrix = np.zeros((n + c, n + c))
    matrix[range(n), range(n)] = mass
    matrix[:n, n:] = jacobian.T
    matrix[n:, :n] = jacobian
    solution = np.linalg.solve(matrix, np.concatenate([forces, right]))
    return solution[:n], solution[n:]


@dataclass(frozen=True)
class Surroundings:
    """The bodies that the bearing is attached to. Defaults: the disk of section 4.3 and its support."""

    journal_mass: float = 1.65  # kg
    journal_inertia: float = 0.5e-3  # kg m2
    outer_mass: float = 5.02  # kg, with the housing
    outer_inertia: float = 3e-3  # kg m2, with the housing
    stiffness: float = 2.5e8  # N/m
    damping: float = 2500.0  # N s/m


class AugmentedBearing:
    """Equations of motion of a detailed bearing, its journal and its outer ring.

    State: positions and angles of all bodies, then their rates; the order of the bodies is journal, outer
    ring, inner ring, balls, cage. `alpha`, `beta` (1/s) stabilise; with `eliminated` the rotation is left
    out instead.
    """

    def __init__(
        self,
        instance: Instance,
        around: Surroundings = Surroundings(),
        alpha: float = 0.0,
        beta: float = 0.0,
        eliminated: bool = False,
    ) -> None:
        self.instance = instance
        self.around = around
        self.alpha, self.beta, self.eliminated = alpha, beta, eliminated
        m = instance.record
        self.radius = float(m["d"]["outer_radius"])
        self._positions, self._rates, inside = self._indices(int(m["p"]["balls"]["count"]))
        a = around
        outside = [(a.journal_mass, a.journal_inertia), (a.outer_mass, a.outer_inertia)]
        self.mass = np.array([x for body, turn in (*outside, *inside) for x in (body, body, turn)])
        self.coordinates = len(self.mass)

    def _indices(self, count: int) -> tuple[np.ndarray, np.ndarray, list[tuple[float, float]]]:
        """Where coordinates and rates of the bodies inside lie in the model's state; mass and inertia."""
        m = self.instance.record
        positions, rates = [[ring.RX, ring.RY, ring.RANGLE]], [[ring.RVX, ring.RVY, ring.RW]]
        masses = [(float(m["p"]["ring"]["mass"]), float(m["p"]["ring"]["inertia"]))]
        for b in range(count):
            places = [BALLS + k * count + b for k in range(SIZE)]
            positions.append([places[X], places[Y], places[ANGLE]])
            rates.append([places[VX], places[VY], places[SPIN]])
            masses.append((float(m["d"]["mass"]), float(m["d"]["inertia"])))
        if "cage" in m["p"].dtype.names:
            places = [BALLS + SIZE * count + k for k in range(SIZE)]
            positions.append([places[X], places[Y], places[ANGLE]])
            rates.append([places[VX], places[VY], places[SPIN]])
            masses.append((float(m["p"]["cage"]["mass"]), float(m["d"]["cage_inertia"])))
        return np.concatenate(positions), np.concatenate(rates), masses

    def initial(self, outer_angle: float = 0.0, outer_rate: float = 0.0) -> np.ndarray:
        """The instance's present state; the outer ring turned by a violation (rad, rad/s)."""
        q = self.instance.record["q"]
        outside = [q[seat.JX], q[seat.JY], 0.0, q[seat.HX], q[seat.HY], outer_angle]
        speeds = [q[seat.JVX], q[seat.JVY], q[seat.JW], q[seat.HVX], q[seat.HVY], outer_rate]
        return np.concatenate([outside, q[self._positions], speeds, q[self._rates]])

    def violation(self, state: np.ndarray) -> tuple[float, float]:
        """(C in m, C' in m/s)."""
        angle, rate = state[5], state[self.coordinates + 5]
        return float(self.radius * np.sin(angle)), float(self.radius * np.cos(angle) * rate)

    def rhs(self, t: float, state: np.ndarray) -> np.ndarray:
        """Rates of the state."""
        n = self.coordinates
        places, rates = state[:n], state[n:]
        forces = self._forces(places, rates)
        if self.eliminated:
            free = forces / self.mass
            free[5] = 0.0
            return np.concatenate([rates, free])
        jacobian = np.zeros((1, n))
        jacobian[0, 5] = self.radius * np.cos(places[5])
        position, rate = self.violation(state)
        known = self.radius * np.sin(places[5]) * rates[5] ** 2
        right = np.array([known - 2.0 * self.alpha * rate - self.beta**2 * position])
        return np.concatenate([rates, accelerations(self.mass, forces, jacobian, right)[0]])

    def _forces(self, places: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Generalised applied forces Q_a (n,) of all bodies, by the model's own kernels."""
        m, a = self.instance.record, self.around
        q, dq = np.zeros(len(m["q"])), np.zeros(len(m["q"]))
        q[self._positions], q[self._rates] = places[6:], rates[6:]
        for part, i in (("journal", 0), ("housing", 3)):
            motion = m["u"][part]
            motion["x"], motion["y"], motion["vx"], motion["vy"] = *places[i : i + 2], *rates[i : i + 2]
        m["u"]["journal"]["omega"] = rates[2]
        m["s"]["outer_spin"] = rates[5]
        assert self.instance.model.instant is not None
        self.instance.model.instant(0.0, q, dq, self.instance.words)
        journal, housing = m["o"]["journal"], m["o"]["housing"]
        support = -a.stiffness * places[3:5] - a.damping * rates[3:5]
        outside = [
            journal["fx"],
            journal["fy"],
            journal["mz"],
            housing["fx"] + support[0],
            housing["fy"] + support[1],
            float(m["s"]["outer_moment"]),
        ]
        return np.concatenate([outside, self.mass[6:] * dq[self._rates]])
