"""Compilation of a scene's kernels before it runs, in processes beside each other.

The models of a scene are compiled one after the other where they are stepped: numba compiles nothing beside
something else in one process. Here each of several processes, this one among them, takes one model after
the other, the largest first, and what the others compile is in the cache for this one.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from multiprocessing import parent_process
from pathlib import Path
from threading import Thread
from typing import Any

from ...fmus.python.packed_sources import package_name
from ...fmus.recipes import Recipe
from ...modelkit.kernel.machine_code import PACKAGE, is_kept
from ...modelkit.variables import SWITCH
from ..common.errors import TouchdownError
from ..common.pool import cores, die_with_parent, start_module
from ..scene.scene import Scene
from .loading import Stepping, load_component, locate_fmu

_STEP = 1e-6  # s
OFF = ("0", "0.0", "False", SWITCH.words[0])  # of an effect, as scenes may have it


@dataclass(frozen=True)
class NewModel:
    """A model that was not compiled yet."""

    title: str
    fmu: str
    folder: str  # absolute, in which the fmu's path begins
    in_process: bool
    size: int  # bytes of its memory
    effects: Sequence[str] = ()  # that act (`Model.effects`): each set of them has its kernel


def new_models(scenes: Iterable[Scene], in_process: bool) -> list[NewModel]:
    """The models of scenes without code in the cache, one of each kind, the largest first.

    Empty in a process that runs beside others: the process that starts them compiles for all.
    """
    if parent_process() is not None:
        return []
    return sorted(_new(scenes, in_process), key=lambda model: -model.size)


def compile_beside(
    models: Sequence[NewModel], say: Callable[[str], object], stop: Callable[[], bool] = bool
) -> None:
    """Compile models, one at a time on each processor; a model that fails here fails again where it is run.

    say(what is compiled, and why) is called once, where two models and two processors are there.
    stop(): whether to begin no further model.
    """
    workers = min(cores(), len(models))
    if workers < 2:
        return
    say(f"compiling {', '.join(model.title for model in models)}: new here, and kept for later runs")
    left = iter(models)
    threads = [Thread(target=_have_compiled, args=(left,), daemon=True) for _ in range(workers - 1)]
    for thread in threads:
        thread.start()
    while not stop() and (model := next(left, None)):
        _compile(model)
    for thread in threads:
        thread.join()


def _new(scenes: Iterable[Scene], in_process: bool) -> Iterable[NewModel]:
    taken: set[tuple[str, str]] = set()
    specs = ((scene.folder, spec) for scene in scenes for spec in scene.components.values())
    for folder, spec in specs:
        with suppress(TouchdownError):  # loading reports the error
            source = locate_fmu(spec.fmu, folder)
            if not isinstance(source, Recipe) or spec.native:
                continue
            model, settings = source.model, {**spec.inherited, **spec.set}
            effects = [name for name in model.effects if str(settings.get(name, 0)) not in OFF]
            advance: Any = model.advance_with(effects)
            kind = advance.py_func.__module__, advance.py_func.__qualname__
            if kind in taken:
                continue
            taken.add(kind)
            if not is_kept(advance, PACKAGE if in_process else package_name()):
                place, size = str(folder.absolute()), model.memory.itemsize
                yield NewModel(source.name, spec.fmu, place, in_process, size, effects)


def _have_compiled(models: Iterable[NewModel]) -> None:
    """Hand models to another process, one after the other, until all are compiled or the process ends."""
    pipe, nowhere = subprocess.PIPE, subprocess.DEVNULL
    running = start_module(__name__, os.getpid(), text=True, stdin=pipe, stdout=pipe, stderr=nowhere)
    with running as process, suppress(OSError):
        assert process.stdin is not None
        assert process.stdout is not None
        for model in models:
            print(json.dumps(asdict(model)), file=process.stdin, flush=True)
            if not process.stdout.readline():
                return


def _compile_lines(parent: int) -> None:
    """In that process: compile the model that each line of standard input names, and answer with a line."""
    die_with_parent(parent)
    for line in sys.stdin:
        _compile(NewModel(**json.loads(line)))
        print("done", flush=True)


def _compile(model: NewModel) -> None:
    with suppress(Exception):  # where the error matters, stepping the model raises it again
        component = load_component(model.fmu, model.fmu, Path(model.folder), Stepping(model.in_process))
        try:
            component.set(dict.fromkeys(model.effects, 1))
            component.enter(0.0)
            component.exit()
            component.step(0.0, _STEP)
        finally:
            component.close()


if __name__ == "__main__":
    _compile_lines(int(sys.argv[1]))
