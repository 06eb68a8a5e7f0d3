"""Fig 14: orbits of rotor I on bearings out of line, and whether it whirls."""

from __future__ import annotations

from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import PHASES, Drops, at_phases
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.exhibits.whirls import orbit_sheets, verdict_row
from touchdown.master.studies.dissertation.fig_14 import DURATION, SOURCE, SPEEDS

NOTES = [
    f"verdicts over {PHASES} phases of the unbalance; `touchdown compare-rotors` counts finer",
    "the pictures are of 9000 rpm and the first phase",
    "the source does not state the speed: both of its rig's are counted",
    "rolling resistance of the balls, 0.011, fitted to the run-down of Fig 15",
]


def fig_14(drops: Drops) -> Exhibit:
    """The four misalignments at both speeds."""
    cases = [(speed, offset) for speed in SPEEDS for offset in SOURCE]
    scenes = {case: at_phases(_scene(*case)) for case in cases}
    drops.of([scene for members in scenes.values() for scene in members])
    runs = {case: drops.of(members) for case, members in scenes.items()}
    rows: list[Row] = [
        verdict_row(f"{speed} rpm, bearings off by -+{offset} um", SOURCE[offset], members)
        for (speed, offset), members in runs.items()
    ]
    slow = [members[0] for (speed, _), members in runs.items() if speed == SPEEDS[0]]
    return Exhibit(orbit_sheets(slow, 2), rows, NOTES)


def _scene(speed: int, offset: int):
    name = f"rotor1-{speed}" + (f"-{offset}um" if offset else "")
    return load_scene(name).set({"run.duration": DURATION})
