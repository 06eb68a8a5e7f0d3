"""A rotor on a magnetic bearing, pulled into its stator: a rig of the Technical University of Denmark.

The shaft hangs in a joint, a passive magnetic bearing holds it from there, and farther out it runs in a
stator with 2 mm to spare. A magnet near the joint pulls it for 140 ms. Angles times the distance of the
stator from the joint are x and y here, so masses and stiffnesses are those of the plane of contact:

    m x'' = -k_xx x + k_xy y - d x' - m g y' + unbalance + pull,    g = I_zz/I_xx times the rotor's speed

and alike for y. The contact is the model `bushing`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar

from ..bearings import bushing
from ..modelkit.instance import Instance
from .case import Found, Row, curves
from .contacts import started

AT_MAGNET, AT_BEARING, AT_DISC, AT_STATOR = 0.0725, 0.1717, 0.2597, 0.4287  # m, from the joint
ACROSS, POLAR = 7.085371e-2, 1.06132e-3  # kg m2, about the joint
STIFFNESS = np.array([[3.09e4, 2456.0], [292.0, 3.09e4]])  # N/m, in the frame of x and y here
DAMPING = np.diag([8.48, 7.7])  # N s/m
UNBALANCE = 1e-3 * complex(0.027, -0.072)  # kg m, at the disc
CLEARANCE, RADIUS = 2e-3, 12.5e-3  # m
SPEED = -17.0 * 2.0 * math.pi  # rad/s, clockwise
MASS = ACROSS / AT_STATOR**2  # kg
HERTZ = 5.1e9  # N/m^1.5, of 70 and 100 GPa and both radii, by Andersen's formula
APPROACH = 0.06  # m/s, at which restitution is meant
STEP, STEPS = 125e-6, 1144  # s, of the record
FREE = 13  # readings before the first contact

# read off the record at every 5 ms: pull (N, mean over 3 ms), x and y of the disc (mm)
PULL, X, Y = np.array([
    (0.2, -0.160, 0.490), (2.1, 0.241, 0.551), (6.4, 0.607, 0.466), (11.4, 0.839, 0.253),
    (15.7, 0.907, -0.029), (19.2, 0.816, -0.311), (22.7, 0.613, -0.510), (24.0, 0.367, -0.567),
    (24.5, 0.151, -0.466), (27.5, 0.022, -0.236), (30.3, 0.031, 0.057), (32.9, 0.190, 0.333),
    (34.4, 0.484, 0.524), (35.9, 0.851, 0.575), (37.5, 1.061, 0.414), (41.5, 0.972, 0.032),
    (41.9, 0.872, -0.354), (42.5, 0.801, -0.633), (42.3, 0.771, -0.723), (42.1, 0.781, -0.605),
    (41.3, 0.806, -0.321), (44.5, 0.830, 0.041), (46.1, 0.860, 0.377), (47.2, 0.894, 0.611),
    (45.5, 0.901, 0.655), (27.1, 0.858, 0.487), (14.4, 0.743, 0.202), (7.6, 0.509, -0.125),
    (3.3, 0.193, -0.406),
]).T  # fmt: skip
READ = 5e-3 * np.arange(len(PULL))  # s
TO_DISC = AT_DISC / AT_STATOR


def _rates() -> np.ndarray:
    """(4, 4): derivative of (x, y, x', y') without forces."""
    ratio = (AT_BEARING / AT_STATOR) ** 2 / MASS
    turning = POLAR / ACROSS * SPEED * np.array([[0.0, -1.0], [1.0, 0.0]])
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-ratio * STIFFNESS, turning - ratio * DAMPING]])


def _forced(time: float, angle: float) -> np.ndarray:
    """(4,): what unbalance, at an angle (rad) at the start, and pull add to it."""
    turned = UNBALANCE * SPEED**2 * TO_DISC * np.exp(1j * (SPEED * time + angle)) / MASS
    pull = float(np.interp(time, READ, PULL)) * AT_MAGNET / AT_STATOR / MASS
    return np.array([0.0, 0.0, turned.real + pull, turned.imag])


@dataclass(frozen=True)
class _Contact:
    """Unknowns of the contact: restitution at 60 mm/s, friction, and how much less play there is (m)."""

    restitution: float = 0.5  # by Andersen's program, as friction
    friction: float = 0.2
    nearer: float = 0.0


ASSUMED, NEARER = "restitution 0.5, friction 0.2", "stator 0.1 mm nearer"
CONTACTS = {
    ASSUMED: _Contact(),
    "elastic, no friction": _Contact(1.0, 0.0),
    "restitution 0.2, friction 0.3": _Contact(0.2, 0.3),
    NEARER: _Contact(nearer=1e-4),
}
LESS = (
    "friction brakes the way down; with less of it than Andersen's program takes, or none, the disc "
    "comes as low as measured to 4 %"
)


def _moved(start: np.ndarray, angle: float, contact: _Contact | None, steps: int = STEPS) -> np.ndarray:
    """(steps + 1, 4): motion in the plane of contact; None: there is no stator."""
    law, states, bearing = (
        _rates(),
        [np.asarray(start, float)],
        None if contact is None else _stator(contact),
    )
    for k in range(steps):
        state, time, load = states[-1], k * STEP, np.zeros((2, 4))
        if bearing is not None:
            load = _pushed(bearing, state, law @ state + _forced(time, angle), time)

        def rate(offset: float, y: np.ndarray, time: float = time, load: np.ndarray = load) -> np.ndarray:
            return law @ y + _forced(time + offset, angle) + load[0] + (offset - 0.5 * STEP) * load[1]

        a = rate(0.0, state)
        b = rate(0.5 * STEP, state + 0.5 * STEP * a)
        c = rate(0.5 * STEP, state + 0.5 * STEP * b)
        states.append(state + STEP / 6.0 * (a + 2.0 * b + 2.0 * c + rate(STEP, state + STEP * c)))
    return np.array(states)


def _stator(contact: _Contact) -> Instance:
    """The bushing that the shaft runs in."""
    dissipation = 0.75 * (1.0 - contact.restitution**2) / APPROACH
    parameters = {"clearance": CLEARANCE - contact.nearer, "journal_radius": RADIUS}
    parameters |= {"contact.stiffness": HERTZ, "contact.damping": 0.0, "contact.dissipation": dissipation}
    parameters |= {"friction.kind": 0, "friction.slope": 1e3}
    parameters |= dict.fromkeys(("friction.static", "friction.dynamic"), contact.friction)
    return started(bushing.MODEL, parameters, {"journal.omega": SPEED, "journal.inv_m": 1.0 / MASS})


def _pushed(bearing: Instance, state: np.ndarray, free: np.ndarray, time: float) -> np.ndarray:
    """(2, 4): mean and slope over a step of what the stator adds to the rates."""
    u = bearing.memory["u"]["journal"]
    u["x"], u["y"], u["vx"], u["vy"] = state
    u["ax_free"], u["ay_free"] = free[2:]
    bearing.step(time, STEP)
    o: Any = bearing.record["o"]["journal"]
    return np.array([[0.0, 0.0, o["fx"], o["fy"]], [0.0, 0.0, o["dfx"], o["dfy"]]]) / MASS


@cache
def _fitted() -> tuple[np.ndarray, float]:
    """Start (4,) and angle of the unbalance (rad) that fit the readings before the first contact best."""
    steps = round(READ[FREE] / STEP)
    read_at = np.round(READ[: FREE + 1] / STEP).astype(int)
    still = np.zeros(4)
    ahead, left, behind, right = (
        _moved(still, 0.5 * math.pi * k, None, steps)[read_at, :2] for k in range(4)
    )
    pulled, turned, quarter = 0.5 * (ahead + behind), 0.5 * (ahead - behind), 0.5 * (left - right)
    alone = np.stack([_moved(unit, 0.0, None, steps)[read_at, :2] - ahead for unit in np.eye(4)], axis=-1)
    read = 1e-3 * np.stack([X[: FREE + 1], Y[: FREE + 1]], axis=-1) / TO_DISC

    def start(angle: float) -> tuple[np.ndarray, float]:
        """The best start for an angle, and the sum of squares it leaves (m2)."""
        rest = read - pulled - math.cos(angle) * turned - math.sin(angle) * quarter
        found, squares, *_ = np.linalg.lstsq(alone.reshape(-1, 4), rest.ravel(), rcond=None)
        return found, float(squares[0])

    angles = np.radians(np.arange(0.0, 360.0, 10.0))
    near = min(angles, key=lambda angle: start(angle)[1])
    best: Any = minimize_scalar(lambda a: start(a)[1], bounds=(near - 0.2, near + 0.2), method="bounded")
    return start(float(best.x))[0], float(best.x)


def _disc(contact: _Contact) -> np.ndarray:
    """(STEPS + 1, 2): x and y of the disc (mm)."""
    return 1e3 * TO_DISC * _moved(*_fitted(), contact)[:, :2]


def contacts(path: np.ndarray) -> tuple[int, int]:
    """Steps at which the disc is farthest from the middle, around its two contacts."""
    far = np.hypot(*path.T)
    first = slice(round(0.055 / STEP), round(0.08 / STEP))
    second = slice(round(0.105 / STEP), round(0.13 / STEP))
    return first.start + int(np.argmax(far[first])), second.start + int(np.argmax(far[second]))


def rotor_pulled() -> Found:
    """17 Hz, 0.4 kg in the plane of contact on 5 N/mm, a measured pull of up to 47 N for 140 ms, two
    contacts with `bushing`. The third and fourth column of the record are taken for the disc's place. Not
    published: the stator's middle, restitution and friction (Andersen's program: 0.5 and 0.2, as in the
    first rows, with a resting stator in the middle); other rows show the range."""
    rows: list[Row] = []
    paths = {name: _disc(contact) for name, contact in CONTACTS.items()}
    for name, path in paths.items():
        one, two = contacts(path)
        (left, down), label = path[one:two].min(axis=0), f", {name}" if name != ASSUMED else ""
        if name in (ASSUMED, NEARER):  # else nothing of it has been different yet
            rows += [
                Row(f"first contact{label}", "ms", 68.5, 1e3 * one * STEP),
                Row(f"disc from the middle at the first{label}", "mm", 1.167, float(np.hypot(*path[one]))),
            ]
        rows += [
            Row(f"x at its least before the second{label}", "mm", 0.770, float(left)),
            Row(f"y at its least before the second{label}", "mm", -0.725, float(down), why=LESS),
            Row(f"second contact{label}", "ms", 118.1, 1e3 * two * STEP),
            Row(f"disc from the middle at the second{label}", "mm", 1.133, float(np.hypot(*path[two]))),
        ]
    measured = "measured, at every 5 ms", (X, Y)
    lines = {name: (path[:, 0], path[:, 1]) for name, path in paths.items()}
    return Found(rows, curves("x of the disc, mm", "y of the disc, mm", measured, lines, equal=True))
