"""Data that the modal rotor's kernels read: modes at its stations, gyroscopics, unbalance, stresses.

What depends on the number of modes is tabulated once for each shaft, outside the kernels; what else follows
from the parameters is derived by a kernel (`rotor.flexible`). Modal coordinates are mass-normalised and the
same in both planes; the polar matrix couples the planes (`rotor.motion`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...modelkit.ports import MODES
from ...modelkit.variables import array, group, integer, real
from ..beams.shaft import MAX_STATIONS, Shaft
from .modal_stresses import MAX_STRESS_NODES, recovery, watched_nodes
from .modes import MAX_SOLVED, RIGID_MODES, Basis, basis

MAX_MODES = MAX_SOLVED + MAX_STATIONS  # per plane, residual vectors included
MAX_ENDS = 2 * MAX_STRESS_NODES  # of elements
NEGLIGIBLE = 1e-9  # of a station's inv_m: a mode that has a node there


@dataclass(frozen=True)
class Gyroscopic:
    """The modal polar matrix G = Q diag(principal) Q^T, polar inertia per length (1)."""

    polar: np.ndarray = array(MAX_MODES, MAX_MODES)  # G (n, n)
    turn: np.ndarray = array(MAX_MODES, MAX_MODES)  # Q^T (n, n)
    principal: np.ndarray = array(MAX_MODES)  # (n,)


@dataclass(frozen=True)
class ModalUnbalance:
    """Unbalance of each mode in the rotor's frame (n,), kg^0.5 m."""

    present: int = integer(0, "whether there is any unbalance")
    x: np.ndarray = array(MAX_MODES)
    y: np.ndarray = array(MAX_MODES)


@dataclass(frozen=True)
class StressRows:
    """Stresses at the ends of the elements at watched nodes, R of them in use."""

    ends: int = integer(0, "of the elements, at watched nodes")
    node: np.ndarray = array(MAX_ENDS)  # (R,), counted from 1
    place: np.ndarray = array(MAX_ENDS)  # (R,), among the watched nodes, from 0
    bending: np.ndarray = array(MAX_MODES, MAX_ENDS)  # (n, R), Pa per modal coordinate
    shear: np.ndarray = array(MAX_MODES, MAX_ENDS)  # (n, R)
    bending_load: np.ndarray = array(MAX_STATIONS, MAX_ENDS)  # (S, R), Pa/N, of the modes left out
    shear_load: np.ndarray = array(MAX_STATIONS, MAX_ENDS)  # (S, R)


@dataclass(frozen=True)
class Derived:
    """Constants of the kernels: n modes, S stations, W watched nodes; what is in use comes first."""

    modes: int = integer(0, "per plane, the rigid ones and residual vectors included")
    stations: int = integer(0, "places that take a load")
    sensors: int = integer(0, "places that only tell their motion")
    nodes: int = integer(0, "of the finite elements")
    watched: int = integer(0, "nodes whose stresses are followed")
    most_modes: int = integer(0, "that can be kept")
    mass: float = real(0.0, "kg", "of the rotor")
    inertia: float = real(0.0, "kg.m2", "polar")
    own_damping_ratio: float = real(0.0, "1", "of the elastic modes, as the rotor's file says")
    damping_ratio: float = real(0.0, "1", "of the elastic modes; derived")
    position: np.ndarray = array(MAX_STRESS_NODES)  # of the watched nodes (W,), m
    stiffness: np.ndarray = array(MAX_MODES)  # omega^2 (n,), 1/s2
    damping: np.ndarray = array(MAX_MODES)  # 2 zeta omega (n,), 1/s; derived
    reach: np.ndarray = array(MAX_MODES)  # largest deflection (n,), 1/kg^0.5
    weight: np.ndarray = array(MAX_MODES)  # modal force of gravity (n,), per m/s2, upwards, kg^0.5
    sag: np.ndarray = array(MAX_MODES)  # vertical modal coordinates at the start (n,), m kg^0.5; derived
    shape: np.ndarray = array(MAX_STATIONS, MAX_MODES)  # at the stations (S, n), 1/kg^0.5
    tilt: np.ndarray = array(MAX_STATIONS, MAX_MODES)  # its slope there (S, n), 1/(m kg^0.5)
    sensor_shape: np.ndarray = array(MAX_STATIONS, MAX_MODES)  # at the sensors
    inv_m: np.ndarray = array(MAX_STATIONS)  # (S,), 1/kg
    inv_tilt: np.ndarray = array(MAX_STATIONS)  # (S,), 1/(kg m2), tilt acceleration per moment
    crossed: np.ndarray = array(MAX_STATIONS)  # (S,), 1/(kg m), tilt acceleration per force
    held: np.ndarray = array(MAX_STATIONS)  # (S,), kg, what of the mass a station holds at the start
    static_fy: np.ndarray = array(MAX_STATIONS)  # (S,), N, with which it does; derived
    slots: np.ndarray = array(MAX_STATIONS)  # modes told of at a station (S,)
    slot: np.ndarray = array(MAX_STATIONS, MAX_MODES)  # of a mode there (S, n), from 0; -1: none
    lumped: np.ndarray = array(MAX_STATIONS)  # whether the last slot holds more than one mode (S,)
    gyroscopic: Gyroscopic = group(Gyroscopic)
    unbalance: ModalUnbalance = group(ModalUnbalance)
    stress: StressRows = group(StressRows)


