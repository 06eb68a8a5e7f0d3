"""A flexible rotor for Python, alone and in bearings."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.files import keep_other, writing_to
from ...master.common.text import RPM
from ...master.scene.scene import Scene
from ...modelkit.kernel.cache_folder import made_in_cache, put_file
from ...modelkit.kernel.writing import read_own, write
from ...modelkit.model import ModelError
from ...rotor.beams.shaft import Shaft
from ...rotor.file import rotor_text
from ...rotor.modal.modes import fullest
from ...rotor.modal.supported import log_decrements
from ...rotor.modal.whirl_speeds import HeldModes, critical_speeds
from ...rotor.properties import RotorProperties
from ...studies.rotor.rotor_report import (
    MODES,
    SPEED,
    described,
    find_rotor,
    on_supports,
    report_text,
    supported,
)
from ...studies.rotor.scene_report import described_in, scene_text, title_of
from ..parameters import PathLike
from .run import as_scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase


class InBearings:
    """Modes of a rotor in bearings at a speed (M), by their size, without those that hardly swing."""

    def __init__(self, held: HeldModes, title: str) -> None:
        self.title, self._held = title, held
        self.roots: np.ndarray = held.modes.roots[held.swinging]
        """Complex eigenvalues (M,), 1/s, imaginary part positive."""
        self.senses: np.ndarray = held.modes.sense[held.swinging]
        """1 circular whirl with the spin, -1 against it, 0 in a plane (M,)."""
        self.stable: bool = held.modes.stable
        """Whether nothing grows."""

    @property
    def speed(self) -> float:
        """Spin speed (rad/s)."""
        return self._held.speed

    @property
    def frequencies(self) -> np.ndarray:
        """Damped (M,), Hz."""
        return self._held.modes.frequencies[self._held.swinging]

    @property
    def damping_ratios(self) -> np.ndarray:
        """Of critical damping (M,); below 0 a mode grows."""
        return self._held.modes.damping_ratios[self._held.swinging]

    @property
    def log_decrements(self) -> np.ndarray:
        """Logarithmic decrements (M,)."""
        return log_decrements(self.roots)

    @property
    def critical_speeds(self) -> np.ndarray:
        """Damped, of all whirls up to the end of the diagram, ascending (C,), rad/s."""
        return np.array([one.speed for one in self._held.lines.crossings])

    def campbell(self, figure: FigureBase | None = None) -> list[Axes]:
        """Damped whirl frequencies [Hz] over speed [rpm], above their damping ratios [1].

        On a figure or a part of one; without, pyplot makes one. Returns its axes.
        """
        from ...reports.figures.style import drawable
        from ...studies.rotor.figure import held_campbell

        return held_campbell(drawable(figure), self._held, self.title)

    def __repr__(self) -> str:
        verdict = "stable" if self.stable else "unstable"
        lowest = ", ".join(f"{f:.1f}" for f in self.frequencies[:4])
        return f"<{self.title} at {RPM * self.speed:.5g} rpm: {verdict}, {lowest} ... Hz>"


class InScene:
    """The rotor of a scene: `levitated` and `resting`, each None where nothing holds it so."""

    def __init__(
        self, levitated: InBearings | None, resting: InBearings | None, report: Callable[[], str]
    ) -> None:
        self.levitated, self.resting, self._report = levitated, resting, report

    def report(self) -> str:
        """All figures as a table, with what its bearings are."""
        return self._report()

    def __repr__(self) -> str:
        return f"<{self.levitated}, {self.resting}>"


@dataclass(frozen=True, repr=False)
class Rotor(Shaft):
    """A flexible rotor: beam elements in their order, and what sits at the nodes between them.

    Nodes count from 1. Stations are the nodes that bearings hold; those in `levitated_at` carry the rotor
    before it drops. Lengths in m, all in SI. A scene takes it in place of an FMU, if it has the stations
    and sensors that the scene attaches to, by name.

    >>> shaft = touchdown.Element(
    ...     length=0.1, outer_diameter=0.04, modulus=207e9, density=7830.0, poisson=0.3
    ... )
    >>> def stations(**nodes):
    ...     return [touchdown.Station(name, node) for name, node in nodes.items()]
    >>> rotor = touchdown.Rotor(
    ...     "Plain shaft",
    ...     8 * (shaft,),
    ...     stations=stations(A=1, B=9, amb_A=3, amb_B=7),
    ...     sensors=stations(sensor_A=3, sensor_B=7),
    ...     levitated_at=["amb_A", "amb_B"],
    ... )
    >>> rotor.frequencies(modes=3).round(1)  # Hz; translation and tilt come first
    array([  0. ,   0. , 284.2])
    >>> print(rotor.report(modes=3))
    Plain shaft
      mass                    7.8716 kg
    ...
    >>> rotor == touchdown.Rotor.load(rotor.save("plain.toml"))
    True
    >>> scene = touchdown.load("rotor1-9000").swap(rotor=rotor)
    """

    def __post_init__(self) -> None:
        for part in ("elements", "points", "unbalances", "stations", "sensors", "levitated_at", "supports"):
            object.__setattr__(self, part, tuple(getattr(self, part)))

    @classmethod
    def load(cls, name_or_path: PathLike) -> Rotor:
        """A rotor of the project's by name, or the one in a file (.toml).

        Raises TouchdownError where there is no such rotor, or its file has a mistake.
        """
        return cls.of(find_rotor(os.fspath(name_or_path)))

    @classmethod
    def of(cls, shaft: Shaft) -> Rotor:
        """A shaft as a rotor."""
        return cls(**{field.name: getattr(shaft, field.name) for field in fields(shaft)})

    def frequencies(self, modes: int = MODES) -> np.ndarray:
        """Of the free rotor at rest, in one plane (Hz, ascending); translation and tilt have 0 Hz.

        modes: how many, those two included (0: all). Raises TouchdownError where there are not so many.
        """
        return described(self, SPEED, modes).frequencies

    def critical_speeds(self, supports: Mapping[str, float] | None = None) -> np.ndarray:
        """Undamped, ascending (rad/s): those of the forward whirl, or all where the planes differ.

        supports: stiffness in N/m of stations by name, beside its own `supports`. Raises TouchdownError
        where it is not held at two nodes or more.

        >>> rotor = touchdown.Rotor.load("rotor_II")
        >>> rotor.critical_speeds({"amb_A": 20e6, "amb_B": 20e6})[:3].round(1)
        array([ 611.1,  733.7, 4456.2])
        """
        shaft = supported(self, supports or {})
        if len({s.node for s in shaft.supports if s.stiffness > 0.0}) < 2:
            raise TouchdownError(f"critical speeds need supports at two nodes of {self.title} or more")
        held_at = list(dict.fromkeys(s.node for s in shaft.supports))
        return critical_speeds(fullest(shaft, held_at), shaft.supports)

    def in_bearings(self, speed: float = SPEED, supports: Mapping[str, float] | None = None) -> InBearings:
        """Its damped modes at `speed` (rad/s) on its own `supports`, and over speeds to twice as much.

        supports: stiffness in N/m of stations by name, beside its own. Raises TouchdownError where there is
        none.

        >>> rotor = touchdown.Rotor.load("rotor_II")
        >>> held = rotor.in_bearings(1000.0, {"amb_A": 20e6, "amb_B": 20e6})
        >>> held.frequencies[:4].round(1)  # Hz
        array([ 96.6,  97.3, 102.7, 119.2])
        """
        shaft = supported(self, supports or {})
        properties = described(shaft, speed, MODES)
        if properties.held is None:
            raise TouchdownError(f"{self.title} has no supports to be held by; give some")
        return InBearings(properties.held, f"{self.title} {on_supports(properties)}")

    @staticmethod
    def in_scene(scene: PathLike | Scene, speed: float | None = None, load: float = 1.0) -> InScene:
        """The rotor of a scene in its bearings: levitated, and resting on its touchdown bearings.

        speed: rad/s, counter-clockwise, the scene's own where it is not given; load: what presses the
        rotor on its touchdown bearings, over its weight. Raises TouchdownError where the scene has no
        rotor of elements, or nothing holds it.

        >>> found = touchdown.Rotor.in_scene("rotor1-9000")
        >>> found.levitated.stable
        True
        >>> found.levitated.frequencies[:4].round(1)  # Hz
        array([48.2, 51.1, 57.2, 63.3])
        """
        found = described_in(as_scene(scene), speed, MODES, load)
        held = {one.name: InBearings(one.held, title_of(found, one)) for one in found.support_conditions}
        return InScene(held.get("levitated"), held.get("resting"), lambda: scene_text(found))

    def whirl(self, speed: float, modes: int = MODES) -> tuple[np.ndarray, np.ndarray]:
        """Of the free rotor at `speed` (rad/s): whirl against the spin, and with it, by mode (Hz).

        Raises TouchdownError where there are not so many modes.
        """
        properties = described(self, speed, modes)
        return properties.backward[0], properties.forward[0]

    @property
    def plot(self) -> RotorPlot:
        """Pictures: `plot.modes()`, `.campbell()`, `.critical()`, `.rest()`; each returns its axes."""
        return RotorPlot(lambda: described(self, SPEED, MODES))

    def save(self, path: PathLike, force: bool = True) -> Path:
        """Write it as a rotor file (.toml); returns the path. A file that is there is replaced.

        force=False: not one that holds something else. Raises TouchdownError for that, for what such a
        file cannot hold, and where it cannot be written.
        """
        text, path = self._text(), Path(path)
        if not force:
            keep_other(path, text, "file")
        with writing_to(path.parent):
            return write(path, text)

    def __fspath__(self) -> str:
        """A file of it in the cache: what a scene takes."""
        text = self._text()
        digest = hashlib.sha256(text.encode()).hexdigest()[:16]
        name = re.sub(r"\W+", "_", self.title, flags=re.ASCII).strip("_").lower() or "rotor"
        try:
            path = made_in_cache(
                lambda folder: _written(folder / f"{name}_{digest}.toml", text.encode()), "rotors"
            )
        except OSError as error:
            raise TouchdownError(f"cannot write {name}.toml: {error.strerror or error}") from None
        return str(path)

    def _text(self) -> str:
        """As a rotor file."""
        plain = Shaft(**{field.name: getattr(self, field.name) for field in fields(Shaft)})
        try:
            return rotor_text(plain, f"rotor {self.title}")
        except ModelError as error:
            raise TouchdownError(str(error)) from None

    def report(self, speed: float = SPEED, modes: int = MODES) -> str:
        """All its figures as a table: inertias, places, frequencies, how it lies on its seats.

        speed: rad/s, for the split of the frequencies; modes: per plane, the two rigid ones included (0:
        all). Raises TouchdownError where there are not so many.
        """
        return report_text(described(self, speed, modes))

    def __repr__(self) -> str:
        called = {node: f" (called {name})" for node, name in enumerate(self.called, start=1)}
        stations = ", ".join(f"{s.name} at node {s.node}{called.get(s.node, '')}" for s in self.stations)
        made_of = f"{len(self.elements)} elements" if self.elements else self.body.kind
        return (
            f"<Rotor {self.title}: {made_of}, {self.nodes} nodes, {self.mass:.5g} kg, "
            f"{self.positions()[-1]:.5g} m, stations: {stations or 'none'}>"
        )


def _written(path: Path, content: bytes) -> Path:
    """The file at `path`, written where it does not hold `content`."""
    try:
        same = read_own(path) == content
    except OSError:
        same = False
    if not same:
        put_file(path, content)
    return path


class RotorPlot:
    """Pictures of a rotor, drawn on a figure or a part of one; without, pyplot makes one."""

    def __init__(self, properties: Callable[[], RotorProperties]) -> None:
        self._properties = properties

    def modes(self, figure: FigureBase | None = None) -> list[Axes]:
        """Shapes of the rigid and the first bending modes over the rotor's side view, to scale."""
        from ...reports.figures.style import drawable
        from ...studies.rotor.figure import modes

        return modes(drawable(figure), self._properties())

    def campbell(self, figure: FigureBase | None = None) -> list[Axes]:
        """Whirl frequencies of the free rotor [Hz] over speed [rpm]."""
        from ...reports.figures.style import drawable
        from ...studies.rotor.figure import campbell

        return campbell(drawable(figure), self._properties())

    def critical(self, figure: FigureBase | None = None) -> list[Axes]:
        """Undamped critical speeds [rpm] over the stiffness of its supports [N/m], its own ones marked.

        Raises TouchdownError where no two nodes hold it.
        """
        from ...reports.figures.style import drawable
        from ...studies.rotor.figure import critical

        properties = self._properties()
        if not properties.critical:
            raise TouchdownError("this picture needs stations at two nodes or more, to hold the rotor")
        return critical(drawable(figure), properties)

    def rest(self, figure: FigureBase | None = None) -> list[Axes]:
        """How it lies on its seats: deflection [µm] and bending stress [MPa].

        Raises TouchdownError where it has less than two to lie on.
        """
        from ...reports.figures.style import drawable
        from ...studies.rotor.figure import draw_rest
        from ...studies.rotor.rotor_report import TO_REST

        properties = self._properties()
        if properties.rest is None:
            raise TouchdownError(f"this picture {TO_REST}")
        return draw_rest(drawable(figure), properties)
