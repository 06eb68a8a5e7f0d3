"""The four bearing models side by side, against the source's Tables 5, 6 and 7.

Balls rattle chaotically, so each model drops an ensemble of disks whose balls start 1e-7 rad apart;
medians are compared, and the spread stands beside them.
"""

from __future__ import annotations

import json
import os
import statistics
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

from ...master.common.errors import TouchdownError
from ...master.coupling.simulation import open_system
from ...master.scene.file import load_scene
from ...master.scene.scene import Scene
from ...modelkit.kernel.writing import make_folder, write

STEP_APART = 1e-7  # rad
MEMBERS = 5  # drops per model
SCENES = {
    "cageless detailed": "disk-cageless-detailed",
    "cageless simplified": "disk-cageless-simplified",
    "caged detailed": "disk-caged-detailed",
    "caged simplified": "disk-caged-simplified",
}
PRINTED_PITCH = "cageless simplified, 26.1 mm"
READINGS: Mapping[str, tuple[str, Mapping[str, object]]] = {  # ensembles: model, settings of its bearing
    "cageless detailed": ("cageless detailed", {}),
    "cageless simplified": ("cageless simplified", {}),
    PRINTED_PITCH: ("cageless simplified", {"balls.pitch_diameter": "26.1 mm", "balls.crowded": 1}),
    "caged detailed": ("caged detailed", {}),
    "caged simplified": ("caged simplified", {}),
}
AS_TABLE_1 = "pitch as Table 1 prints it, where 17 balls overlap by 4 um"


@dataclass(frozen=True)
class Row:
    """One quantity: the source's value by model, and what a deviation hinges on."""

    title: str
    key: str  # in summary.json
    source: Mapping[str, float]
    hinges_on: Mapping[str, str] = field(default_factory=dict)


TABLE_7 = (
    Row(
        "rotor and inner ring",
        "peak_indentation_rotor_ring_um",
        {
            "cageless detailed": 27.8,
            "cageless simplified": 29.1,
            PRINTED_PITCH: 29.1,
            "caged detailed": 27.4,
            "caged simplified": 27.4,
        },
        {
            "cageless simplified": "a much stiffer support; (2.10) as printed gives the same as corrected",
            PRINTED_PITCH: AS_TABLE_1,
        },
    ),
    Row(
        "ball and inner ring",
        "peak_indentation_ball_inner_um",
        {"cageless detailed": 2.72, "caged detailed": 3.99},
        {"caged detailed": "undamped balls that rattle between the races; chaotic"},
    ),
    Row(
        "ball and outer ring",
        "peak_indentation_ball_outer_um",
        {"cageless detailed": 2.65, "caged detailed": 3.88},
        {"caged detailed": "undamped balls that rattle between the races; chaotic"},
    ),
    Row(
        "both rings through a ball",
        "peak_indentation_rings_um",
        {"cageless simplified": 5.46, PRINTED_PITCH: 5.46, "caged simplified": 8.01},
        {
            "cageless simplified": "where the lowest ball sits (5.2 to 5.4)",
            PRINTED_PITCH: AS_TABLE_1,
            "caged simplified": "where the lowest ball sits (7.6 to 8.3); 5 um read as radial play",
        },
    ),
    Row(
        "ball and ball",
        "peak_indentation_ball_ball_um",
        {"cageless detailed": 34.7, "cageless simplified": 20.7, PRINTED_PITCH: 20.7},
        {
            "cageless detailed": "undamped contacts between balls, k = 1e8 N/m^1.5; chaotic",
            "cageless simplified": "the pitch diameter, 28.5 mm as the catalogue has it; chaotic",
            PRINTED_PITCH: AS_TABLE_1,
        },
    ),
    Row(
        "ball and cage",
        "peak_indentation_ball_cage_um",
        {"caged detailed": 20.1},
        {"caged detailed": "undamped contacts with the cage, k = 1e8 N/m^1.5; chaotic"},
    ),
)

FURTHER = (
    Row(
        "loaded balls at the end",
        "loaded_balls_end",
        {"cageless detailed": 7, "caged detailed": 2},
    ),
    Row("loaded balls, mean of the last fifth", "loaded_balls_mean", {}),
    Row("first-impact ball force [N]", "first_impact_ball_force_N", {}),
    Row("ring reaches the rotor's speed [s]", "ring_sync_time_s", dict.fromkeys(SCENES, 0.1)),
    Row("pendulum [Hz]", "pendulum_frequency_Hz", dict.fromkeys(SCENES, 28.0)),
    Row("rotor speed at the end [rpm]", "rotor_speed_end_rpm", {}),
)

