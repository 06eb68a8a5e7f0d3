"""Integrators that were tried inside the detailed bearings and not kept; used by `detailed_speed.py`.

Each is a kernel tried(m, rows, span, step, tolerance) -> evaluations that advances a bearing's memory m by
`span` (s); journal and housing are then the copies the bearing carries.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

from touchdown.bearings.contact.friction import slope
from touchdown.bearings.rolling.ball_bodies import SPIN, drift, fastest_ball
from touchdown.bearings.rolling.micro_step import RESOLUTION, forecast_kick
from touchdown.bearings.rolling.ring import BALLS, part
from touchdown.bearings.seat import PARTS
from touchdown.modelkit.integrators import dopri, rosenbrock, verlet
from touchdown.modelkit.kernel.linked import KernelDispatcher


def whole(function: Callable) -> Any:
    """A kernel that is compiled as the models' are, and not kept."""
    return KernelDispatcher(function)


def make(module: ModuleType) -> dict[str, Callable]:
    """All tried integrators for a detailed model's module."""
    return {
        "leapfrog, friction as it stands": _plain_leapfrog(module),
        "Bogacki-Shampine 3(2), adaptive": _bogacki_shampine(module),
        "Dormand-Prince 5(4), adaptive": _dormand_prince(module),
        "order 3, ball spin implicit, adaptive": _implicit_spin(module),
    }


def _plain_leapfrog(module: ModuleType) -> Callable:
    """Velocity Verlet with friction and damping as they are before the kick, which may overshoot."""
    rhs, observe = module.rhs, module.observe

    @whole
    def unaware(trial, dq, h, kick, m):
        forecast_kick(trial, dq, h, 0.0, m)

    @whole
    def unsettled(q, dq, kick, m):
        pass

    @whole
    def tried(m, rows, span, step, tolerance):
        m.s.kick = m.s.drift = 0.0
        rhs(0.0, m.q, rows[0], m)
        steps, at = verlet.Steps(step, RESOLUTION), m.q
        found = verlet.integrate(
            rhs, drift, unaware, fastest_ball, unsettled, observe, m, at, m.n, rows, span, steps, 0.0
        )
        return 1 + found[1]

    return tried


def _dormand_prince(module: ModuleType) -> Callable:
    rhs, observe = module.rhs, module.observe

    @whole
    def tried(m, rows, span, step, tolerance):
        m.s.kick = 0.0
        return dopri.integrate(rhs, observe, m, m.q, PARTS, m.n, m.weight, rows, span, 1e-7, tolerance)[2]

    return tried


def _bogacki_shampine(module: ModuleType) -> Callable:
    rhs, observe = module.rhs, module.observe

    @whole
    def tried(m, rows, span, step, tolerance):
        m.s.kick = 0.0
        q, n, weight = m.q, m.n, m.weight
        a, b, c, d, w = rows[0], rows[1], rows[2], rows[3], rows[4]
        t, h, evaluations = 0.0, 1e-7, 1
        rhs(t, q, a, m)
        while t < span:
            last = t + h >= span
            k = span - t if last else h
            for i in range(n):
                w[i] = q[i] + 0.5 * k * a[i]
            rhs(t + 0.5 * k, w, b, m)
            for i in range(n):
                w[i] = q[i] + 0.75 * k * b[i]
            rhs(t + 0.75 * k, w, c, m)
            for i in range(n):
                w[i] = q[i] + k * (2 / 9 * a[i] + 1 / 3 * b[i] + 4 / 9 * c[i])
            rhs(t + k, w, d, m)
            evaluations += 3
            error = 0.0
            for i in range(n):
                e = k * abs(-5 / 72 * a[i] + 1 / 12 * b[i] + 1 / 9 * c[i] - 1 / 8 * d[i]) * weight[i]
                error = max(error, e)
            error /= tolerance
            if error <= 1.0:
                t = span if last else t + k
                for i in range(n):
                    q[i] = w[i]
                    a[i] = d[i]
                observe(t, q, m)
            h = k * min(4.0, max(0.2, 0.9 / max(error, 1e-6) ** (1.0 / 3.0)))
        return evaluations

    return tried


def _implicit_spin(module: ModuleType) -> Callable:
    """The linearly implicit method of the simplified cageless bearing, for the spin of each ball alone."""
    rhs, observe = module.rhs, module.observe

    @whole
    def linearise(q, stiff, m):
        d, s = m.d, m.s
        at = part(stiff, SPIN, m)
        for b in range(m.p.balls.count):
            steep = slope(0.0, d.race_friction)
            held = steep * (s.inner.normal[b] + s.outer.normal[b])
            at[b] = held * d.ball_radius**2 / d.inertia

    @whole
    def solve(stiff, shift, right, m):
        first = BALLS + SPIN * m.p.balls.count
        for i in range(m.n):
            if first <= i < first + m.p.balls.count:
                right[i] /= shift + stiff[i]
            else:
                right[i] /= shift

    @whole
    def tried(m, rows, span, step, tolerance):
        m.s.kick = 0.0
        return rosenbrock.integrate(
            rhs, linearise, solve, observe, m, m.q, PARTS, m.n, m.weight, rows, span, 1e-7, tolerance
        )[2]

    return tried
