"""How to run it again: the command, the scene as a file, the versions."""

from __future__ import annotations

import base64
import json
import platform
import shlex
from importlib import metadata
from pathlib import Path

from touchdown.fmus.version import VERSION
from touchdown.master.report.facts.subject import Subject
from touchdown.master.report.page.blocks import Block, Code, Download, Lacking, Table, Text
from touchdown.master.scene.file import SCENE_FILE, shipped
from touchdown.master.scene.scene import ComponentSpec, Scene

LIBRARIES = ("numba", "numpy", "scipy", "fmpy", "matplotlib")


def repeat(subject: Subject) -> list[Block]:
    """Command, scene, versions."""
    scene = subject.result.scene
    blocks: list[Block] = []
    command = command_of(scene)
    if command is None:
        blocks.append(
            Lacking("The command with the scene's own file", "the scene was made in Python, or renamed.")
        )
    else:
        blocks += [Text("From the scene's file, with what was set for this run:"), Code(command)]
    text = json.dumps(scene.resolved(), indent=2, default=str) + "\n"
    blocks += [
        Text("Or from the scene as it was run, whatever becomes of that file:"),
        Code(f"touchdown run {shlex.quote(f'{scene.name}.scene.json')} -o runs/again"),
        Download(
            f"{scene.name}.scene.json",
            "The scene as it was run",
            "application/json",
            base64.b64encode(text.encode()).decode("ascii"),
        ),
        _versions(subject),
    ]
    return blocks


def command_of(scene: Scene) -> str | None:
    """The `touchdown run` that runs the scene again; None where it is of no file."""
    name = _source(scene)
    if name is None:
        return None
    words = ["touchdown", "run", name]
    for component, spec in scene.components.items():
        if spec.instead_of:
            words += ["--swap", f"{component}={spec.fmu}"]
    for key in scene.own:
        words += ["--set", f"run.{key}={_value(scene.resolved()['run'], key)}"]
    for component, spec in scene.components.items():
        for key, value in (("every", spec.every), ("isolate", spec.isolate), ("native", spec.native)):
            if value != getattr(ComponentSpec, key):  # said again where the scene's file says it, too
                words += ["--set", f"{component}.{key}={str(value).lower()}"]
        for variable, value in spec.set_beside.items():
            words += ["--set", f"{component}.{variable}={value}"]
    return shlex.join(words)


def _value(run: object, key: str) -> object:
    assert isinstance(run, dict)
    value = run[key]
    return ",".join(value) if isinstance(value, (tuple, list)) else value


def _source(scene: Scene) -> str | None:
    """What names the scene in a command."""
    own = scene.folder / f"{scene.name}.toml"
    if own.is_file():
        return scene.name if own.resolve() == shipped().get(scene.name, Path()).resolve() else str(own)
    is_machine = scene.folder.resolve().name == scene.name and (scene.folder / SCENE_FILE).is_file()
    return str(scene.folder) if is_machine else None


def _versions(subject: Subject) -> Table:
    ran = str(subject.run.recording.about().get("version", "not recorded"))
    rows = [["touchdown-cosim, of the run", ran], ["touchdown-cosim, of this report", VERSION]]
    rows.append(["Python, of this report", platform.python_version()])
    rows += [[f"{name}, of this report", metadata.version(name)] for name in LIBRARIES]
    return Table("Versions", ["What", "Version"], rows)