def seats(shaft: Shaft) -> list[int]:
    """Nodes (from 1) of the stations that do not levitate the rotor: those where it can touch down."""
    return [s.node for s in shaft.stations if s.name not in shaft.levitated_at]


@lru_cache(maxsize=16)
def tabulate(shaft: Shaft, modes: int, residual: int) -> Derived:
    """Data of the lowest `modes` (0: all), and of residual vectors where they are requested.

    What is to be derived is left at zero. Raises ModelError where there are not so many modes.
    """
    kept = basis(shaft, modes, tuple(dict.fromkeys(seats(shaft))) if residual else ())
    return Derived(
        modes=len(kept.omega),
        stations=len(shaft.stations),
        sensors=len(shaft.sensors),
        nodes=shaft.nodes,
        watched=len(watched_nodes(shaft)),
        most_modes=most_modes(shaft),
        mass=shaft.mass,
        inertia=shaft.polar_inertia,
        own_damping_ratio=shaft.damping_ratio,
        damping_ratio=0.0,
        position=_room(shaft.positions()[np.array(watched_nodes(shaft), int) - 1], MAX_STRESS_NODES),
        gyroscopic=_gyroscopic(kept),
        unbalance=_unbalance(shaft, kept),
        stress=_stress_rows(shaft, kept),
        **_of_modes(shaft, kept),
        **_of_stations(shaft, kept),
    )


def _of_modes(shaft: Shaft, kept: Basis) -> dict[str, np.ndarray]:
    """The part of `Derived` that describes each mode by itself."""
    weight = np.zeros(len(kept.omega))
    weight[0] = np.sqrt(shaft.mass)  # the translation's; to gravity all others are orthogonal
    return {
        "stiffness": _room(kept.omega**2, MAX_MODES),
        "reach": _room(np.max(np.abs(kept.shapes[::2]), axis=0), MAX_MODES),
        "weight": _room(weight, MAX_MODES),
    }


def _of_stations(shaft: Shaft, kept: Basis) -> dict[str, np.ndarray]:
    """The part of `Derived` that describes stations and sensors."""
    nodes = [s.node for s in shaft.stations]
    shape, tilt = kept.deflections(nodes), kept.slopes(nodes)
    slots, slot = _slots(shape)
    return {
        "shape": _room(shape, MAX_STATIONS, MAX_MODES),
        "sensor_shape": _room(kept.deflections([s.node for s in shaft.sensors]), MAX_STATIONS, MAX_MODES),
        "tilt": _room(tilt, MAX_STATIONS, MAX_MODES),
        "inv_m": _room(np.sum(shape**2, axis=1), MAX_STATIONS),
        "inv_tilt": _room(np.sum(tilt**2, axis=1), MAX_STATIONS),
        "crossed": _room(np.sum(shape * tilt, axis=1), MAX_STATIONS),
        "held": _room(held_masses(shaft), MAX_STATIONS),
        "slots": _room(slots, MAX_STATIONS),
        "slot": _room(slot, MAX_STATIONS, MAX_MODES),
        "lumped": _room(np.sum(slot >= 0, axis=1) > slots, MAX_STATIONS),
    }


