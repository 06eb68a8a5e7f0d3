"""Small systems for tests, built from Python as a user would."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import h5py
import numpy as np

from touchdown.master.coupling.observer import EveryStep, RunState
from touchdown.master.coupling.simulation import Outcome, open_system, simulate
from touchdown.master.quantities import Summary
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene

DISK = 1.65  # kg
GRAVITY = 9.81  # m/s2
CLEARANCE = 0.3e-3  # m
LANDING = (2.0 * GRAVITY * CLEARANCE) ** 0.5  # m/s

UNLIKE = {"wall_time": 0.0, "start_up": 0.0}  # of the outcomes of two equal runs
AT = 9e-3  # s after the shutdown; rotor I falls for 7.8 ms
LEVITATED = 2e-3  # s
CAGED = {
    "preset": "6004",
    "contact.exponent": 10.0 / 9.0,
    "contact.dissipation": 0.12,
    "contact.damping": 0.0,
    "friction.kind": 0,
    "friction.static": 0.15,
    "friction.dynamic": 0.15,
}


def rotor_on(
    bearing: str | None,
    rotor: Mapping[str, object],
    settings: Mapping[str, object] | None = None,
    housing: Mapping[str, object] | None = None,
    **run: float | str,
) -> Scene:
    """A rigid rotor in a bearing that stands fixed in the ground, or in a housing where one is given."""
    components = {"rotor": ComponentSpec("rigid_rotor", dict(rotor))}
    attach: list[tuple[str, str]] = []
    if bearing is not None:
        components["bearing"] = ComponentSpec(bearing, dict(settings or {}))
        attach.append(("bearing.journal", "rotor.A"))
    if housing is not None:
        components["housing"] = ComponentSpec("housing", dict(housing))
        attach.append(("bearing.housing", "housing.seat"))
    return Scene("test", "test", components, attach=tuple(attach), run=with_changes(RunSpec(), run))


def dropped(modes: int = 5) -> Scene:
    """Rotor I from 9000 rpm into two simplified caged bearings, up to just after the first impacts."""
    scene = load_scene("rotor1-9000")
    for end in "AB":
        scene = scene.swap(**{f"bearing_{end}": "simplified_caged"})
        for name, value in CAGED.items():
            scene = scene.set({f"bearing_{end}.{name}": value})
        scene = scene.set({f"amb_{end}.shutdown_time": LEVITATED})
    scene = scene.set({"rotor.modes": modes})
    return scene.set({"run.duration": AT, "run.stop_residual": 1e9})


def history(
    scene: Scene, names: list[str], in_process: bool = True
) -> tuple[np.ndarray, dict[str, np.ndarray], Outcome]:
    """Run a scene and keep `names` after every macro step: (times, values by name, outcome)."""
    system = open_system(scene, in_process)
    times: list[float] = []
    rows: list[list[float]] = []

    def watch(now: RunState) -> None:
        times.append(now.time)
        rows.append([now.system.value(name) for name in names])

    try:
        outcome = simulate(scene, system, observers=[EveryStep(watch)])
    finally:
        system.close()
    assert not outcome.reason, outcome.reason
    values = np.array(rows).T
    return np.array(times), dict(zip(names, values, strict=True)), outcome


def run_to_end(scene: Scene, folder: Path, in_process: bool = True) -> Summary:
    """Run a scene with recording and give its summary."""
    from touchdown.master.results.run import run_scene

    return run_scene(scene, folder, in_process=in_process).summary


def recorded(folder: Path) -> dict[str, np.ndarray]:
    """All numbers that a run in `folder` recorded, by name."""
    found: dict[str, np.ndarray] = {}

    def take(name: str, item: object) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
            found[name] = np.asarray(item[...])

    with h5py.File(folder / "result.h5") as file:
        file.visititems(take)
    return found


def bits(path: Path) -> dict[str, object]:
    """All that a recording holds: numbers as words, attributes as they are said."""
    found: dict[str, object] = {}

    def keep(name: str, item: h5py.Dataset | h5py.Group) -> None:
        found[name] = (
            item[:].tobytes() if isinstance(item, h5py.Dataset) else repr(sorted(item.attrs.items()))
        )

    with h5py.File(path) as file:
        file.visititems(keep)
    assert len(found["time"]) > 8 * 2  # type: ignore[arg-type]
    return found