# what the models count: title, variables of the group `size` to add up, the source's Tables 5 and 6
COUNTS: tuple[tuple[str, tuple[str, ...], Mapping[str, int]], ...] = (
    ("coordinates", ("coordinates",), dict(zip(SCENES, (57, 39, 36, 5), strict=True))),
    ("constraints", ("constraints",), dict(zip(SCENES, (1, 0, 1, 0), strict=True))),
    ("contacts ball-ball", ("ball_ball",), dict(zip(SCENES, (17, 17, 0, 0), strict=True))),
    ("contacts ball-cage", ("ball_cage",), dict(zip(SCENES, (0, 0, 9, 0), strict=True))),
    ("contacts ball-outer", ("ball_outer", "rings"), dict(zip(SCENES, (17, 17, 9, 9), strict=True))),
    ("contacts ball-inner", ("ball_inner", "rings"), dict(zip(SCENES, (17, 17, 9, 9), strict=True))),
)

# section 5.3 and (2.47): label, model, settings of its bearing
OPTIONS: tuple[tuple[str, str, Mapping[str, object]], ...] = (
    ("corrected pitch radius (5.1)", "cageless simplified", {"corrected_pitch": 1}),
    ("(5.1) with its signs as printed", "cageless simplified", {"corrected_pitch": 2}),
    ("(2.10) as printed", "cageless simplified", {"as_printed": 1}),
    ("balls and cage may slip", "caged simplified", {"slip": 1}),
    ("damping ratio 0.05, races", "cageless simplified", {"balls.damping_ratio": 0.05}),
    ("damping ratio 0.05, races", "caged simplified", {"balls.damping_ratio": 0.05}),
    ("damping ratio 0.05, races", "cageless detailed", {"balls.damping_ratio": 0.05}),
    ("damping ratio 0.05, races", "caged detailed", {"balls.damping_ratio": 0.05}),
    ("damping ratio 0.05, between balls", "cageless simplified", {"ball_contact.damping_ratio": 0.05}),
    ("damping ratio 0.05, between balls", "cageless detailed", {"ball_contact.damping_ratio": 0.05}),
    ("damping ratio 0.05, on the cage", "caged detailed", {"cage_contact.damping_ratio": 0.05}),
    ("damping ratio 0.05, rotor on ring", "caged simplified", {"contact.damping_ratio": 0.05}),
)


def member(model: str, number: int, duration: float, settings: Mapping[str, object] | None = None) -> Scene:
    """One of a model's ensemble."""
    scene = load_scene(SCENES[model]).set({"run.duration": duration})
    angle = float(open_system(scene, in_process=True).value("bearing.balls.first_angle"))
    scene = scene.set({"bearing.balls.first_angle": angle + STEP_APART * number})
    for name, value in (settings or {}).items():
        scene = scene.set({f"bearing.{name}": value})
    return scene


def summary_of(scene: Scene) -> dict[str, object]:
    """Run a scene in process and give its figures."""
    from ...master.results.run import run_scene

    with TemporaryDirectory() as folder:
        return run_scene(scene, Path(folder), in_process=True).summary


def summaries(scenes: Sequence[Scene], done: Callable[[], object]) -> list[dict[str, object]]:
    """Figures of all scenes, run beside each other; done() after each."""
    figures = []
    with ProcessPoolExecutor(min(len(scenes), os.cpu_count() or 1)) as pool:
        for summary in pool.map(summary_of, scenes):
            if summary.get("stopped_because"):
                raise TouchdownError(f"a run stopped: {summary['stopped_because']}")
            figures.append(summary)
            done()
    return figures


def values_of(ensemble: Sequence[Mapping[str, object]], key: str) -> list[float]:
    """A quantity over the ensemble; empty where the model has none."""
    return [float(v) for s in ensemble if isinstance(v := s.get(key), (int, float))]


