"""What the modal rotor's kernels read: modes at its stations, gyroscopics, unbalance, stresses.

Prepared once from the shaft and the parameters, outside the kernels. Modal coordinates are
mass-normalised and the same in both planes; the polar matrix couples the planes (`rotor.modal.motion`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from touchdown.modelkit.ports import MODES
from touchdown.modelkit.variables import array, integer, real
from touchdown.rotor.beams.shaft import MOST_NODES, MOST_STATIONS, Shaft
from touchdown.rotor.modal.modes import RIGID, Basis, basis
from touchdown.rotor.modal.stresses import recovery

MOST_MODES = 2 * MOST_NODES  # per plane, residual vectors included
MOST_ENDS = 2 * (MOST_NODES - 1)  # of elements
NEGLIGIBLE = 1e-9  # of a station's inv_m: a mode that has a node there


@dataclass(frozen=True)
class Derived:
    """Constants of the kernels; rows and columns in use come first."""

    modes: int = integer(0, "per plane, the rigid ones and residual vectors included")
    stations: int = integer(0, "places that take a load")
    sensors: int = integer(0, "places that only tell their motion")
    nodes: int = integer(0, "of the finite elements")
    ends: int = integer(0, "of the elements, two each")
    unbalanced: int = integer(0, "whether there is any unbalance")
    mass: float = real(0.0, "kg", "of the rotor")
    inertia: float = real(0.0, "kg.m2", "polar")
    damping_ratio: float = real(0.0, "1", "of the elastic modes")
    inv_m: np.ndarray = array(MOST_STATIONS)
    static_fy: np.ndarray = array(MOST_STATIONS)  # N, holds the rotor at rest at the start
    sag: np.ndarray = array(MOST_MODES)  # vertical modal coordinates at the start
    stiffness: np.ndarray = array(MOST_MODES)  # omega^2
    damping: np.ndarray = array(MOST_MODES)  # 2 zeta omega
    weight: np.ndarray = array(MOST_MODES)  # modal force of gravity, per m/s2, upwards
    shape: np.ndarray = array(MOST_STATIONS, MOST_MODES)
    sensor_shape: np.ndarray = array(MOST_STATIONS, MOST_MODES)
    slots: np.ndarray = array(MOST_STATIONS)  # modes told of at a station
    slot: np.ndarray = array(MOST_STATIONS, MOST_MODES)  # of a mode; -1: none
    lumped: np.ndarray = array(MOST_STATIONS)  # whether the last slot holds more than one mode
    polar: np.ndarray = array(MOST_MODES, MOST_MODES)  # modal polar matrix, Q diag(principal) Q^T
    turn: np.ndarray = array(MOST_MODES, MOST_MODES)  # Q^T
    principal: np.ndarray = array(MOST_MODES)
    unbalance_x: np.ndarray = array(MOST_MODES)  # modal unbalance in the rotor's frame, kg^0.5 m
    unbalance_y: np.ndarray = array(MOST_MODES)
    position: np.ndarray = array(MOST_NODES)  # m
    end_node: np.ndarray = array(MOST_ENDS)  # counted from 0
    bending: np.ndarray = array(MOST_ENDS, MOST_MODES)  # Pa per modal coordinate
    shear: np.ndarray = array(MOST_ENDS, MOST_MODES)
    bending_load: np.ndarray = array(MOST_ENDS, MOST_STATIONS)  # Pa/N, of the modes left out
    shear_load: np.ndarray = array(MOST_ENDS, MOST_STATIONS)


def seats(shaft: Shaft) -> list[int]:
    """Nodes (from 1) of the stations that do not levitate the rotor: those where it can touch down."""
    return [s.node for s in shaft.stations if s.name not in shaft.levitated_at]


@lru_cache(maxsize=16)
def chosen_basis(shaft: Shaft, modes: int, residual: int) -> Basis:
    """Free-free modes, with residual vectors at the seats where asked for."""
    return basis(shaft, modes, tuple(dict.fromkeys(seats(shaft))) if residual else ())


@lru_cache(maxsize=16)
def prepare(
    shaft: Shaft, modes: int, residual: int, damping_ratio: float, gravity: float, acceleration: int
) -> Derived:
    """All constants of a rotor; `acceleration`: stresses by mode acceleration."""
    found = chosen_basis(shaft, modes, residual)
    n = len(found.omega)
    shape = found.deflections([s.node for s in shaft.stations])
    sensed = found.deflections([s.node for s in shaft.sensors])
    weight = np.zeros(n)
    weight[0] = np.sqrt(shaft.mass)  # the translation's; to gravity all others are orthogonal
    static = static_forces(shaft, gravity)
    slots, slot = _slots(shape)
    principal, turned = np.linalg.eigh(found.gyroscopic)
    stiffness = found.omega**2
    sag = np.zeros(n)
    sag[RIGID:] = (shape[:, RIGID:].T @ static) / stiffness[RIGID:]
    unbalance = np.zeros(n, complex)
    for u in shaft.unbalances:
        unbalance += u.moment * np.exp(1j * u.angle) * found.shapes[2 * (u.node - 1)]
    stresses = recovery(shaft, found, [s.node for s in shaft.stations])
    per_load = 1.0 if acceleration else 0.0
    return Derived(
        modes=n,
        stations=len(shaft.stations),
        sensors=len(shaft.sensors),
        nodes=shaft.nodes,
        ends=len(stresses.node),
        unbalanced=int(np.any(unbalance != 0.0)),
        mass=shaft.mass,
        inertia=shaft.polar_inertia,
        damping_ratio=damping_ratio,
        inv_m=_room(np.sum(shape**2, axis=1), MOST_STATIONS),
        static_fy=_room(static, MOST_STATIONS),
        sag=_room(sag, MOST_MODES),
        stiffness=_room(stiffness, MOST_MODES),
        damping=_room(2.0 * damping_ratio * found.omega, MOST_MODES),
        weight=_room(weight, MOST_MODES),
        shape=_room(shape, MOST_STATIONS, MOST_MODES),
        sensor_shape=_room(sensed, MOST_STATIONS, MOST_MODES),
        slots=_room(slots, MOST_STATIONS),
        slot=_room(slot, MOST_STATIONS, MOST_MODES),
        lumped=_room(np.sum(slot >= 0, axis=1) > slots, MOST_STATIONS),
        polar=_room(found.gyroscopic, MOST_MODES, MOST_MODES),
        turn=_room(turned.T, MOST_MODES, MOST_MODES),
        principal=_room(principal, MOST_MODES),
        unbalance_x=_room(np.real(unbalance), MOST_MODES),
        unbalance_y=_room(np.imag(unbalance), MOST_MODES),
        position=_room(shaft.positions(), MOST_NODES),
        end_node=_room(stresses.node - 1, MOST_ENDS),
        bending=_room(stresses.bending, MOST_ENDS, MOST_MODES),
        shear=_room(stresses.shear, MOST_ENDS, MOST_MODES),
        bending_load=_room(per_load * stresses.bending_load, MOST_ENDS, MOST_STATIONS),
        shear_load=_room(per_load * stresses.shear_load, MOST_ENDS, MOST_STATIONS),
    )


def static_forces(shaft: Shaft, gravity: float) -> np.ndarray:
    """Vertical force (N) at each station that holds the rotor at rest, by those that levitate it.

    Two of them share the weight as levers do; more, by the smallest forces that balance it; none: zero.
    """
    force = np.zeros(len(shaft.stations))
    holding = [i for i, s in enumerate(shaft.stations) if s.name in shaft.levitated_at]
    if holding:
        arms = np.array([shaft.positions()[shaft.stations[i].node - 1] for i in holding])
        balance = np.vstack([np.ones(len(holding)), arms - shaft.centre_of_mass])
        force[holding] = np.linalg.lstsq(balance, [shaft.mass * gravity, 0.0], rcond=None)[0]
    return force


def _slots(shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many elastic modes each station tells of, and which place (from 0) each mode takes there.

    What is more than `MODES` is lumped in the last place; modes without a share there have none (-1).
    """
    gain = shape**2
    slot = np.full(shape.shape, -1.0)
    for row, mine in enumerate(gain):
        told = [k for k in range(RIGID, len(mine)) if mine[k] > NEGLIGIBLE * np.sum(mine)]
        for place, k in enumerate(told):
            slot[row, k] = min(place, MODES - 1)
    return slot.max(axis=1, initial=-1.0) + 1.0, slot


def _room(values: np.ndarray, *size: int) -> np.ndarray:
    """`values` at the beginning of a zero array of the given size."""
    found = np.zeros(size)
    found[tuple(slice(n) for n in values.shape)] = values
    return found
