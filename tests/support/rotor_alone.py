"""Rotor I without bearings: started, loaded, stepped, and what an integrator without modes makes of it."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from scipy.integrate import solve_ivp

from touchdown.modelkit.instance import Instance
from touchdown.modelkit.model import Model
from touchdown.rotor.file import load_rotor, shipped_rotors
from touchdown.rotor.flexible import flexible_rotor

SHAFT = load_rotor(shipped_rotors()["rotor_I"])
MODEL = flexible_rotor(SHAFT, "rotor_I")
NAMES = [s.name for s in SHAFT.stations]
NODES = [s.node for s in SHAFT.stations]
ARMS = SHAFT.positions()[[n - 1 for n in NODES]] - SHAFT.centre_of_mass
FAST = 18000.0 * math.pi / 30.0  # rad/s
G = 9.81  # m/s2


Loads = Mapping[str, Mapping[str, float]]
PULLED: Loads = {
    "A": {"fx": 300.0, "fy": -200.0, "mz": 0.05, "dfx": 4e6, "dfy": -3e6, "dmz": 200.0},
    "B": {"fx": -100.0, "fy": 400.0, "mz": -0.02, "dfx": -2e6, "dfy": 1e6, "dmz": -300.0},
    "amb_A": {"fy": 20.0},
    "amb_B": {"fy": 25.0},
}


def give(rotor: Instance, loads: Loads, factor: float = 1.0) -> None:
    """These loads and no others, all times `factor`."""
    for name, station in zip(NAMES, rotor.record["u"]["station"], strict=False):
        for field in ("fx", "fy", "mz", "dfx", "dfy", "dmz"):
            station[field] = factor * loads.get(name, {}).get(field, 0.0)


def started(loads: Loads | None = None, model: Model = MODEL, **parameters: float) -> Instance:
    """A rotor that has just started, then loaded; without loads of its own, it floats."""
    rotor = Instance(model)
    for name, value in parameters.items():
        rotor.record["p"][name] = value
    rotor.start(0.0)
    give(rotor, loads or {})
    return rotor


def run(rotor: Instance, steps: int, step: float) -> None:
    for k in range(steps):
        rotor.step(k * step, step)


def coordinates(rotor: Instance) -> tuple[np.ndarray, np.ndarray]:
    """Modal coordinates and velocities, x + i y."""
    n = int(rotor.record["d"]["modes"])
    px, py, vx, vy = np.array(rotor.record["q"][: 4 * n]).reshape(4, n)
    return px + 1j * py, vx + 1j * vy


def behind(rotor: Instance, index: int) -> float:
    """Angle, spin or loss."""
    return float(rotor.record["q"][4 * int(rotor.record["d"]["modes"]) + index])


def derivative(rotor: Instance, t: float, state: np.ndarray) -> np.ndarray:
    whole = np.zeros(len(rotor.record["q"]))
    whole[: len(state)] = state
    found = np.zeros_like(whole)
    rotor.model.derivative(t, whole, found, rotor.words)  # type: ignore[misc]
    return found[: len(state)]


def integrated(rotor: Instance, step: float) -> np.ndarray:
    """State after a macro step by an integrator that knows nothing of modes."""
    rotor.record["half"] = 0.5 * step
    state = np.array(rotor.record["q"][: int(rotor.record["n"])])
    found = solve_ivp(
        lambda t, y: derivative(rotor, t, y), (0.0, step), state, "DOP853", rtol=1e-12, atol=1e-16
    )
    return found.y[:, -1]


def deviations(step: float, micro_steps: list[float], **parameters: float) -> list[float]:
    """Largest error of a modal coordinate (m kg^0.5) after one macro step in strides of these lengths."""
    setting = {"speed": FAST, "vx": 0.1, "vy": -0.2, **parameters}
    exact = integrated(started(PULLED, **setting), step)
    found = []
    for micro_step in micro_steps:
        rotor = started(PULLED, micro_step=micro_step, **setting)
        rotor.step(0.0, step)
        count = 2 * int(rotor.record["d"]["modes"])
        found.append(float(np.max(np.abs(rotor.record["q"][:count] - exact[:count]))))
    return found


def order(micro_steps: list[float], errors: list[float]) -> float:
    return float(np.polyfit(np.log(micro_steps), np.log(errors), 1)[0])
