"""Write a scene as an SSP 1.0 package: the FMUs, their parameters, and every single connection.

Connections are those the scheme lays out, between started FMUs, so that of a rotor's elastic modes only
those in use are there. Inputs carry their value at the start as start value, for tools that do not hand
constants such as `inv_m` over during initialisation; for those that cannot even connect them, as they are
no outputs, they are start values only. The project's own FMUs start from all these values by themselves,
for tools that set none. Equal scenes give equal bytes.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from xml.etree.ElementTree import indent

from touchdown.fmus.presentation.xml import document
from touchdown.master.common.archives import write_archive
from touchdown.master.coupling.loop.span import named_zero, span
from touchdown.master.coupling.simulation import opened
from touchdown.master.interop.packing import AS_IN_SCENE, Making, fixed, packed_fmus
from touchdown.master.interop.ssp.describe import Content, structure
from touchdown.master.interop.ssp.names import HEART, RESOURCES
from touchdown.master.scene.scene import Scene


@dataclass(frozen=True)
class Written:
    """What a package holds."""

    path: Path
    components: int
    connections: int
    fixed: tuple[str, ...]  # components whose FMUs do not start from the package's values


def write_package(
    scene: Scene, path: Path, outputs_only: bool = False, making: Making = AS_IN_SCENE
) -> Written:
    """Write `scene` to `path` (.ssp); an older one is replaced. Raises TouchdownError where it cannot.

    With `outputs_only` constants, which are calculated parameters, are not connected.
    """
    with (
        opened(scene, listening=False) as system,
        tempfile.TemporaryDirectory(prefix="touchdown_") as folder,
    ):
        times = span(scene.run, named_zero(scene, system))
        system.initialise()
        places = _places(packed_fmus(scene, system, making, Path(folder)))
        connected = [c for c in system.connections if not (outputs_only and system.constant(c))]
        sources = {name: place for name, (place, _) in places.items()}
        root = structure(Content(scene, system, connected, sources, times))
        fmus = dict(sorted(places.values()))
        written = Written(path, len(sources), len(connected), tuple(fixed(scene, system)))
    indent(root)
    write_archive(path, {HEART: document(root), **fmus})
    return written


def _places(paths: Mapping[str, Path]) -> dict[str, tuple[str, bytes]]:
    """By component: its FMU's place in the package, and the FMU. Equal FMUs are packed once."""
    contents = {name: path.read_bytes() for name, path in paths.items()}
    places: dict[bytes, str] = {}
    for component, path in paths.items():
        content = contents[component]
        names = (f"{RESOURCES}/{path.stem}{f'_{n}' if n > 1 else ''}.fmu" for n in count(1))
        if content not in places:
            places[content] = next(name for name in names if name not in places.values())
    return {name: (places[content], content) for name, content in contents.items()}
