"""Coupled problems of the co-simulation literature, as FMUs that are compiled for the case."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import fmpy
import numpy as np

from ..command.api.run import run
from . import bodies
from .case import Found, Row, UnavailableError, curves

STEP = 1e-3  # s, macro steps


def _moved(
    parts: Mapping[str, bodies.Settings], wires: Sequence[object], duration: float
) -> Mapping[str, np.ndarray]:
    """Times (s) and motion of coupled bodies by variable, after every macro step.

    Raises `UnavailableError` without a C compiler for the platform that bodies are packed for.
    """
    if bodies.COMPILER is None or fmpy.platform != bodies.PLATFORM:
        raise UnavailableError(f"it needs a C compiler for {bodies.PLATFORM}")
    with tempfile.TemporaryDirectory() as folder:
        path = bodies.fmu(bodies.compiled(Path(folder)))
        steps = {"macro_step": STEP, "duration": duration, "record_every": 1}
        data = run(bodies.scene(path, parts, wires, run=steps)).data
        return {str(name): np.asarray(data[name]) for name in ("time", *data.data_vars)}


def two_masses() -> list[Row]:
    """Shot at each other with 100 m/s, without damping, for 10 s; force one way, motion the other."""
    data = _moved(bodies.oscillator(), bodies.TWO, 10.0)
    states = np.array([data[name][-1] for name in ("s1.x", "s1.v", "s2.x", "s2.v")])
    exact = bodies.exact_oscillator(data["time"][-1:])[0]
    return [
        Row("first mass after 10 s", "m", float(exact[0]), float(states[0])),
        Row("second mass after 10 s", "m", float(exact[2]), float(states[2])),
        Row("energy after 10 s", "kJ", 10.0, 1e-3 * float(bodies.energy(states[None])[0])),
    ]


def precice_oscillator() -> list[Row]:
    """1 kg each on 4 pi^2 N/m, 16 pi^2 N/m between them, the left one let go from 1 m, for 1 s."""
    wall, between = 4.0 * math.pi**2, 16.0 * math.pi**2
    parts = {"s1": {"k": wall, "kc": between, "x0": 1.0}, "s2": {"k": wall}}
    data = _moved(parts, bodies.TWO, 1.0)

    def modes(time: float, sign: float) -> float:
        return 0.5 * (math.cos(2.0 * math.pi * time) + sign * math.cos(6.0 * math.pi * time))

    return [
        Row(f"{side} mass after {time:g} s", "m", modes(time, sign), float(data[name][round(time / STEP)]))
        for time in (0.7, 1.0)
        for side, name, sign in (("left", "s1.x", 1.0), ("right", "s2.x", -1.0))
        if time < 1.0 or sign > 0.0  # the right one is back at 0 after 1 s
    ]


def quarter_car() -> Found:
    """The road rises by 0.1 m at once. Heights and speeds of chassis and wheel over 2 s."""
    data = _moved(bodies.CAR, bodies.CAR_WIRES, 2.0)
    exact = bodies.exact_car(data["time"])
    first, times = round(0.2 / STEP), np.linspace(0.0, 2.0, 81)
    rows = [
        Row("chassis at its highest", "m", float(exact[:, 0].max()), float(data["chassis.x"].max())),
        Row("wheel at its highest", "m", float(exact[:, 2].max()), float(data["wheel.x"].max())),
        Row("wheel's fastest", "m/s", float(exact[:, 3].max()), float(data["wheel.v"].max())),
        Row("chassis after 0.2 s", "m", float(exact[first, 0]), float(data["chassis.x"][first])),
    ]
    heights = {part: (data["time"], data[f"{part}.x"]) for part in ("chassis", "wheel")}
    theirs = (np.tile(times, 2), bodies.exact_car(times)[:, (0, 2)].T.ravel())
    return Found(rows, curves("time, s", "height, m", ("by eigenvalues", theirs), heights))
