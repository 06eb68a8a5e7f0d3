"""Members of a sweep that a folder has already, recognised by what was run, not by their number.

A finished member leaves the identity of its run in member.json. A sweep that is started again, after a
kill or with other values, takes over those it asks for; those it does not ask for stay, under numbers that
are free.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Mapping
from dataclasses import asdict
from itertools import count
from pathlib import Path
from typing import Any, cast

from touchdown.fmus.version import VERSION
from touchdown.master.common.files import replace_text
from touchdown.master.components.library.sources import locate
from touchdown.master.results.folder import MARK, SUMMARY
from touchdown.master.results.result import RECORDING
from touchdown.master.scene.scene import Scene

UNSAID = ("title", "about", "folder")  # of a scene: they change no number


def origins(scene: Scene) -> dict[str, str]:
    """By component: a hash over what it is made of, a file's content or the project's own sources."""
    found: dict[str, str] = {}
    for name, spec in scene.components.items():
        source = locate(spec.fmu, scene.folder)
        if isinstance(source, Path):
            content = source.read_bytes() if source.is_file() else b""
            found[name] = hashlib.sha256(content).hexdigest()
        else:
            found[name] = source.content
    return found


def identity(scene: Scene, made_of: Mapping[str, str], in_process: bool) -> str:
    """What a run of `scene` is known by: a hash over version, settings, scheme and `origins`."""
    said = {key: value for key, value in scene.resolved().items() if key not in UNSAID}
    whole = [VERSION, said, asdict(scene.run.scheme), dict(made_of), in_process]
    return hashlib.sha256(json.dumps(whole, default=str).encode()).hexdigest()


def finish(folder: Path, own: str) -> None:
    """The member in `folder`, whose run is known as `own`, is finished."""
    replace_text(folder / MARK, json.dumps({"run": own}) + "\n")


def settle(folder: Path, wanted: Mapping[str, Path]) -> None:
    """Move finished members to where they are wanted, by identity, and others out of the way.

    A kill on the way loses none: what has left its place and not reached another is found, too.
    """
    there = _finished(folder)
    moving: dict[str, Path] = {}
    for own, place in there.items():
        if place != wanted.get(own):
            moving[own] = place.rename(folder / f".{own}")
    taken = {path.name for path in (*wanted.values(), *there.values())}
    width = max((len(path.name) for path in wanted.values()), default=3)
    names = (f"{n:0{width}}" for n in count(1))
    free = (folder / name for name in names if name not in taken and not (folder / name).exists())
    for own, place in moving.items():
        target = wanted[own] if own in wanted else next(free)
        if target.exists():  # it is of no finished member
            shutil.rmtree(target)
        place.rename(target)


def _finished(folder: Path) -> dict[str, Path]:
    """Folders of finished members by identity: numbered, or on their way to a number."""
    found: dict[str, Path] = {}
    for mark in sorted(folder.glob(f"*/{MARK}")):
        own = _read(mark).get("run")
        if isinstance(own, str) and (mark.parent.name.isdigit() or mark.parent.name == f".{own}"):
            found[own] = mark.parent
    return found


def finished(folder: Path, own: str, recorded: bool) -> Mapping[str, object] | None:
    """Summary of the finished member in `folder`; None where it is another, or lacks a wanted recording."""
    if _read(folder / MARK).get("run") != own or (recorded and not (folder / RECORDING).is_file()):
        return None
    return _read(folder / SUMMARY) or None


def _read(path: Path) -> dict[str, Any]:
    """The table in a JSON file; empty where there is none that can be read."""
    try:
        given = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return cast(dict[str, Any], given) if isinstance(given, dict) else {}
