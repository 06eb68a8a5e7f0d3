"""A rigid rotor on magnets in a plain bore as one system, with a controller at exact ticks.

Written apart from the co-simulated models: equations of `bearings.magnetic` and `bearings.bushing` in one
state vector, integrated between ticks and events by scipy's DOP853 at a tight tolerance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

from touchdown.master.scene.file import load_scene
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene

MU0 = 4e-7 * math.pi
PERIOD = 1e-4  # s
MASS, INERTIA, SPEED, GRAVITY = 1.65, 0.5e-3, 9000.0 * math.pi / 30.0, 9.81
GAP, AREA, TURNS, POLE, BIAS, MOST = 0.6e-3, 1e-4, 200.0, math.pi / 8, 2.0, 6.0
SATURATED, IRON, RESISTANCE, VOLTAGE = 1.2, 0.1, 0.5, 100.0
AMPLIFIER, LOW_PASS, RANGE = 4000.0 * math.pi, 1e4 * math.pi, 0.5e-3
KP, KI, KD, FILTER, LIMIT, RAMP = 9.7e3, 4e4, 15.5, 6000.0, 4.0, 0.02
CLEARANCE, RADIUS, STIFFNESS, DAMPING, FRICTION, STEEPNESS = 0.3e-3, 9.7e-3, 2.4e9, 1e7, 0.18, 100.0
K = MU0 * TURNS**2 * AREA / 4
L0 = 2 * K / GAP
PULL = math.cos(POLE) / (4 * K)  # N/(V s)^2
K_I = 4 * K * BIAS / GAP**2 * math.cos(POLE)  # N/A
K_S = -4 * K * BIAS**2 / GAP**3 * math.cos(POLE) ** 2  # N/m
AXIS = 1j**0.5  # unit vector of the first axis: 45 deg


def pull(i: complex, u: complex, bias: float = BIAS) -> complex:
    """Force (N) of two opposite magnets, currents bias +- i (A), none below 0, the journal u (m) off."""
    force = 0.0 + 0.0j
    for sign in (1, -1):
        carried = complex(bias + sign * i)
        if carried.real > 0.0:
            force += sign * K * math.cos(POLE) * (carried / (GAP - sign * u * math.cos(POLE))) ** 2
    return force


@cache
def operating_point(force: float, bias: float = BIAS) -> tuple[float, float, float]:
    """Control current (A) that holds a force (N) at the centre, and k_i (N/A) and k_s (N/m) there.

    k_i and -k_s are slopes of `pull`, by complex steps, which leave no error.
    """
    step = 1e-30
    held: Any = brentq(lambda i: pull(i, 0.0, bias).real - force, 0.0, 10.0, xtol=1e-15)
    hold = float(held)
    return hold, pull(hold + step * 1j, 0.0, bias).imag / step, -pull(hold, step * 1j, bias).imag / step


@cache
def from_sample_to_sample(
    period: float,
    amplifier: float = AMPLIFIER,
    bias: float = BIAS,
    mass: float = MASS,
    gravity: float = GRAVITY,
) -> np.ndarray:
    """Of the disk's axis: u, u', the force, the signal, and the held set point (5, 5).

    The force lags behind k_i i - k_s u by the amplifier, k_i and k_s those of the force law where it holds
    the weight.
    """
    _, k_i, k_s = operating_point(mass * gravity / math.sqrt(2), bias)
    whole = np.zeros((5, 5))
    whole[0, 1], whole[1, 2] = 1, 1 / mass
    whole[2, [0, 2, 4]] = -amplifier * k_s, -amplifier, amplifier * k_i
    whole[3, [0, 3]] = LOW_PASS, -LOW_PASS
    return expm(whole * period)


@dataclass
class Loop:
    """A drop of the disk: switched off and on at times (s), with an unbalance (m)."""

    eccentricity: float = 0.0
    off: float = math.inf
    on: float = math.inf
    failed: tuple[float, int] = (math.inf, 0)  # s, coil
    link_off: float = math.inf  # s
    decay: float = 0.01  # s

    def scene(self, duration: float, macro_step: float, **run: object) -> Scene:
        """The same of components, in a bore fixed in space."""
        events: dict[str, object] = {}
        for number, (time, kind) in enumerate(((self.off, "off"), (self.on, "on")), 1):
            if math.isfinite(time):
                events |= {f"event[{number}].time": time, f"event[{number}].kind": kind}
        faults: dict[str, object] = {"supply.decay": self.decay}
        if math.isfinite(self.failed[0]):
            faults |= {"event[1].time": self.failed[0], "event[1].kind": "coil_off"}
            faults |= {"event[1].coil": self.failed[1] + 1}
        if math.isfinite(self.link_off):
            faults |= {"event[2].time": self.link_off, "event[2].kind": "link_off"}
        rotor = {"speed": SPEED, "eccentricity": self.eccentricity}
        bore = {"friction.kind": 0, "friction.dynamic": FRICTION}
        return Scene(
            "loop",
            "loop",
            {
                "amb": ComponentSpec("amb_actuator", faults),
                "controller": ComponentSpec("amb_controller", events),
                "rotor": ComponentSpec("rigid_rotor", rotor),
                "bearing": ComponentSpec("bushing", bore),
            },
            attach=(("amb.journal", "rotor.amb"), ("bearing.journal", "rotor.A")),
            control=(("controller", "amb"),),
            run=with_changes(RunSpec(), {"duration": duration, "macro_step": macro_step, **run}),
        )


@dataclass
class Solution:
    """Positions x + i y (m) at times (s), and the set points (A) that acted from each tick on."""

    times: np.ndarray
    centre: np.ndarray
    states: list[np.ndarray] = field(default_factory=list)


def current(flux: float, gap: float) -> float:
    """A."""
    return flux * gap / (2 * K) + IRON / (MU0 * TURNS) * max(flux / (TURNS * AREA) - SATURATED, 0.0)


def rates(q: np.ndarray, targets: list[float], alive: list[bool], volt: float) -> list[float]:
    """Time derivative of: x, y, vx, vy, angle, spin, four flux linkages, two sensors."""
    x, y, vx, vy, angle, spin = q[:6].tolist()
    u = (complex(x, y) * AXIS.conjugate()).real, (complex(x, y) * AXIS.conjugate()).imag
    fluxes, forces = [], [0.0, 0.0]
    for coil in range(4):
        sign, axis = 1 - 2 * (coil % 2), coil // 2
        flux = float(q[6 + coil])
        i = current(flux, max(GAP - sign * u[axis] * math.cos(POLE), 0.05 * GAP))
        if alive[coil]:
            v = RESISTANCE * i + AMPLIFIER * L0 * (targets[coil] - i)
            v = min(max(v, -volt), volt)
        else:
            v = -volt if flux > 0 else 0.0
        rate = v - RESISTANCE * i
        fluxes.append(0.0 if flux <= 0 and rate < 0 else rate)
        forces[axis] += sign * PULL * max(flux, 0.0) ** 2
    force = complex(*forces) * AXIS
    fx, fy, moment = force.real, force.imag, 0.0
    depth = math.hypot(x, y) - CLEARANCE
    if depth > 0:
        nx, ny = x / math.hypot(x, y), y / math.hypot(x, y)
        closing = vx * nx + vy * ny
        normal = max(STIFFNESS * depth**1.5 + DAMPING * depth * closing, 0.0)
        sliding = nx * vy - ny * vx + spin * RADIUS
        rub = FRICTION * math.tanh(STEEPNESS * sliding) * normal
        fx, fy = fx - normal * nx + rub * ny, fy - normal * ny - rub * nx
        moment = -rub * RADIUS
    ex, ey = targets[4] * math.cos(angle), targets[4] * math.sin(angle)
    turning = (moment + fx * ey - fy * ex) / INERTIA
    ax = fx / MASS + spin**2 * ex + turning * ey
    ay = fy / MASS + spin**2 * ey - turning * ex - GRAVITY
    seen = [LOW_PASS * (min(max(u[a], -RANGE), RANGE) - float(q[10 + a])) for a in (0, 1)]
    return [vx, vy, ax, ay, spin, turning, *fluxes, *seen]


class Pid:
    """The controller's law of one axis, in its own words."""

    def __init__(self, hold: float) -> None:
        self.hold = self.sum = hold
        self.slope = self.before = self.begin = 0.0

    def restart(self, y: float) -> None:
        """For re-levitation from y (m)."""
        self.sum, self.slope, self.before, self.begin = self.hold, 0.0, -y, y

    def answer(self, y: float, lead: float) -> float:
        """Control current (A) to a sample y (m), with `lead` of the way to the centre left."""
        error = lead * self.begin - y
        self.slope = (self.slope + KD * FILTER * (-y - self.before)) / (1 + FILTER * PERIOD)
        self.before = -y
        step = KI * PERIOD * error
        total = KP * error + self.sum + step + self.slope
        if abs(total) <= LIMIT or total * step < 0:
            self.sum += step
        return min(max(KP * error + self.sum + self.slope, -LIMIT), LIMIT)


