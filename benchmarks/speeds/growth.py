"""How cost grows: with balls, modes, seats, simulated time, macro step and recorded channels."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import touchdown
from speeds.measured import Block, Spread, exponent, in_turns
from speeds.scenes import recorded
from touchdown.bearings.rolling.ball_set import MAX_BALLS
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene

STATIONS = 8  # nodes of the shaft that seats can hold
SEATED = """
title = "A shaft on {count} bearings"
attach = [{attach}]

[run]
macro_step = 4e-5

[components.rotor]
fmu = "{rotor}"
[components.rotor.set]
modes = 4
speed = "3000 rpm"
"""
ATTACH = '["bearing_{k}.journal", "rotor.S{k}"], ["bearing_{k}.housing", "housing_{k}.seat"]'
SEAT = """
[components.bearing_{k}]
fmu = "simplified_cageless"
preset = "6904"
[components.housing_{k}]
fmu = "housing"
"""


@dataclass(frozen=True)
class Grown:
    """Cost over a size: wall time in s, of all runs alike, or per simulated s."""

    what: str
    unit: str  # of the cost
    sizes: tuple[float, ...]
    costs: tuple[Spread, ...]

    @property
    def power(self) -> float:
        """The fitted exponent."""
        return exponent(self.sizes, [cost.median for cost in self.costs])


def balls(scene: Scene, count: float) -> Scene:
    """As many balls in one bearing, as large as they may be."""
    pitch, largest = 28.5e-3, 4.8e-3  # m, of a 6904
    diameter = min(largest, 0.999 * pitch * math.sin(math.pi / count))
    return scene.set({"bearing.balls.count": int(count), "bearing.balls.diameter": diameter})


def modes(scene: Scene, count: float) -> Scene:
    """As many modes per plane."""
    return scene.set({"rotor.modes": int(count)})


def macro_step(scene: Scene, step: float) -> Scene:
    """Steps so long (s)."""
    return scene.set({"run.macro_step": step})


def simulated(scene: Scene, duration: float) -> Scene:
    """So much time (s) from the shutdown."""
    return scene.set({"run.duration": duration})


def channels(scene: Scene, count: float) -> Scene:
    """As many recorded, of every macro step."""
    with opened(scene, in_process=True) as system:
        names = [f"{n}.{v}" for n, part in system.components.items() for v in part.variables]
        reported = [name for name in names if _is_reported(system.components, name)]
    return scene.set({"run.record": reported[: int(count)], "run.record_every": 1})


def _is_reported(components: object, name: str) -> bool:
    part, _, variable = name.partition(".")
    return components[part].variables[variable].causality == "output"  # type: ignore[index]


def seats(folder: Path, count: int) -> Scene:
    """A shaft that falls from rest onto `count` bearings, each in a housing of its own."""
    steel = touchdown.Element(length=0.1, outer_diameter=0.0194, modulus=207e9, density=7830.0, poisson=0.3)
    held = [touchdown.Station(f"S{k}", k + 1) for k in range(STATIONS)]
    shaft = touchdown.Rotor("Shaft", (STATIONS - 1) * (steel,), stations=held, levitated_at=["S0", "S7"])
    places = [round(k * (STATIONS - 1) / max(count - 1, 1)) for k in range(count)]
    attach = ", ".join(ATTACH.format(k=k) for k in places)
    text = SEATED.format(count=count, attach=attach, rotor=shaft.save(folder / "shaft.toml"))
    path = folder / f"seats-{count}.toml"
    path.write_text(text + "".join(SEAT.format(k=k) for k in places), encoding="utf-8")
    return load_scene(str(path))


def per_second(scene: Scene) -> float:
    """Wall time per simulated second in process, nothing recorded."""
    with opened(scene, in_process=True) as system:
        outcome = simulate(scene, system)
        outcome.raise_if_stopped()
        return outcome.wall_time / outcome.end


def total(scene: Scene) -> float:
    """Wall time of the steps of a run in process (s)."""
    with opened(scene, in_process=True) as system:
        return simulate(scene, system).wall_time


def grown(
    what: str, unit: str, scenes: dict[float, Scene], measure: Callable[[Scene], float], repeat: int
) -> Grown:
    """Measured over sizes, in turns, after a run of each that compiles."""
    for scene in scenes.values():
        per_second(scene.set({"run.duration": 2.0 * scene.run.macro_step}))
    found = in_turns({str(size): lambda s=scene: measure(s) for size, scene in scenes.items()}, repeat)
    return Grown(what, unit, tuple(scenes), tuple(found[str(size)] for size in scenes))


def all_of(duration: float, repeat: int, quick: bool) -> list[Grown]:
    """Everything whose growth is measured; `quick`: at two sizes each."""

    def some(sizes: Sequence[float]) -> Sequence[float]:
        return (sizes[0], sizes[1]) if quick else sizes

    timed = {"run.duration": duration, "run.stop_residual": 1e9}
    disk, cageless = (load_scene(f"disk-{n}").set(timed) for n in ("caged-simplified", "cageless-detailed"))
    rotor = load_scene("rotor1-9000").set(timed)
    many = "s per simulated s"
    plans = [
        ("balls, detailed cageless", many, cageless, balls, (9, 12, 17, 24, MAX_BALLS), per_second),
        ("modes per plane, rotor I", many, rotor, modes, (2, 5, 10, 20, 40), per_second),
        ("simulated time [s]", "s", disk, simulated, [duration * k for k in (0.5, 1, 2, 4)], total),
        ("macro step [s]", many, disk, macro_step, (5e-6, 1e-5, 2e-5, 5e-5, 1e-4), per_second),
        ("recorded channels", many, disk, channels, (1, 4, 16, 64), _recorded),
    ]
    found = [
        grown(what, unit, {n: change(scene, n) for n in some(sizes)}, measure, repeat)
        for what, unit, scene, change, sizes, measure in plans
    ]
    with tempfile.TemporaryDirectory() as folder:
        shafts = {n: seats(Path(folder), int(n)).set(timed) for n in some((1, 2, 4, 8))}
        found.append(grown("seats of a shaft", many, shafts, per_second, repeat))
    return found


def _recorded(scene: Scene) -> float:
    return recorded(scene, in_process=True)


def block(found: list[Grown]) -> Block:
    """Rows of growth: the cost at each size, and the exponent."""
    most = max(len(one.sizes) for one in found)
    rows = []
    for one in found:
        cells = [f"{size:g}: {cost.text}" for size, cost in zip(one.sizes, one.costs, strict=True)]
        rows.append((one.what, one.unit, f"{one.power:.2f}", *cells, *[""] * (most - len(cells))))
    return Block("growth, in process", ("with", "cost in", "exponent", *[""] * most), tuple(rows))
