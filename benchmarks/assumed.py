"""What depends on the drag and the damping of the balls, which makers of bearings do not state.

Drops with other values of each, two phases of the unbalance: largest contact force and ball load of a
bearing, whether it still whirls at the end, and the whirl that is predicted with these values. Of rotor I
with its bearings out of line, on stiff housings and on soft mounts, and of a machine that `touchdown new`
writes.

    python benchmarks/assumed.py [--duration 0.25]
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from pathlib import Path

import touchdown
from touchdown.master.scene.scene import Scene
from touchdown.studies.rotor.whirl_prediction import machine

DRAG, DAMPING, DISSIPATION = "rolling.resistance", "balls.damping_ratio", "balls.dissipation"
FACTORS = (0.0, 0.5, 1.0, 2.0)  # times the scene's value
RATIOS = (0.0, 0.02, 0.05)  # where the scene has no damping
PHASES = (0, 180)  # deg
SCENES = ("rotor1-18000-225um", "rotor1-18000-225um-soft")


def written(folder: Path) -> Scene:
    """A shaft of rotor I's elements on bearings of the catalogue, as `touchdown new` writes it."""
    touchdown.new(folder / "own", rotor="rotor_I", bearings="6904", amb="amb_A,amb_B", speed="18000 rpm")
    return touchdown.load(folder / "own").set({"housing_A.x0": "225 um", "housing_B.x0": "-225 um"})


def variants(scene: Scene) -> Iterator[tuple[str, Scene]]:
    """Titles and scenes: other drag, then other damping, by the parameter that the scene sets."""
    bearings = [name for name in scene.components if name.startswith("bearing")]
    given = {**scene.components[bearings[0]].inherited, **scene.components[bearings[0]].set}
    drag, dissipation = (float(str(given.get(name, 0.0))) for name in (DRAG, DISSIPATION))
    for factor in FACTORS:
        yield f"{DRAG} = {factor * drag:.4g}", scene.set({f"bearing_*.{DRAG}": factor * drag})
    name, values = (DISSIPATION, [f * dissipation for f in FACTORS]) if dissipation else (DAMPING, RATIOS)
    for value in values:
        yield f"{name} = {value:.3g}", scene.set({f"bearing_*.{name}": value})


def drops(scene: Scene) -> tuple[list[float], list[float], int]:
    """Largest contact force and ball load (N) of each phase, and how many still whirl."""
    forces, balls, lasting = list[float](), list[float](), 0
    for phase in PHASES:
        told = touchdown.run(scene.set({"rotor.unbalance_angle": f"{phase} deg"}), in_process=True).summary
        seats = told["seats"].values()
        forces.append(max(seat["peak_contact_force"] for seat in seats))
        balls.append(max(seat["peak_ball_force"] for seat in seats))
        lasting += any("still" in seat["whirl"] for seat in seats)
    return forces, balls, lasting


def table(scene: Scene) -> None:
    """Print what a scene's figures depend on."""
    print(f"\n{scene.name}")
    head = f"{'':<30}{'contact force [N]':>20}{'ball [N]':>15}{'whirl':>7}"
    print(f"{head}{'predicted [N]':>15}{'ball [N]':>10}")
    for title, there in variants(scene):
        forces, balls, lasting = drops(there)
        told = machine(there).predicted()
        force = f"{told.settled.force.max():.0f}" if told.settled else "none"
        ball = f"{max(told.balls):.0f}" if told.settled else ""
        of_forces, of_balls = (f"{min(values):.0f} to {max(values):.0f}" for values in (forces, balls))
        found = f"{of_forces:>20}{of_balls:>15}{f'{lasting}/{len(PHASES)}':>7}"
        print(f"{title:<30}{found}{force:>15}{ball:>10}", flush=True)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--duration", type=float, default=0.25, help="s, of a drop")
    options = parser.parse_args()
    run = {"run.duration": options.duration, "run.warn_residual": 1e9, "run.stop_residual": 1e9}
    with tempfile.TemporaryDirectory() as folder:
        for scene in (*(touchdown.load(name) for name in SCENES), written(Path(folder))):
            table(scene.set(run))


if __name__ == "__main__":
    main()
