"""Table 3: dimensions of rotor II's touchdown bearings and housings."""

from __future__ import annotations

from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

PLACES = {"A": "6014, NDE", "B": "7914, DE"}
QUANTITIES = (  # title, variable with {} for the seat, units of the table's in one of it, values at A and B
    ("bearings side by side", "bearing_{}.balls.rows", 1.0, (1.0, 2.0)),
    ("number of balls", "bearing_{}.balls.count", 1.0, (11.0, 11.0)),
    ("pitch diameter [mm]", "bearing_{}.balls.pitch_diameter", 1e3, (90.0, 85.0)),
    ("ball diameter [mm]", "bearing_{}.balls.diameter", 1e3, (12.0, 11.7)),
    ("diametral clearance of the balls [um]", "bearing_{}.balls.play", 2e6, (15.0, 9.0)),
    ("radial conformity ratio", "bearing_{}.balls.conformity", 1.0, (1.04, 1.04)),
    ("static load rating of a bearing [N]", "bearing_{}.rolling.static_rating", 1.0, (31000.0, 20900.0)),
    ("damping of the bearings together [N.s/m]", "bearing_{}.damping", 1.0, (300.0, 2.0 * 270.0)),
    ("housing's damping [N.s/m]", "housing_{}.damping", 1.0, (8418.0, 7755.0)),
    ("housing's stiffness [N/m]", "housing_{}.stiffness", 1.0, (67e6, 37e6)),
    ("housing's mass [kg]", "housing_{}.mass", 1.0, (6.61, 10.16)),
    ("clearance of the rotor [mm]", "bearing_{}.clearance", 1e3, (0.25, 0.25)),
)
SAME = 1e-6


def table_3(drops: Drops) -> Exhibit:
    """What the scene's bearings and housings have, beside what is printed."""
    rows: list[Row] = []
    with opened(load_scene("rotor2-case1"), in_process=True) as system:
        for k, (seat, place) in enumerate(PLACES.items()):
            for title, variable, factor, printed in QUANTITIES:
                ours = factor * system.value(variable.format(seat))
                rows.append(Row(f"{place}: {title}", printed[k], ours, near=SAME))
    return Exhibit(None, rows)
