"""A scene as one FMU, for tools that take only one: a container of the scene's FMUs.

The container's runtime is native code that steps the FMUs inside at the scene's macro step, one after the
other in the order of the scene's Gauss-Seidel schemes, or all at once for Jacobi schemes. Constants are not
linked but set, since a container links outputs only; with them all parameters are fixed in the container.

Each FMU inside starts from the values that its component has in the scene (`packed_fmus`, which packages
use as well). Not every tool reads a package's values; one that sets nothing then runs the same drop.
"""

from __future__ import annotations

import hashlib
import logging
import re
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import fromstring, tostring

from ...fmus.presentation.terminals import document
from ...fmus.recipes import Recipe
from ...fmus.version import RELEASED
from ...modelkit.variables import Causality
from ..common.archives import write_archive
from ..common.errors import TouchdownError
from ..components.component import READABLE, Component, Kind
from ..components.fmu import ArchivedFmu
from ..components.loading import built, locate
from ..coupling.loop.span import named_zero, span
from ..coupling.simulation import opened
from ..coupling.system import System
from ..scene.scene import Scene, amended


def start_values(system: System, name: str) -> dict[str, float]:
    """Start values of a component of an initialised system (SI, by the scene's names), integers as such.

    Its settings, and what its connected inputs hold at the start.
    """
    component = system.components[name]
    starts: dict[str, float] = {
        variable: value if component.variable(variable).kind is Kind.REAL else int(value)
        for (owner, variable), value in system.settings.items()
        if owner == name
    }
    fed = [c.input for c in system.connections if c.target == name]
    return starts | dict(zip(fed, component.read(fed), strict=True))


def packed_fmus(scene: Scene, system: System, native: bool) -> dict[str, Path]:
    """By component of an initialised system, the FMU for a package.

    Those of the project's own start from `start_values`, and with `native` all of them are native, not only
    those that are in the scene. FMUs that are given as files stay as they are, and tools that set nothing
    start them from their own. Raises TouchdownError where one cannot be made.
    """
    paths: dict[str, Path] = {}
    for name, component in system.components.items():
        assert isinstance(component, ArchivedFmu)
        if component.description.fmiVersion != "2.0":
            raise TouchdownError(
                f"component {name} is FMI {component.description.fmiVersion}; SSP 1.0 packages and "
                "containers hold FMI 2.0 only"
            )
        spec = scene.components[name]
        source = locate(spec.fmu, scene.folder)
        if isinstance(source, Recipe):
            started = source.starting_from(_by_own_names(component, start_values(system, name)))
            paths[name] = built(started, native or spec.native)
        else:
            paths[name] = component.path
    return paths


def fixed(scene: Scene, system: System) -> list[str]:
    """Components with values that are in no FMU, since theirs are given as files."""
    return [
        name
        for name, spec in scene.components.items()
        if not isinstance(locate(spec.fmu, scene.folder), Recipe) and start_values(system, name)
    ]


def changes(scene: Scene, system: System) -> list[str]:
    """The settings of the user beside the scene, for people, with units."""
    return scene.changes(lambda component, key: system.components[component].variable(key).unit)


def _by_own_names(component: Component, values: Mapping[str, float]) -> dict[str, float]:
    return {component.own_name(variable): value for variable, value in values.items()}


SEQUENTIAL = {"gauss-seidel": True, "jacobi": False}  # how a container steps, by a scheme's sequence
DESCRIPTION = "modelDescription.xml"


