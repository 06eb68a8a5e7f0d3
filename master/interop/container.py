"""A scene as one FMU, for tools that take only one: a container of fmu-manipulation-toolbox.

Its runtime is native code that steps the FMUs inside at the scene's macro step, one after the other in
the order of the scene's Gauss-Seidel schemes, or all at once for Jacobi schemes. Constants are not linked
but set, since a container links outputs only; with them all parameters are fixed in the container.
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

from touchdown.fmus.presentation.xml import document
from touchdown.fmus.version import RELEASED
from touchdown.master.common.archives import write_archive
from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.component import READABLE
from touchdown.master.coupling.loop.span import named_zero, span
from touchdown.master.coupling.simulation import opened
from touchdown.master.coupling.system import System
from touchdown.master.interop.packing import AS_IN_SCENE, Making, changes, packed_fmus, start_values
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.titles import amended
from touchdown.modelkit.variables import Causality

SEQUENTIAL = {"gauss-seidel": True, "jacobi": False}  # how a container steps, by a scheme's sequence
DESCRIPTION = "modelDescription.xml"


def write_container(scene: Scene, path: Path, making: Making = AS_IN_SCENE) -> Path:
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
        fmus = packed_fmus(scene, system, making, Path(folder) / "inside")
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
