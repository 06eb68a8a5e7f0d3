"""Runs that go on from the end of another: what its folder keeps for them, and what they may change."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...fmus.version import VERSION
from ...modelkit.variables import Variability
from ..common.errors import Ended, TouchdownError
from ..coupling.assembly import checked_value
from ..coupling.snapshot import DAMAGE, Resumed, Saved, read_state, write_state
from ..coupling.system import System
from ..scene.file import RECORDED_SCENE, read_resolved
from ..scene.run_spec import END, SHUTDOWN, RunSpec
from ..scene.scene import Scene
from .result import RECORDING

STATE_FILE = "state.npz"
FREE = ("duration", "until", "time_limit", "call_timeout")  # keys of [run] that may be others


def keep_state(folder: Path, state: Saved, in_process: bool, ended: Ended) -> None:
    """Write what a later run goes on from. Raises OSError."""
    more = {"version": VERSION, "in_process": in_process, "completed": ended is Ended.COMPLETED}
    write_state(folder / STATE_FILE, {**state, **more})


class Earlier:
    """The run in `folder` as far as another one can go on from it.

    Raises TouchdownError where it kept no state, or another version did.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.scene = read_resolved(folder / RECORDED_SCENE)
        if not (folder / STATE_FILE).is_file():
            raise TouchdownError(
                f"{folder} has no {STATE_FILE} to go on from: the run failed or was killed, or a component "
                "cannot give its state (canSerializeFMUstate), or the master listens to one"
            )
        self._state = state = read_state(folder / STATE_FILE)
        try:
            self.in_process, self.done = bool(state["in_process"]), int(state["run"]["done"])
            if state["version"] != VERSION:
                raise TouchdownError(
                    f"{folder} is of version {state['version']}, and this is {VERSION}; run the scene again"
                )
        except DAMAGE as error:
            raise TouchdownError(f"{folder / STATE_FILE} is not as a run leaves it ({error!r})") from None

    def onward(self, scene: Scene) -> Scene:
        """`scene`, until its end where the earlier run has come to the shutdown ahead of which both end.

        A scene that is read back has that still, with later times of the shutdown or not.
        """
        if not (self._state.get("completed") and self.scene.run.until == scene.run.until == SHUTDOWN):
            return scene
        return replace(scene, run=replace(scene.run, until=END))

    def resumed(self, scene: Scene, system: System, folder: Path) -> Resumed:
        """Where a run of `scene` into `folder` starts. Raises TouchdownError for what it cannot change."""
        tuned: dict[str, dict[str, float]] = {}
        for name, key in self._changed(scene):
            component = system.components[name]
            if component.variable(key).variability is not Variability.TUNABLE:
                every = component.variables.values()
                tunable = [v.name for v in every if v.variability is Variability.TUNABLE]
                raise TouchdownError(
                    f"{name}.{key} stays what it was in {self.folder}; a run that goes on may set "
                    f"{', '.join(tunable) or 'nothing'}"
                )
            tuned.setdefault(name, {})[key] = _value(scene, system, name, key)
            self._refuse_past(scene, system, name, key)
        if tuned and folder.resolve() == self.folder.resolve():
            raise TouchdownError(
                f"a run with other settings needs a folder beside {folder}; give it with -o"
            )
        if not all(component.can_serialise for component in system.components.values()):
            name = next(n for n, c in system.components.items() if not c.can_serialise)
            raise TouchdownError(f"component {name} ({system.components[name].origin}) cannot take a state")
        return Resumed(self.folder, self._state, self.folder / RECORDING, tuned)

    def _refuse_past(self, scene: Scene, system: System, name: str, key: str) -> None:
        """Raise TouchdownError where a setting has something happen that this run has come beyond."""
        event, _, last = key.rpartition(".")
        time, kind = f"{event}.time", f"{event}.kind"
        if last in ("time", "kind") and {time, kind} <= system.components[name].variables.keys():
            happens, key = _value(scene, system, name, kind) != 0.0, time
        else:
            happens = last == "shutdown_time" or f"{name}.{key}" == scene.zero
        end = self.scene.run.start_time + self.done * self.scene.run.macro_step
        if happens and (at := _value(scene, system, name, key)) < end - 1e-9 * self.scene.run.macro_step:
            raise TouchdownError(
                f"{name}.{key} = {at:g} s is before the end of the run in {self.folder} at t = {end:g} s"
            )

    def _changed(self, scene: Scene) -> Iterator[tuple[str, str]]:
        """Settings of components that are others. Raises TouchdownError where anything else is."""
        before, after = map(_compared, (self.scene, scene))
        if before != after:
            other = (key for key in {**before, **after} if before.get(key) != after.get(key))
            what = next(other, "its components")
            raise TouchdownError(
                f"the scene differs from that of {self.folder} in {what}; a run that goes on may change "
                f"run.{', run.'.join(FREE)} and tunable parameters"
            )
        for name, spec in scene.components.items():
            earlier = self.scene.components[name].set
            keys = earlier.keys() | spec.set.keys()
            yield from ((name, key) for key in sorted(keys) if earlier.get(key) != spec.set.get(key))


def _value(scene: Scene, system: System, name: str, key: str) -> float:
    """What `scene` sets; else what its `system` has by preset, swap or default."""
    component, stated = system.components[name], scene.components[name].set.get(key)
    if stated is not None:
        return float(checked_value(component, key, stated))
    return float(system.settings.get((name, key), component.variable(key).start) or 0.0)


def _compared(scene: Scene) -> Mapping[str, Any]:
    """All of a scene that must be the same, by keys for people."""
    default = RunSpec()
    run = replace(scene.run, **{key: getattr(default, key) for key in FREE})
    values = replace(scene, run=run, own=(), requirements=()).resolved()
    values = json.loads(json.dumps(values, default=str))
    for name in ("title", "about", "document", "name", "folder", "own", "requirements"):
        del values[name]
    found = {f"run.{key}": value for key, value in values.pop("run").items()}
    for name, spec in values.pop("components").items():
        found |= {f"{name}.{key}": value for key, value in spec.items() if key not in ("set", "own")}
    return found | values
