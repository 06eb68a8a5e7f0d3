"""Mounts of touchdown bearings: dry friction, and a squeeze film, at rest and under a turning force."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ..bearings.supports import mount
from ..bearings.supports import mount_law as law
from ..modelkit.variables import as_record
from .case import Row
from .contacts import started

STIFFNESS, FORCE, REACH = 2e7, 400.0, 60e-6  # N/m, N, m
STEPS = 1000


def _heat_of_a_turn(circle: bool) -> float:
    """Of a Jenkins element (J) whose end goes to and fro, or in a circle, by `REACH`; the last of six."""
    slides = (law.Slide(STIFFNESS, FORCE), *(law.Slide(),) * (law.SLIDES - 1))
    p: Any = as_record(law.Elements(slide=slides))
    angle = 2.0 * math.pi * np.arange(6 * STEPS + 1) / STEPS
    path = REACH * np.stack((np.cos(angle), np.sin(angle) if circle else 0.0 * angle), 1)
    z, heat, before = np.zeros(2 * law.SLIDES), np.zeros(law.HEATS), 0.0
    for k, ((x, y), (dx, dy)) in enumerate(zip(path[:-1], np.diff(path, axis=0), strict=True)):
        if k == 5 * STEPS:
            before = float(heat.sum())
        law.go(p, x, y, dx, dy, 1e-5, z, heat)
    return float(heat.sum()) - before


def jenkins_line() -> list[Row]:
    """Heat of a cycle of 60 um, with 2e7 N/m and 400 N, from the area of the loop."""
    exact = 4.0 * FORCE * (REACH - FORCE / STIFFNESS)
    return [Row("heat of a cycle", "J", exact, _heat_of_a_turn(False))]


def jenkins_circle() -> list[Row]:
    """Heat of a turn of a circle of 60 um once it is steady."""
    exact = 2.0 * math.pi * FORCE * math.sqrt(REACH**2 - (FORCE / STIFFNESS) ** 2)
    return [Row("heat of a turn", "J", exact, _heat_of_a_turn(True))]


def squeeze_film() -> list[Row]:
    """Damping at half the clearance: radius 30 mm, length 12 mm, clearance 0.1 mm, 10 mPa s; whole, and
    torn to half by cavitation while it circles."""
    unit, e = 0.01 * 0.03 * (0.012 / 1e-4) ** 3, 0.5
    whole, torn = (law.Film(0.03, 0.012, 1e-4, 0.01, cavitation) for cavitation in (0, 1))
    radial, _, across = law.film_matrix(as_record(whole), e * 1e-4, 0.0, 0.0, 1.0)
    _, mixed, half = law.film_matrix(as_record(torn), e * 1e-4, 0.0, 0.0, 1.0)
    return [
        Row("whole, radial", "N s/m", math.pi * (1 + 2 * e * e) * unit * (1 - e * e) ** -2.5, radial),
        Row("whole, circling", "N s/m", math.pi * unit * (1 - e * e) ** -1.5, across),
        Row("torn, circling", "N s/m", 0.5 * math.pi * unit * (1 - e * e) ** -1.5, half),
        Row("torn, radial by circling", "N s/m", 2.0 * unit * e / (1 - e * e) ** 2, mixed),
    ]


FORCE_TURNING, RATE, MASS, SPRING, VISCOSITY = 2148.0, 3000.0, 1.0, 1e6, 0.01  # N, rad/s, kg, N/m, Pa s
RADIUS, LENGTH, ROOM = 0.03, 0.012, 1e-4  # m, of the film
TURNS, SETTLED = 60, 8


def _orbit(step: float) -> tuple[float, float]:
    """Smallest and largest eccentricity in the last turns under a force that turns, at a macro step (s)."""
    film = {"radius": RADIUS, "length": LENGTH, "clearance": ROOM, "viscosity": VISCOSITY, "cavitation": 0}
    parameters = {"gravity": 0.0, "mount.mass": MASS, "mount.outer_ring": 0.0}
    parameters |= {f"mount.film.{name}": value for name, value in film.items()}
    for axis in ("xx", "yy"):
        parameters |= {f"mount.spring.{axis}": SPRING, f"mount.damper.{axis}": 0.0}
    instance = started(mount.MODEL, parameters, {})
    load: Any = instance.record["u"]["seat"][0]
    z, steps, found = 0.5 * RATE * step, round(2.0 * math.pi * TURNS / RATE / step), []
    mean, slope = math.sin(z) / z, 3.0 * RATE * (math.sin(z) - z * math.cos(z)) / z**3
    for k in range(steps):
        turned = FORCE_TURNING * np.exp(1j * RATE * (k + 0.5) * step)
        load["fx"], load["fy"] = (mean * turned).real, (mean * turned).imag
        load["dfx"], load["dfy"] = (1j * slope * turned).real, (1j * slope * turned).imag
        instance.step(k * step, step)
        x, y = instance.record["q"][:2]
        found.append(math.hypot(x, y) / ROOM)
    last = found[-(steps * SETTLED // TURNS) :]
    return min(last), max(last)


def squeeze_film_orbit() -> list[Row]:
    """1 kg on 1 N/um in a full film 0.1 mm wide, under 2148 N that turn at 3000 rad/s, from rest:
    eccentricity in the last 8 of 60 turns, at macro steps of a sixth of a radian and more."""
    unit = VISCOSITY * RADIUS * (LENGTH / ROOM) ** 3

    def missing(e: float) -> float:
        resistance = math.pi * unit * (1.0 - e * e) ** -1.5
        return abs(SPRING - MASS * RATE**2 + 1j * RATE * resistance) * e * ROOM - FORCE_TURNING

    exact = float(brentq(missing, 0.1, 0.99))  # type: ignore[arg-type]
    rows: list[Row] = []
    for step in (80e-6, 100e-6):
        for name, value in zip(("smallest", "largest"), _orbit(step), strict=True):
            rows.append(Row(f"{name} eccentricity, {1e6 * step:g} us", "1", exact, value))
    return rows
