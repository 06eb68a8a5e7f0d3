"""Fig 13: orbits of rotor I in the measured rig."""

from __future__ import annotations

from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.exhibits.whirls import SETTLES, orbit_sheets, verdict_row

DURATION = 0.5  # s
NOTES = [
    "bearings in line: the measured misalignment stands in the source's picture alone",
    "as in the rig, a bearing without a cage at A and one with a cage at B; the source's own c and d have "
    "none with a cage",
]


def fig_13(drops: Drops) -> Exhibit:
    """Parts c and d: simulated at 9000 and 18000 rpm."""
    scenes = [
        load_scene(f"rotor1-measured-{speed}").set({"run.duration": DURATION}) for speed in (9000, 18000)
    ]
    runs = [drops.over_phases(scene, 4) for scene in scenes]
    rows: list[Row] = []
    for part, speed, members in zip("cd", (9000, 18000), runs, strict=True):
        rows.append(verdict_row(f"{part}) {speed} rpm, over phases of the unbalance", SETTLES, members))
        first = members[0].summary["first_contact_time_s_bearing_A"]
        rows.append(Row(f"{part}) {speed} rpm, first contact at A [ms]", None, 1e3 * float(str(first))))
    return Exhibit(orbit_sheets([members[0] for members in runs], 2), rows, NOTES)
