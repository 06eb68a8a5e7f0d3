"""The four bearing models side by side: Tables 5, 6 and 7, more with the spread over drops, and options.

Balls rattle chaotically, so each model drops an ensemble of disks whose balls start 1e-7 rad apart;
medians are compared, and the spread stands beside them.
"""

from __future__ import annotations

import statistics
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ...master.coupling.simulation import open_system, opened
from ...master.quantities import Summary
from ...master.scene.file import load_scene
from ...master.scene.scene import Scene
from ..case import Found, Row
from .disk_forces import BALL
from .drop_cache import Drops, numbers

STEP_APART = 1e-7  # rad
MEMBERS, DURATION = 5, 5.0  # drops per model, s
NEAR_REPEATABLE, NEAR_ROUGH = 0.03, 0.3  # the latter of what is chaotic, or only about stated
MODELS = ("cageless detailed", "cageless simplified", "caged detailed", "caged simplified")
PRINTED_PITCH = "cageless simplified, 26.1 mm"
Reading = tuple[str, Mapping[str, object]]  # model, settings of its bearing
READINGS: Mapping[str, Reading] = {  # ensembles
    "cageless detailed": ("cageless detailed", {}),
    "cageless simplified": ("cageless simplified", {}),
    PRINTED_PITCH: ("cageless simplified", {"balls.pitch_diameter": "26.1 mm", "balls.crowded": 1}),
    "caged detailed": ("caged detailed", {}),
    "caged simplified": ("caged simplified", {}),
}
RATTLE = "undamped balls that rattle between the races; chaotic"
AS_TABLE_1 = "pitch as Table 1 prints it, where 17 balls overlap by 4 um"


@dataclass(frozen=True)
class _Measure:
    """One quantity: the dissertation's value by model, and what a deviation hinges on."""

    title: str
    unit: str  # in which people read it
    key: str  # in a summary
    source: Mapping[str, float]
    hinges_on: Mapping[str, str] = field(default_factory=dict)
    rough: bool = False  # chaotic, or only about stated


TABLE_7 = (
    _Measure(
        *("rotor and inner ring", "um", "peak_indentation_rotor_ring"),
        dict(zip(READINGS, (27.8, 29.1, 29.1, 27.4, 27.4), strict=True)),
        {
            "cageless simplified": "a much stiffer support; (2.10) as printed gives the same as corrected",
            PRINTED_PITCH: AS_TABLE_1,
        },
    ),
    _Measure(
        *("ball and inner ring", "um", "peak_indentation_ball_inner"),
        {"cageless detailed": 2.72, "caged detailed": 3.99},
        {"caged detailed": RATTLE},
    ),
    _Measure(
        *("ball and outer ring", "um", "peak_indentation_ball_outer"),
        {"cageless detailed": 2.65, "caged detailed": 3.88},
        {"caged detailed": RATTLE},
    ),
    _Measure(
        *("both rings through a ball", "um", "peak_indentation_rings"),
        {"cageless simplified": 5.46, PRINTED_PITCH: 5.46, "caged simplified": 8.01},
        {
            "cageless simplified": "where the lowest ball sits (5.2 to 5.4)",
            PRINTED_PITCH: AS_TABLE_1,
            "caged simplified": "where the lowest ball sits (7.6 to 8.3); 5 um read as radial play",
        },
    ),
    _Measure(
        *("ball and ball", "um", "peak_indentation_ball_ball"),
        {"cageless detailed": 34.7, "cageless simplified": 20.7, PRINTED_PITCH: 20.7},
        {
            "cageless detailed": "undamped contacts between balls, k = 1e8 N/m^1.5; chaotic",
            "cageless simplified": "the pitch diameter, 28.5 mm as the catalogue has it; chaotic",
            PRINTED_PITCH: AS_TABLE_1,
        },
        rough=True,
    ),
    _Measure(
        *("ball and cage", "um", "peak_indentation_ball_cage"),
        {"caged detailed": 20.1},
        {"caged detailed": "undamped contacts with the cage, k = 1e8 N/m^1.5; chaotic"},
        rough=True,
    ),
)

LOADED = {"cageless detailed": 7, "caged detailed": 2}
FURTHER = (
    _Measure("loaded balls at the end", "", "loaded_balls_end", LOADED, rough=True),
    _Measure("loaded balls, mean of the last fifth", "", "loaded_balls_mean", {}, rough=True),
    _Measure("first-impact ball force", "N", BALL, {}, rough=True),
    _Measure(
        "ring reaches the rotor's speed", "s", "ring_sync_time", dict.fromkeys(MODELS, 0.1), rough=True
    ),
    _Measure("pendulum", "Hz", "pendulum_frequency", dict.fromkeys(MODELS, 28.0), rough=True),
    _Measure("rotor speed at the end", "rpm", "speed_end", {}, rough=True),
)