def write_container(scene: Scene, path: Path, native: bool = False) -> Path:
    """Write `scene` to `path` (.fmu); returns it. Raises TouchdownError where it cannot."""
    sequence = scene.run.scheme.sequence
    if sequence not in SEQUENTIAL:
        raise TouchdownError(
            f"a container cannot step as scheme {scene.run.scheme.name} does; take interface or jacobi-lead"
        )
    toolbox = _toolbox()
    with (
        opened(scene, listening=False) as system,
        tempfile.TemporaryDirectory(prefix="touchdown_") as folder,
    ):
        _refuse_what_it_cannot(system)
        times = span(scene.run, named_zero(scene, system))
        system.initialise()
        fmus = packed_fmus(scene, system, native)
        about = amended(scene.title, changes(scene, system))
        try:
            container = toolbox.FMUContainer(re.sub(r"\W", "_", path.stem, flags=re.ASCII), folder)
            container.start_time, container.stop_time = times.start, times.end
            _fill(container, system, fmus, SEQUENTIAL[sequence])
            container.make_fmu("made.fmu", scene.run.macro_step, sequential=SEQUENTIAL[sequence])
        except toolbox.FMUContainerError as error:
            raise TouchdownError(f"cannot make a container of {scene.name}: {error}") from None
        with zipfile.ZipFile(Path(folder) / "made.fmu") as archive:
            content = {name: archive.read(name) for name in sorted(archive.namelist())}
    write_archive(path, {**content, DESCRIPTION: _mended(content, about)})
    return path


def _toolbox() -> Any:
    try:
        from fmu_manipulation_toolbox import container
    except ImportError:
        raise TouchdownError(
            "a container needs fmu-manipulation-toolbox; install touchdown-cosim with its extra `container`"
        ) from None
    logging.getLogger("fmu_manipulation_toolbox").setLevel(logging.CRITICAL)
    return container


def _refuse_what_it_cannot(system: System) -> None:
    for name, every in system.every.items():
        if every != 1:
            raise TouchdownError(f"a container has one macro step; remove `every` of component {name}")
        if name in system.periods:
            raise TouchdownError(f"a container has one macro step; remove `sampled` of component {name}")
    for c in system.connections:
        if c.scale:
            raise TouchdownError(
                f"a container cannot scale the connection {c.source}.{c.output} to {c.target}.{c.input}"
            )


def _fill(container: Any, system: System, fmus: Mapping[str, Path], sequential: bool) -> None:
    """Put in the FMUs, their values, what links them, and what else they give (locals outside arrays).

    One after the other, bearings go first. All at once, the bodies do: a loop of links is initialised
    from what goes first, and bearings need the bodies' motion.
    """
    for name in system.order if sequential else reversed(system.order):
        container.get_fmu(str(fmus[name].absolute()), f"{name}.fmu")
    linked: set[tuple[str, str]] = set()
    for c in system.connections:
        source, target = system.components[c.source], system.components[c.target]
        if not source.variable(c.output).constant:
            ends = (c.source, source.own_name(c.output)), (c.target, target.own_name(c.input))
            container.add_link(*(part for name, end in ends for part in (f"{name}.fmu", end)))
            linked.add((c.source, c.output))
    for name, component in system.components.items():
        for variable, value in start_values(system, name).items():
            container.add_start_value(f"{name}.fmu", component.own_name(variable), repr(value))
        for variable in component.variables.values():
            given = variable.causality is Causality.OUTPUT
            given = given or (variable.causality is Causality.LOCAL and "[" not in variable.name)
            if given and variable.kind in READABLE and (name, variable.name) not in linked:
                own = component.own_name(variable.name)
                container.add_output(f"{name}.fmu", own, f"{name}.{own}")


def _mended(content: Mapping[str, bytes], about: str) -> bytes:
    """The container's description, without the time, the user and the random identity of its making.

    It says what it is: `about`. What it lists as outputs are outputs; the toolbox leaves locals among them.
    """
    root = fromstring(content[DESCRIPTION])
    variables = root.findall("ModelVariables/ScalarVariable")
    for output in root.findall("ModelStructure/Outputs/Unknown"):
        variables[int(output.get("index", "0")) - 1].set("causality", "output")
    root.set("generationDateAndTime", RELEASED)
    root.set("author", "touchdown-cosim")
    root.set("description", about)
    root.set("guid", "")
    digest = hashlib.sha256(tostring(root))
    for name, data in content.items():
        if name != DESCRIPTION:
            digest.update(name.encode() + data)
    root.set("guid", digest.hexdigest()[:32])
    return document(root)