def row_lines(rows: Sequence[Row], ensembles: Mapping[str, Sequence[Mapping[str, object]]]) -> list[str]:
    """Lines of a table: model by model the median, its spread, the source's value and the deviation."""
    lines = []
    for row in rows:
        lines.append(row.title)
        for model, ensemble in ensembles.items():
            values = values_of(ensemble, row.key)
            if not values:
                continue
            middle = statistics.median(values)
            spread = f"{min(values):.4g} to {max(values):.4g}"
            if len(values) < len(ensemble):
                spread += f" ({len(values)} of {len(ensemble)})"
            source, deviation = "", ""
            if model in row.source:
                source = f"{row.source[model]:g}"
                deviation = f"{100.0 * (middle / row.source[model] - 1.0):+.1f} %"
            hinge = row.hinges_on.get(model, "")
            line = f"  {model:<29}{middle:>9.4g}{spread:>20}{source:>8}{deviation:>10}  {hinge}"
            lines.append(line.rstrip())
    return lines


def count_lines() -> list[str]:
    """Tables 5 and 6: what each model counts, and the source's number where it differs."""
    systems = {model: open_system(load_scene(scene), in_process=True) for model, scene in SCENES.items()}
    for system in systems.values():
        system.initialise()
    lines = [f"{'':<22}" + "".join(f"{model:>21}" for model in SCENES)]
    for title, variables, source in COUNTS:
        line = f"{title:<22}"
        for model, system in systems.items():
            count = int(sum(system.value(f"bearing.size.{v}") for v in variables))
            line += f"{count if count == source[model] else f'{count} (source {source[model]})':>21}"
        lines.append(line)
    return lines


def option_lines(
    duration: float,
    members: int,
    plain: Mapping[str, Sequence[Mapping[str, object]]],
    done: Callable[[], object],
) -> list[str]:
    """The effect of each option of section 5.3, and of damping by ratio, on Table 7, as medians."""
    scenes = [member(m, k, duration, settings) for _, m, settings in OPTIONS for k in range(members)]
    figures = summaries(scenes, done)
    lines = []
    for i, (label, model, _) in enumerate(OPTIONS):
        changed, changes = figures[i * members : (i + 1) * members], []
        for row in TABLE_7:
            before, after = values_of(plain[model], row.key), values_of(changed, row.key)
            if before and after:
                short = row.key.removeprefix("peak_indentation_").removesuffix("_um").replace("_", "-")
                change = f"{statistics.median(before):.4g} -> {statistics.median(after):.4g}"
                changes.append(f"{short} {change}")
        lines.append(f"  {label + ', ' + model:<56}{', '.join(changes)}")
    return lines


def compare_bearings(
    duration: float, members: int, options: bool, folder: Path, done: Callable[[], object] = lambda: None
) -> str:
    """Run everything, write bearings.json and bearings.txt into `folder`; returns the text."""
    scenes = [member(m, k, duration, settings) for m, settings in READINGS.values() for k in range(members)]
    figures = summaries(scenes, done)
    ensembles = {name: figures[i * members : (i + 1) * members] for i, name in enumerate(READINGS)}
    lines = [
        f"{members} drops of {duration:g} s per model, balls {STEP_APART:g} rad apart at the start:",
        "median, smallest and largest, the source's value, deviation of the median, what it hinges on",
        "",
        "Tables 5 and 6: coordinates and elastic contacts",
        *count_lines(),
        "",
        "Table 7: greatest indentations [um]",
        *row_lines(TABLE_7, ensembles),
        "",
        "Further figures",
        *row_lines(FURTHER, ensembles),
        *_ratio_lines(ensembles),
    ]
    if options:
        lines += ["", "Options: Table 7 without -> with [um], medians"]
        lines += option_lines(duration, members, ensembles, done)
    text = "\n".join(lines) + "\n"
    make_folder(folder)
    write(folder / "bearings.txt", text)
    write(folder / "bearings.json", json.dumps(ensembles, indent=2) + "\n")
    return text


def _ratio_lines(ensembles: Mapping[str, Sequence[Mapping[str, object]]]) -> list[str]:
    lines = ["first-impact ball force, caged over cageless (source: about 2)"]
    for kind in ("detailed", "simplified"):
        key = "first_impact_ball_force_N"
        forces = [values_of(ensembles[f"{cage} {kind}"], key) for cage in ("caged", "cageless")]
        if all(forces):
            ratio = statistics.median(forces[0]) / statistics.median(forces[1])
            lines.append(f"  {kind:<29}{ratio:>9.3g}")
    return lines
