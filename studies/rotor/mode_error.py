"""The error that a number of modes costs in a first impact, estimated within a second.

A level rotor, not spinning, falls on all its seats at once, in the vertical plane. Each seat is a chain:
journal, contact with the bore, inner ring, balls on both races, and the carrier on its mount. Each step is
a kick by the forces, then the exact motion of the free modes, rings and carriers: of second order. All
numbers of modes run side by side, the reference with all modes first.

Left out: spin, unbalance, friction, bending of the rings, preload of pairs, and that a contact angle
changes under load, tilt and motion along the shaft; with K d^1.5 along the contact line, rows at an angle a
have K cos(a)^2.5 across the shaft. They change the forces, so that a single number of modes may come out
better or worse by chance; an error is therefore the largest with that number of modes or with more.
`compare --of modes` runs the scene itself.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from ...bearings.contact.laws import damp
from ...bearings.contact.line import FROM_GEOMETRY, BoreContact, set_line
from ...bearings.contact.materials import elastic_of
from ...bearings.rolling.ball_set import (
    BallSet,
    RaceStiffness,
    ball_mass,
    series_dissipation,
    set_race_law,
    set_stiffness,
)
from ...bearings.rolling.ring import Ring
from ...master.common.errors import TouchdownError
from ...master.common.text import percent
from ...master.coupling.connections import Attachment, housing_port
from ...master.results.final_state import ReadableSystem
from ...master.results.summary import touchdown_seats
from ...master.scene.scene import INCLINATION, Scene
from ...modelkit.ports import MODES, PARTING_TOLERANCE
from ...modelkit.variables import as_record
from ...rotor.beams.shaft import Shaft
from ...rotor.modal.data import seats as touchable
from ...rotor.modal.modes import RIGID_MODES, basis, fullest
from ..drop.impact_watch import AVERAGING_TIME
from .supports import foundation_of, scene_shaft

GRAVITY = 9.81  # m/s2
ERROR_LIMIT = 0.01  # of a first impact, that the number of modes may cost
FEWEST, SPACING = 4, 2  # of the numbers of modes that are tried: the first, and from one to the next
BEYOND = 4  # modes more than seats can carry, with which the errors are also looked at
LONGEST = 10e-3  # s, that a first impact is followed
STEPS_PER_PERIOD = 40  # of an inner ring between journal and balls
LOOK = 64  # steps between looks whether the impact is over


class ImpactSeat(NamedTuple):
    """A touchdown bearing and its mount; SI."""

    node: int
    clearance: float
    contact: Any  # record of `ContactLaw`: journal and bore
    race: Any  # record of `ContactLaw`: a ball between the races
    balls: int
    play: float
    ring: float  # mass
    damping: float  # between the rings
    mount: tuple[float, float, float]  # mass (inf: the ground), stiffness, damping


def impact_seat(node: int, values: Mapping[str, float], mount: tuple[float, float, float]) -> ImpactSeat:
    """From the parameters of a ball bearing's model by name, SI. Raises KeyError for other kinds.

    Of a ball at a contact angle a, d across the shaft is d cos(a) along the contact line, and F likewise
    F cos(a) across it.
    """
    contact, balls, rings = (_declared(group, values) for group in _GROUPS)
    radius, clearance, ring = values["journal_radius"], values["clearance"], values["ring.mass"]
    if contact["law"] == FROM_GEOMETRY:
        set_line(contact, radius, clearance)
    damp(contact, ring)
    stiffness, race = as_record(RaceStiffness()), as_record(BoreContact())
    set_stiffness(stiffness, balls, elastic_of(rings))
    set_race_law(race, balls, stiffness["series"], ball_mass(balls), series_dissipation(stiffness))
    cosine = math.cos(values.get(ANGLE, 0.0))
    race["stiffness"] *= cosine**2.5
    race["damping"] *= cosine**3  # times d d'
    return ImpactSeat(
        node, clearance, contact, race, int(balls["count"]), float(balls["play"]),
        ring, values.get("damping", 0.0), mount,
    )  # fmt: skip


ANGLE = "balls.contact_angle"
_GROUPS: dict[str, type] = {"contact": BoreContact, "balls": BallSet, "ring": Ring}
NUMBERS = {  # parameters of a bearing that are looked at
    *(f"{group}.{f.name}" for group, kind in _GROUPS.items() for f in fields(kind)),
    *("journal_radius", "clearance", "damping", ANGLE),
}


def _declared(group: str, values: Mapping[str, float]) -> Any:
    """A record of one of `_GROUPS` with those of its values that are there."""
    kind = _GROUPS[group]
    settings = {f.name: values[name] for f in fields(kind) if (name := f"{group}.{f.name}") in values}
    return as_record(kind(**settings))


@dataclass(frozen=True)
class ModeError:
    """What a number of modes per plane costs in a first impact, over that with all modes."""

    modes: int
    contact: float  # of the largest momentary contact force
    journal: float  # of the largest force on a journal averaged over `AVERAGING_TIME`
    whole: bool  # whether these are all modes

    @property
    def worst(self) -> float:
        """The larger of both."""
        return max(self.contact, self.journal)

    def __str__(self) -> str:
        if self.whole:
            return "all modes"
        return f"first impact within {percent(self.worst, 2)} of all modes, by estimate"


def capacity(shaft: Shaft) -> int:
    """Modes per plane that a seat can carry one by one beside the residual vectors, or all there are."""
    return min(shaft.coordinates, MODES + RIGID_MODES - len(set(touchable(shaft))))


def mode_errors(
    shaft: Shaft, seats: Sequence[ImpactSeat], first: int = FEWEST, residual: bool = True
) -> list[ModeError]:
    """For numbers of modes from `first` on: the largest error with that many or more.

    residual: whether the seats keep the flexibility of the modes that are left out.
    """
    nodes = tuple(dict.fromkeys(touchable(shaft)))
    most = min(max(capacity(shaft), first) + BEYOND, shaft.coordinates)
    counts = sorted({*range(min(first, most), most, SPACING), min(capacity(shaft), most), most})
    bases = [basis(shaft, count, nodes if residual else ()) for count in counts]
    peaks = _first_peaks(_Fall(shaft, [fullest(shaft, nodes), *bases], seats))
    errors = np.abs(peaks[:, 1:] / peaks[:, :1] - 1.0).max(axis=2)
    worst = np.maximum.accumulate(errors[:, ::-1], axis=1)[:, ::-1]
    found = [
        ModeError(n, float(contact), float(journal), n == shaft.coordinates)
        for n, (contact, journal) in zip(counts, worst.T, strict=True)
    ]
    return [one for one in found if one.modes >= first]


def fewest_modes(shaft: Shaft, seats: Sequence[ImpactSeat]) -> ModeError:
    """The smallest number of modes that costs at most `ERROR_LIMIT`, or that which costs least."""
    errors = [one for one in mode_errors(shaft, seats) if one.modes <= capacity(shaft)]
    return next((e for e in errors if e.worst <= ERROR_LIMIT), min(errors, key=lambda e: e.worst))


def scene_mode_error(scene: Scene, system: ReadableSystem, body: str) -> ModeError | None:
    """Of a scene's rotor `body` with its modes; None where there is nothing to estimate it by.

    That is so for a rotor that is not of elements, keeps all its modes or is not level, or no ball bearing
    to fall into.
    """
    tilted = f"{body}.{INCLINATION}"
    if tilted in system and system.value(tilted) != 0.0:
        return None
    try:
        shaft = scene_shaft(scene, body)
        modes, residual = (int(system.value(f"{body}.{name}")) for name in ("modes", "residual"))
        seats = [_scene_seat(system, a, shaft) for a in touchdown_seats(system) if a.body == body]
    except (KeyError, TouchdownError):
        return None
    if not seats or not 0 < modes < shaft.coordinates:
        return None
    return mode_errors(shaft, seats, modes, bool(residual))[0]


def _scene_seat(system: ReadableSystem, a: Attachment, shaft: Shaft) -> ImpactSeat:
    variables = system.components[a.bearing].variables
    values = {name: system.value(f"{a.bearing}.{name}") for name in variables if name in NUMBERS}
    port = housing_port(system, a.bearing)
    mount = foundation_of(system, port) if port is not None else None
    held = (math.inf, 0.0, 0.0) if mount is None else (mount.mass, mount.stiffness, mount.damping)
    return impact_seat(shaft.node(a.body_port), values, held)


def _first_peaks(fall: _Fall) -> np.ndarray:
    """Largest contact force, and largest of its averages (2, bases, seats), N, in the first impacts."""
    force = fall.forces()
    span = max(1, round(AVERAGING_TIME / fall.step))
    impulse = np.concatenate((np.zeros((span, *force.shape[1:])), np.cumsum(force, axis=0)))
    average = (impulse[span:] - impulse[:-span]) / span
    peaks = np.empty((2, *force.shape[1:]))
    for seat in range(force.shape[2]):
        pressed = np.flatnonzero(force[:, 0, seat] > 0.0)
        parted = np.flatnonzero(np.diff(pressed) * fall.step > PARTING_TOLERANCE)
        end = 1 + (pressed[parted[0]] if len(parted) else pressed[-1])
        peaks[0, :, seat], peaks[1, :, seat] = (f[:end, :, seat].max(axis=0) for f in (force, average))
    return peaks


class _Fall:
    """A rotor of several bases (B) that touches its seats (S); positions upwards (B, S), m."""

    def __init__(self, shaft: Shaft, bases: Sequence[Any], seats: Sequence[ImpactSeat]) -> None:
        size, self._seats = max(len(one.omega) for one in bases), seats
        omega = np.zeros((len(bases), size))
        self._shapes = np.zeros((len(bases), len(seats), size))  # at the seats
        for row, one in enumerate(bases):
            omega[row, : len(one.omega)] = one.omega
            self._shapes[row, :, : len(one.omega)] = one.deflections([seat.node for seat in seats])
        self._contacts, self._races = (_laws([getattr(s, f) for s in seats]) for f in ("contact", "race"))
        self._ring, self._damping = (np.array([getattr(s, f) for s in seats]) for f in ("ring", "damping"))
        self._mass, self._spring, self._damper = np.array([seat.mount for seat in seats]).T
        self._directions = [np.cos(2.0 * np.pi * np.arange(s.balls) / s.balls) for s in seats]
        self._speed = math.sqrt(2.0 * GRAVITY * min(seat.clearance for seat in seats))
        self._weight = GRAVITY * math.sqrt(shaft.mass)
        self.step = self._chosen_step()
        self._exact = _stepped(omega, shaft.damping_ratio, self.step)

    def _chosen_step(self) -> float:
        """A part of the fastest ring's period on its springs, each pressed by the rigid rotor alone (s)."""
        gain, slope = np.sum(self._shapes[0, :, :RIGID_MODES] ** 2, axis=1), 0.0
        races = self._races[:2] * [[float(seat.balls) for seat in self._seats], [1.0] * len(self._seats)]
        for stiffness, exponent in (self._contacts[:2], races):
            energy = (exponent + 1.0) * self._speed**2 / (2.0 * gain * stiffness)
            slope += exponent * stiffness * energy ** ((exponent - 1.0) / (exponent + 1.0))
        return float(2.0 * np.pi / STEPS_PER_PERIOD * np.sqrt(self._ring / slope).min())

    def forces(self) -> np.ndarray:
        """Contact forces (steps, B, S), N, until the reference has left all seats, or for `LONGEST`."""
        shape, step = self._shapes.shape[:2], self.step
        p, v = np.zeros((2, shape[0], self._shapes.shape[2]))
        v[:, 0] = -self._speed * self._weight / GRAVITY
        ring = start = np.tile([-max(seat.play, 0.0) for seat in self._seats], (shape[0], 1))
        carrier, ring_speed, carrier_speed = np.zeros((3, *shape))
        stiffness, exponent, dissipation, damping, viscous = self._contacts
        pp, pv, vp, vv = self._exact
        journal, journal_speed = start, (self._shapes @ v[:, :, None])[:, :, 0]
        found: list[np.ndarray] = []
        free = round(PARTING_TOLERANCE / step) + 1
        for k in range(round(LONGEST / step)):
            depth = np.maximum(ring - journal, 0.0)
            elastic = stiffness * depth**exponent
            rate = ring_speed - journal_speed
            damped = dissipation * elastic + np.where(depth > 0.0, damping * depth + viscous, 0.0)
            force = np.maximum(elastic + damped * rate, 0.0)
            found.append(force)
            if k % LOOK == 0 and k > free and not np.any([one[0] for one in found[-free:]]):
                break
            held = self._held(carrier - ring, carrier_speed - ring_speed)
            modal = (force[:, None, :] @ self._shapes)[:, 0, :]
            modal[:, 0] -= self._weight
            v = v + step * modal
            p, v = pp * p + pv * v, vp * p + vv * v
            ring_speed = ring_speed + step * (held - force) / self._ring
            resists = self._spring * carrier + self._damper * carrier_speed
            carrier_speed = carrier_speed - step * (held + resists) / self._mass
            ring, carrier = ring + step * ring_speed, carrier + step * carrier_speed
            journal = start + (self._shapes @ p[:, :, None])[:, :, 0]
            journal_speed = (self._shapes @ v[:, :, None])[:, :, 0]
        return np.array(found)

    def _held(self, gap: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """Upward force of the balls on the inner rings (B, S), N; gap: carrier above ring, m."""
        force = self._damping * rate
        for k, (seat, cosine) in enumerate(zip(self._seats, self._directions, strict=True)):
            depth = np.maximum(np.multiply.outer(gap[:, k], cosine) - seat.play, 0.0)
            stiffness, damping = self._races[0, k], self._races[3, k]
            pressed = depth * (stiffness * np.sqrt(depth) + damping * np.multiply.outer(rate[:, k], cosine))
            force[:, k] += np.maximum(pressed, 0.0) @ cosine
        return force


def _laws(laws: Sequence[Any]) -> np.ndarray:
    """Stiffness, exponent, dissipation, damping, viscous (5, S) of contacts."""
    names = ("stiffness", "exponent", "dissipation", "damping", "viscous")
    return np.array([[float(law[name]) for law in laws] for name in names])


def _stepped(omega: np.ndarray, damping_ratio: float, step: float) -> tuple[np.ndarray, ...]:
    """Exact step of x'' + 2 zeta omega x' + omega^2 x = f: what x and x' become of x, x', and of f."""
    swings, safe = omega > 0.0, np.where(omega > 0.0, omega, 1.0)
    damped, decay = safe * math.sqrt(1.0 - damping_ratio**2), np.exp(-damping_ratio * omega * step)
    cosine, sine = decay * np.cos(damped * step), decay * np.sin(damped * step) / damped
    half = damping_ratio * omega * sine
    xx, xv = np.where(swings, cosine + half, 1.0), np.where(swings, sine, step)
    vx, vv = -np.where(swings, omega**2 * sine, 0.0), np.where(swings, cosine - half, 1.0)
    return xx, xv, vx, vv
