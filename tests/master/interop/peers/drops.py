"""The drops that the peers run: from 2 ms of levitation to just after the first impact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from systems import AT, LEVITATED, dropped

from touchdown.master.coupling.simulation import Outcome, open_system, simulate
from touchdown.master.interop.ssp.write import write_ssp
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

STEP = 5e-6  # s


@dataclass(frozen=True)
class Error:
    """How far one run is from another."""

    journal: float  # um, largest of all journals at the end
    peak: float  # of the contact forces, largest relative difference
    impact: float  # us, largest difference of the first contacts' times


@dataclass(frozen=True)
class Fall:
    """A scene, and where in it a rotor touches down."""

    scene: Scene
    journals: tuple[str, ...]
    bearings: tuple[str, ...]

    @property
    def wanted(self) -> list[str]:
        """COMPONENT.VARIABLE of all that is compared."""
        motion = [f"{journal}.{axis}" for journal in self.journals for axis in "xy"]
        contacts = [f"{b}.contact.{what}" for b in self.bearings for what in ("peak_force", "first_time")]
        return motion + contacts

    @property
    def crossing(self) -> list[str]:
        """COMPONENT.VARIABLE of motion and loads at the bearings, which are connectors of a package."""
        motion = [f"{journal}.{axis}" for journal in self.journals for axis in "xy"]
        return motion + [f"{b}.journal.f{axis}" for b in self.bearings for axis in "xy"]

    def with_scheme(self, scheme: str) -> Scene:
        """The scene coupled by `scheme`."""
        return self.scene.set({"run.scheme": scheme})

    def package(self, scheme: str, folder: Path, native: bool = False) -> Path:
        """An SSP package for tools that connect outputs only."""
        path = folder / f"{self.scene.name}-{scheme}.ssp"
        return write_ssp(self.with_scheme(scheme), path, True, native).path

    def ours(self, in_process: bool = True, scheme: str | None = None) -> tuple[dict[str, float], Outcome]:
        """What the project's own master gives at the same macro step, by its default or another scheme."""
        scene = self.scene if scheme is None else self.with_scheme(scheme)
        system = open_system(scene, in_process)
        try:
            outcome = simulate(scene, system)
            return {name: system.value(name) for name in [*self.wanted, *self.crossing]}, outcome
        finally:
            system.close()

    def error(self, found: Mapping[str, float], exact: Mapping[str, float]) -> Error:
        """Of `found`."""

        def apart(name: str) -> float:
            return found[name] - exact[name]

        return Error(
            max(1e6 * math.hypot(apart(f"{j}.x"), apart(f"{j}.y")) for j in self.journals),
            max(
                abs(apart(f"{b}.contact.peak_force")) / exact[f"{b}.contact.peak_force"]
                for b in self.bearings
            ),
            max(1e6 * abs(apart(f"{b}.contact.first_time")) for b in self.bearings),
        )


def disk(levitated: float = LEVITATED) -> Fall:
    """The rigid disk on a simplified caged bearing, held for `levitated` (s): four FMUs."""
    settings = {"amb.shutdown_time": levitated, "run.duration": AT, "run.macro_step": STEP}
    return Fall(load_scene("disk-caged-simplified").set(settings), ("rotor.A",), ("bearing",))


def rotor(levitated: float = LEVITATED) -> Fall:
    """Rotor I, flexible, on two simplified caged bearings, held for `levitated` (s): seven FMUs."""
    scene = dropped().set({"run.macro_step": STEP})
    scene = scene.set({f"amb_{end}.shutdown_time": levitated for end in "AB"})
    return Fall(scene, ("rotor.A", "rotor.B"), ("bearing_A", "bearing_B"))


FALLS = {"disk": disk, "rotor I": rotor}
FREE = {"disk, free": partial(disk, 0.0), "rotor I, free": partial(rotor, 0.0)}  # never held
