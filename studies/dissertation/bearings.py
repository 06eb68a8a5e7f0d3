"""The four bearing models side by side: what of them stands in the source's Tables 5, 6 and 7.

Balls rattle chaotically, so each model drops an ensemble of disks whose balls start 1e-7 rad apart;
medians are compared, and the spread stands beside them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...master.coupling.simulation import open_system
from ...master.scene.file import load_scene
from ...master.scene.scene import Scene

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
RATTLE = "undamped balls that rattle between the races; chaotic"
AS_TABLE_1 = "pitch as Table 1 prints it, where 17 balls overlap by 4 um"


@dataclass(frozen=True)
class Measure:
    """One quantity: the source's value by model, and what a deviation hinges on."""

    title: str
    key: str  # in summary.json
    source: Mapping[str, float]
    hinges_on: Mapping[str, str] = field(default_factory=dict)


TABLE_7 = (
    Measure(
        "rotor and inner ring",
        "peak_indentation_rotor_ring_um",
        dict(zip(READINGS, (27.8, 29.1, 29.1, 27.4, 27.4), strict=True)),
        {
            "cageless simplified": "a much stiffer support; (2.10) as printed gives the same as corrected",
            PRINTED_PITCH: AS_TABLE_1,
        },
    ),
    Measure(
        "ball and inner ring",
        "peak_indentation_ball_inner_um",
        {"cageless detailed": 2.72, "caged detailed": 3.99},
        {"caged detailed": RATTLE},
    ),
    Measure(
        "ball and outer ring",
        "peak_indentation_ball_outer_um",
        {"cageless detailed": 2.65, "caged detailed": 3.88},
        {"caged detailed": RATTLE},
    ),
    Measure(
        "both rings through a ball",
        "peak_indentation_rings_um",
        {"cageless simplified": 5.46, PRINTED_PITCH: 5.46, "caged simplified": 8.01},
        {
            "cageless simplified": "where the lowest ball sits (5.2 to 5.4)",
            PRINTED_PITCH: AS_TABLE_1,
            "caged simplified": "where the lowest ball sits (7.6 to 8.3); 5 um read as radial play",
        },
    ),
    Measure(
        "ball and ball",
        "peak_indentation_ball_ball_um",
        {"cageless detailed": 34.7, "cageless simplified": 20.7, PRINTED_PITCH: 20.7},
        {
            "cageless detailed": "undamped contacts between balls, k = 1e8 N/m^1.5; chaotic",
            "cageless simplified": "the pitch diameter, 28.5 mm as the catalogue has it; chaotic",
            PRINTED_PITCH: AS_TABLE_1,
        },
    ),
    Measure(
        "ball and cage",
        "peak_indentation_ball_cage_um",
        {"caged detailed": 20.1},
        {"caged detailed": "undamped contacts with the cage, k = 1e8 N/m^1.5; chaotic"},
    ),
)

FURTHER = (
    Measure("loaded balls at the end", "loaded_balls_end", {"cageless detailed": 7, "caged detailed": 2}),
    Measure("loaded balls, mean of the last fifth", "loaded_balls_mean", {}),
    Measure("first-impact ball force [N]", "first_impact_ball_force_N", {}),
    Measure("ring reaches the rotor's speed [s]", "ring_sync_time_s", dict.fromkeys(SCENES, 0.1)),
    Measure("pendulum [Hz]", "pendulum_frequency_Hz", dict.fromkeys(SCENES, 28.0)),
    Measure("rotor speed at the end [rpm]", "rotor_speed_end_rpm", {}),
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