def _gyroscopic(kept: Basis) -> Gyroscopic:
    principal, axes = np.linalg.eigh(kept.gyroscopic)
    return Gyroscopic(
        polar=_room(kept.gyroscopic, MAX_MODES, MAX_MODES),
        turn=_room(axes.T, MAX_MODES, MAX_MODES),
        principal=_room(principal, MAX_MODES),
    )


def _unbalance(shaft: Shaft, kept: Basis) -> ModalUnbalance:
    unbalance = np.zeros(len(kept.omega), complex)
    for u in shaft.unbalances:
        unbalance += u.moment * np.exp(1j * u.angle) * kept.shapes[2 * (u.node - 1)]
    return ModalUnbalance(
        present=int(np.any(unbalance != 0.0)),
        x=_room(np.real(unbalance), MAX_MODES),
        y=_room(np.imag(unbalance), MAX_MODES),
    )


def _stress_rows(shaft: Shaft, kept: Basis) -> StressRows:
    stresses = recovery(shaft, kept, [s.node for s in shaft.stations])
    place = {node: i for i, node in enumerate(watched_nodes(shaft))}
    rows = [i for i, node in enumerate(stresses.node) if node in place]
    return StressRows(
        ends=len(rows),
        node=_room(stresses.node[rows], MAX_ENDS),
        place=_room(np.array([place[node] for node in stresses.node[rows]]), MAX_ENDS),
        bending=_room(stresses.bending[rows].T, MAX_MODES, MAX_ENDS),
        shear=_room(stresses.shear[rows].T, MAX_MODES, MAX_ENDS),
        bending_load=_room(stresses.bending_load[rows].T, MAX_STATIONS, MAX_ENDS),
        shear_load=_room(stresses.shear_load[rows].T, MAX_STATIONS, MAX_ENDS),
    )


def most_modes(shaft: Shaft) -> int:
    """How many modes per plane can be kept: all, or `MAX_SOLVED`."""
    return min(shaft.coordinates, MAX_SOLVED)


def held_masses(shaft: Shaft) -> np.ndarray:
    """Mass (kg) that each station holds at the start, by those that levitate the rotor (S,).

    Two of them share the weight as levers do; more, by the smallest forces that balance it; none: zero.
    """
    held = np.zeros(len(shaft.stations))
    holding = [i for i, s in enumerate(shaft.stations) if s.name in shaft.levitated_at]
    if holding:
        arms = np.array([shaft.positions()[shaft.stations[i].node - 1] for i in holding])
        balance = np.vstack([np.ones(len(holding)), arms - shaft.centre_of_mass])
        held[holding] = np.linalg.lstsq(balance, [shaft.mass, 0.0], rcond=None)[0]
    return held


def _slots(shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many elastic modes each station tells of (S,), and which slot each mode takes there (S, n).

    shape: (S, n). Slots count from 0; what is more than `MODES` is lumped in the last one, and modes
    without a share there have none (-1).
    """
    gain = shape**2
    slot = np.full(shape.shape, -1.0)
    for row, mine in enumerate(gain):
        places = [k for k in range(RIGID_MODES, len(mine)) if mine[k] > NEGLIGIBLE * np.sum(mine)]
        for number, k in enumerate(places):
            slot[row, k] = min(number, MODES - 1)
    return slot.max(axis=1, initial=-1.0) + 1.0, slot


def _room(values: np.ndarray, *size: int) -> np.ndarray:
    """`values` at the beginning of a zero array of the given size."""
    room = np.zeros(size)
    room[tuple(slice(n) for n in values.shape)] = values
    return room
