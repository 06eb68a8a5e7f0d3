"""A scene's rotor as the magnetic bearings' linear plant, free of everything else.

Coordinates p of both planes, x then y (2n), mass-normalised:

    p'' + damping p' + Omega (gyroscopic coupling) p' + omega^2 p = acts^T f

The stators are taken as fixed in space.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.coupling.connections import Attachment
from ...master.coupling.simulation import opened
from ...master.coupling.system import System
from ...master.scene.scene import Scene
from ...rotor.modal.modes import Basis
from ..rotor.supports import rotor_model

RIGID = ("mass", "inertia")  # parameters of a rotor that is one mass in the plane
BENDS = 0.25  # strain energy of a bending mode over its kinetic energy, at least; a rigid mode has none


@dataclass(frozen=True)
class FreeRotor:
    """A rotor of one plane's modes, seen at some of its places."""

    omega: np.ndarray  # (n,), rad/s
    damping_ratio: float  # of the elastic modes
    gyroscopic: np.ndarray  # (n, n)
    speed: float  # rad/s, counter-clockwise
    acts: np.ndarray  # (k, n), 1/kg^0.5, where bearing k acts
    sees: np.ndarray  # (k, n), where its sensors are
    unbalance: np.ndarray  # (n,), kg^0.5 m, complex: in the plane across the shaft
    ports: Mapping[str, np.ndarray]  # (n,), 1/kg^0.5, of the rotor's ports

    @property
    def places(self) -> int:
        """Coordinates of both planes."""
        return 2 * len(self.omega)

    def rates(self, speed: float) -> np.ndarray:
        """Of (p, p') per (p, p') (4n, 4n) at a speed (rad/s)."""
        n = len(self.omega)
        a = np.zeros((4 * n, 4 * n))
        a[: 2 * n, 2 * n :] = np.eye(2 * n)
        a[2 * n :, : 2 * n] = -np.diag(np.tile(self.omega**2, 2))
        a[2 * n :, 2 * n :] = -np.diag(np.tile(2.0 * self.damping_ratio * self.omega, 2))
        turned = speed * self.gyroscopic
        a[2 * n : 3 * n, 3 * n :] -= turned
        a[3 * n :, 2 * n : 3 * n] += turned
        return a

    def bending(self, speed: float, highest: float) -> np.ndarray:
        """Poles (1/s) of the free rotor's bending modes, imaginary parts from 0 to `highest`, rising."""
        found: tuple[np.ndarray, np.ndarray] = np.linalg.eig(self.rates(speed))
        poles, vectors = found
        square = np.abs(vectors[: self.places]) ** 2
        strain = np.tile(self.omega**2, 2) @ square / np.maximum(np.abs(poles) ** 2, 1e-300)
        turns = np.imag(poles)
        bends = poles[(turns > 0.0) & (turns < highest) & (strain > BENDS * square.sum(axis=0))]
        return bends[np.argsort(np.imag(bends))]

    def turning(self, speed: float) -> np.ndarray:
        """Complex amplitudes of the unbalance's forces on the coordinates (2n,) at a speed (rad/s)."""
        return speed**2 * np.outer((1.0, -1j), self.unbalance).ravel()

    def along(self, shape: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Displacement along a direction (2,) per coordinate (2n,), of a place with `shape` (n,)."""
        return np.concatenate((direction[0] * shape, direction[1] * shape))


def free_rotor(scene: Scene, bearings: Sequence[str], sensing: Sequence[bool]) -> FreeRotor:
    """The rotor that `bearings` hold; sensing: whether each looks through its sensor, not at its journal.

    Raises TouchdownError where it is neither rigid nor of beam elements.
    """
    with opened(scene, in_process=True, listening=False) as system:
        held = _held(scene, system, bearings)
        body = held[0].body
        variables = system.components[body].variables
        if set(RIGID) <= variables.keys() and "modes" not in variables:
            tilts = f"{body}.transverse_inertia" in system and system.value(f"{body}.transverse_inertia")
            if tilts and system.value(f"{body}.amb_position"):
                raise TouchdownError(
                    f"{body}.transverse_inertia has it tilt under its magnetic bearing, at "
                    "amb_position, which its linear equations do not know; set one of them to 0"
                )
            root = np.sqrt(system.value(f"{body}.mass"))
            one = np.full((len(held), 1), 1.0 / root)
            speed, off = system.value(f"{body}.speed"), f"{body}.eccentricity"
            unbalance = np.array([root * (system.value(off) if off in system else 0.0)], complex)
            ports = {port: one[0] for port in _ports(scene, system, body)}
            return FreeRotor(np.zeros(1), 0.0, np.zeros((1, 1)), speed, one, one, unbalance, ports)
        stations = _ports(scene, system, body)
        factor = system.value(f"{body}.unbalance_scale") if f"{body}.unbalance_scale" in system else 1.0
    view = rotor_model(scene)
    basis: Basis = view.basis
    acts = basis.deflections([view.shaft.node(a.body_port) for a in held])
    looks = [
        next(iter(view.sensors[a.bearing].values()), a.body_port) if by_sensor else a.body_port
        for a, by_sensor in zip(held, sensing, strict=True)
    ]
    sees = basis.deflections([view.shaft.node(station) for station in looks])
    unbalance = factor * sum(
        (u.moment * np.exp(1j * u.angle) * basis.deflections([u.node])[0] for u in view.shaft.unbalances),
        np.zeros(len(basis.omega), complex),
    )
    ports = {port: basis.deflections([view.shaft.node(port)])[0] for port in stations}
    return FreeRotor(
        basis.omega, view.damping_ratio, basis.gyroscopic, view.speed, acts, sees, unbalance, ports
    )


def _ports(scene: Scene, system: System, body: str) -> list[str]:
    """Ports of a rotor at which bearings act and gaps are watched."""
    gaps = [gap.at.partition(".") for gap in scene.gaps]
    found = [a.body_port for a in system.attachments if a.body == body]
    return list(dict.fromkeys([*found, *(port for name, _, port in gaps if name == body)]))


def _held(scene: Scene, system: System, bearings: Sequence[str]) -> list[Attachment]:
    """Of each bearing, that on its journal."""
    found = [a for b in bearings for a in system.attachments if a.bearing == b and a.on_journal]
    if len(found) != len(bearings) or len({a.body for a in found}) != 1:
        raise TouchdownError(f"scene {scene.name}: its magnetic bearings must hold one rotor")
    return found