# what the models count: title, variables of the group `size` to add up, the dissertation's Tables 5 and 6
COUNTS: tuple[tuple[str, tuple[str, ...], Mapping[str, int]], ...] = (
    ("coordinates", ("coordinates",), dict(zip(MODELS, (57, 39, 36, 5), strict=True))),
    ("constraints", ("constraints",), dict(zip(MODELS, (1, 0, 1, 0), strict=True))),
    ("contacts ball-ball", ("ball_ball",), dict(zip(MODELS, (17, 17, 0, 0), strict=True))),
    ("contacts ball-cage", ("ball_cage",), dict(zip(MODELS, (0, 0, 9, 0), strict=True))),
    ("contacts ball-outer", ("ball_outer", "rings"), dict(zip(MODELS, (17, 17, 9, 9), strict=True))),
    ("contacts ball-inner", ("ball_inner", "rings"), dict(zip(MODELS, (17, 17, 9, 9), strict=True))),
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


def table_5(drops: Drops) -> Found:
    """Coordinates and constraints of each model."""
    return Found(_count_rows(COUNTS[:2]))


def table_6(drops: Drops) -> Found:
    """Elastic contacts of each model."""
    notes = ["one contact of both rings through a ball stands for two; the dissertation: 'reduced to'"]
    return Found(_count_rows(COUNTS[2:]), notes=notes)


def _count_rows(counts: Sequence[tuple[str, tuple[str, ...], Mapping[str, int]]]) -> list[Row]:
    rows: list[Row] = []
    for model in MODELS:
        with opened(_scene(model), in_process=True) as system:
            system.initialise()
            for title, variables, source in counts:
                count = sum(system.value(f"bearing.size.{variable}") for variable in variables)
                rows.append(Row(f"{model}: {title}", "", source[model], count, 0.0))
    return rows


def table_7(drops: Drops) -> Found:
    """Medians over drops whose balls start 1e-7 rad apart."""
    return Found(_measured(drops, TABLE_7), notes=[_note(drops)])


def bearings(drops: Drops) -> Found:
    """Table 7 and further figures with the spread over the drops."""
    rows = _measured(drops, (*TABLE_7, *FURTHER), spread=True)
    for kind in ("detailed", "simplified"):
        caged, cageless = (
            numbers(_ensemble(drops, f"{cage} {kind}", {}), BALL) for cage in ("caged", "cageless")
        )
        if caged and cageless:
            ratio = statistics.median(caged) / statistics.median(cageless)
            rows.append(Row(f"{kind}: first-impact ball force, caged over cageless", "", 2.0, ratio, 0.15))
    return Found(rows, notes=[_note(drops)])


def options(drops: Drops) -> Found:
    """The effect of each option of section 5.3, and of damping by ratio, on Table 7."""
    rows: list[Row] = []
    _prepare(drops, [*((model, {}) for model in MODELS), *(option[1:] for option in OPTIONS)])
    for label, model, settings in OPTIONS:
        plain, changed = (_ensemble(drops, model, s) for s in ({}, settings))
        for quantity in TABLE_7:
            before, after = numbers(plain, quantity.key), numbers(changed, quantity.key)
            if before and after:
                change = (
                    f"{statistics.median(before):.4g} -> {statistics.median(after):.4g} {quantity.unit}"
                )
                what = f"{label}, {model}: {quantity.title}"
                rows.append(Row(what, "", None, change, why="without -> with the option"))
    return Found(rows, notes=[_note(drops)])


def _measured(drops: Drops, quantities: Sequence[_Measure], spread: bool = False) -> list[Row]:
    """Medians by quantity and ensemble, where the model has it, beside Halminen's value if it has one."""
    _prepare(drops, list(READINGS.values()))
    rows: list[Row] = []
    for quantity in quantities:
        for name, reading in READINGS.items():
            values = numbers(_ensemble(drops, *reading), quantity.key)
            if not values or (not spread and name not in quantity.source):
                continue
            why = quantity.hinges_on.get(name, "")
            if spread and len(values) > 1:
                several = f"{len(values)} drops: {min(values):.4g} to {max(values):.4g}"
                why = "; ".join(filter(None, (several, why)))
            source, near = quantity.source.get(name), NEAR_ROUGH if quantity.rough else NEAR_REPEATABLE
            what = f"{quantity.title}, {name}"
            rows.append(Row(what, quantity.unit, source, statistics.median(values), near, why))
    return rows


def _scene(model: str) -> Scene:
    return load_scene(f"disk-{model.replace(' ', '-')}")


def _scenes(drops: Drops, model: str, settings: Mapping[str, object]) -> list[Scene]:
    """The ensemble of a model with settings of its bearing."""
    scene = _scene(model).set({"run.duration": DURATION})
    angle = float(open_system(scene, in_process=True).value("bearing.balls.first_angle"))
    changes = {f"bearing.{name}": value for name, value in settings.items()}
    angles = [angle + STEP_APART * number for number in range(drops.members or MEMBERS)]
    return [scene.set({"bearing.balls.first_angle": first, **changes}) for first in angles]


def _prepare(drops: Drops, readings: Sequence[Reading]) -> None:
    """Run all of them beside each other."""
    drops.of([scene for reading in readings for scene in _scenes(drops, *reading)])


def _ensemble(drops: Drops, model: str, settings: Mapping[str, object]) -> list[Summary]:
    return [run.summary for run in drops.of(_scenes(drops, model, settings))]


def _note(drops: Drops) -> str:
    return f"medians over drops ({drops.members or MEMBERS}), balls {STEP_APART:g} rad apart at the start"