def solve(loop: Loop, until: float, every: float, relative: float = 1e-9) -> Solution:
    """The motion at multiples of `every` (s) up to `until` (s); `relative` error of a micro-step."""
    hold = complex(0.0, MASS * GRAVITY) * AXIS.conjugate() / K_I
    laws = [Pid(hold.real), Pid(hold.imag)]
    acting, coming = [hold.real, hold.imag, True], [hold.real, hold.imag, True]
    q = np.zeros(12)
    q[5] = SPEED
    q[6:10] = [L0 * (BIAS + s * h) for h in (hold.real, hold.imag) for s in (1, -1)]
    absolute = np.array([1e-12] * 2 + [1e-9] * 2 + [1e-8] * 2 + [1e-11] * 4 + [1e-12] * 2)
    wanted = np.arange(1, round(until / every) + 1) * every
    alive, on, led = [True] * 4, True, math.inf
    t, tick = 0.0, 0
    found, sampled = list[complex](), list[np.ndarray]()
    while t < until - 1e-12:
        if abs(tick * PERIOD - t) < 1e-12:
            acting = coming
            asked = not loop.off - 1e-12 <= t < loop.on - 1e-12
            if asked and not on:
                led = t
                for law, y in zip(laws, q[10:], strict=True):
                    law.restart(float(y))
            on = asked
            lead = max(1 - (t - led) / RAMP, 0.0) if led < math.inf else 0.0
            sets = [law.answer(float(y), lead) if on else 0.0 for law, y in zip(laws, q[10:], strict=True)]
            coming = [*sets, on]
            sampled.append(q.copy())
            tick += 1
        if loop.failed[0] <= t + 1e-12:
            alive[loop.failed[1]] = False
        happens = (loop.failed[0], loop.link_off, tick * PERIOD, until)
        end = min(time for time in happens if time > t + 1e-12)
        targets = [
            min(max(BIAS + s * acting[a], 0.0), MOST) if acting[2] else 0.0 for a in (0, 1) for s in (1, -1)
        ]
        inside = wanted[(wanted > t + 1e-12) & (wanted <= end + 1e-12)]

        def motion(at: float, z: np.ndarray, targets: list[float] = targets) -> list[float]:
            since = at - loop.link_off
            volt = VOLTAGE * math.exp(-since / loop.decay) if since >= 0.0 else VOLTAGE
            return rates(z, [*targets, loop.eccentricity], alive, volt)

        asked_for = np.unique(np.append(np.minimum(inside, end), end))
        run = solve_ivp(motion, (t, end), q, "DOP853", t_eval=asked_for, rtol=relative, atol=absolute)
        found += [complex(*run.y[:2, i]) for i in range(len(inside))]
        q = run.y[:, -1].copy()
        q[6:10] = np.maximum(q[6:10], 0.0)
        t = end
    return Solution(wanted, np.array(found), sampled)


def by_one_controller() -> Scene:
    """Rotor I, levitated in translation and tilt."""
    apart = load_scene("rotor1-relevitated")
    kept = {k: v for k, v in apart.components.items() if k != "controller_B"}
    both = replace(apart, components=kept, control=(("controller_A", "amb_A"), ("controller_A", "amb_B")))
    return both.set({"controller_A.structure": "translation_tilt"})
