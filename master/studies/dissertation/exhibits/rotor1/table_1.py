"""Table 1: dimensions of the touchdown bearings of sections 4.1 and 4.3."""

from __future__ import annotations

from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

SCENES = {"6004": "disk-caged-detailed", "6904": "disk-cageless-detailed"}
QUANTITIES = (  # title, variable of the bearing, how many of its units make one of the table's
    ("pitch diameter [mm]", "balls.pitch_diameter", 1e3),
    ("ball diameter [mm]", "balls.diameter", 1e3),
    ("number of balls", "balls.count", 1.0),
    ("diametral clearance of the balls [um]", "balls.play", 2e6),
)
SOURCE = {"6004": (31.0, 6.4, 9.0, 5.0), "6904": (26.1, 4.8, 17.0, 0.0)}
WHY = {
    ("6904", "balls.pitch_diameter"): "17 balls do not fit on 26.1 mm; mean of bore and outside diameter",
    ("6004", "balls.play"): "the 5 um are read as radial play, which gives Table 7 and the loaded balls",
}
SAME = 1e-6


def table_1(drops: Drops) -> Exhibit:
    """What the scenes' bearings have, beside what is printed."""
    rows: list[Row] = []
    for bearing, name in SCENES.items():
        with opened(load_scene(name), in_process=True) as system:
            for (title, variable, factor), printed in zip(QUANTITIES, SOURCE[bearing], strict=True):
                ours = factor * system.value(f"bearing.{variable}")
                why = WHY.get((bearing, variable), "")
                rows.append(Row(f"{bearing}: {title}", printed, ours, near=SAME, why=why))
    return Exhibit(None, rows)
