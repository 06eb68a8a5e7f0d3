"""Every shipped scene by every way: wall time per simulated second, at the error of its macro step."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from fmu_overhead import kernel_times

from speeds.measured import Block, Spread, in_turns
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.scene.scene import Scene

LEVITATED = 2e-3  # s, before the drops whose error is measured
LANDED = 10e-3  # s after the shutdown: the first impacts are over
FINE = 1e-6  # s, macro steps that errors are against
WAYS = ("kernels alone", "in process", "native FMUs", "FMUs in Python")


@dataclass(frozen=True)
class Error:
    """What the macro step does to the first impacts, against steps of FINE."""

    journal: float  # um, largest of all journals at LANDED
    peak: float  # of the contact forces in bores, largest relative difference; nan: there are none


@dataclass(frozen=True)
class Cost:
    """Of one scene."""

    scene: Scene
    error: Error
    ways: dict[str, Spread]  # s per simulated s


def recorded(scene: Scene, in_process: bool = False) -> float:
    """Wall time per simulated second of a run that records."""
    with tempfile.TemporaryDirectory() as folder, opened(scene, in_process) as system:
        outcome = simulate(scene, system, Path(folder) / "result.h5")
        outcome.raise_if_stopped()
        return outcome.wall_time / outcome.end


def kernels(scene: Scene) -> float:
    """The same of the compiled kernels alone, summed over the components."""
    return 1e-6 * sum(kernel_times(scene).values()) / scene.run.macro_step


def ways(scene: Scene, native: bool) -> dict[str, Callable[[], float]]:
    """What measures each of WAYS; without `native` all but that."""
    built = scene.set({f"{name}.native": True for name in scene.components})
    found = {
        "kernels alone": partial(kernels, scene),
        "in process": partial(recorded, scene, in_process=True),
        "native FMUs": partial(recorded, built),
        "FMUs in Python": partial(recorded, scene),
    }
    return {way: found[way] for way in WAYS if native or way != "native FMUs"}


def cost(scene: Scene, duration: float, repeat: int, native: bool) -> Cost:
    """Of a scene over `duration` (s) from the shutdown, after a run of each way that compiles."""
    short = scene.set({"run.duration": max(5e-3, 2.0 * scene.run.macro_step)})
    for warm in ways(short, native).values():
        warm()
    timed = scene.set({"run.duration": duration, "run.stop_residual": 1e9})
    return Cost(scene, error(scene), in_turns(ways(timed, native), repeat))


def error(scene: Scene) -> Error:
    """Of a scene's macro step."""
    found, exact = (_landed(scene, step) for step in (scene.run.macro_step, FINE))
    journal = max(
        (1e6 * math.dist(a, b) for a, b in zip(found[0], exact[0], strict=True)), default=math.nan
    )
    peaks = (abs(a / b - 1.0) for a, b in zip(found[1], exact[1], strict=True))
    return Error(journal, max(peaks, default=math.nan))


def landing(scene: Scene) -> Scene:
    """The scene from shortly before its shutdown up to LANDED after it."""
    held = {f"{n}.shutdown_time": LEVITATED for n, part in scene.components.items() if part.fmu == "amb"}
    return scene.set({**held, "run.duration": LANDED, "run.stop_residual": 1e9})


def _landed(scene: Scene, step: float) -> tuple[list[tuple[float, float]], list[float]]:
    """Journals (m) at LANDED, and peak contact forces (N) of the bearings that were touched."""
    scene = landing(scene).set({"run.macro_step": step})
    with opened(scene, in_process=True) as system:
        simulate(scene, system).raise_if_stopped()
        seats = touchdown_seats(system)
        places = [(system.value(a.motion("x")), system.value(a.motion("y"))) for a in seats]
        peaks = [system.value(f"{a.bearing}.contact.peak_force") for a in seats]
    return places, [peak for peak in peaks if peak > 0.0]


def number(value: float, unit: str) -> str:
    """A value with its unit; a dash where there is none."""
    return "-" if math.isnan(value) else f"{value:.2g} {unit}"


def block(costs: list[Cost], native: bool) -> Block:
    """The scenes' rows."""
    shown = [way for way in WAYS if native or way != "native FMUs"]
    rows = [
        (
            cost.scene.name,
            f"{1e6 * cost.scene.run.macro_step:g} us",
            number(cost.error.journal, "um"),
            number(100.0 * cost.error.peak, "%"),
            *(cost.ways[way].text for way in shown),
        )
        for cost in costs
    ]
    return Block(
        "wall time per simulated s, recorded; errors of the macro step, in the first impacts",
        ("scene", "macro step", "journal", "peak force", *shown),
        tuple(rows),
    )
