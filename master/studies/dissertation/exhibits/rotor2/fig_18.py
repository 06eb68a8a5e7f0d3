"""Fig 18: nodes of rotor II, as the surrogate that its stated figures were fitted to."""

from __future__ import annotations

from touchdown.master.results.figures.style import sheet
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.rotor.figure import drawing
from touchdown.master.studies.rotor.report import SPEED, described, find_rotor

NODES = {"touchdown bearing, NDE": ("A", 2), "touchdown bearing, DE": ("B", 25)}
MAGNETS = {"amb_A": (7, 11), "amb_B": (19, 23)}  # laminations between these nodes
UNBALANCES = (1.07, 2.78, 4.56)  # g.mm: axial disc, middle, gear
FITTED = "fitted to it"


def fig_18(drops: Drops) -> Exhibit:
    """Side view to scale, and the nodes and masses that the text states."""
    shaft = described(find_rotor("rotor_II"), SPEED, modes=5).shaft
    figure = sheet()
    drawing(figure, shaft)
    disc = max(shaft.points, key=lambda point: point.polar_inertia)
    rows = [Row(f"node of the {what}", node, shaft.node(name)) for what, (name, node) in NODES.items()]
    rows.append(Row("node of the axial magnetic bearing's disc", 4, disc.node))
    rows += [
        Row(f"node in the middle of {name}, laminations", (low, high), shaft.node(name))
        for name, (low, high) in MAGNETS.items()
    ]
    rows += [
        Row("mass [kg]", 106.0, shaft.mass, near=0.005, why=FITTED),
        Row("polar inertia [kg.m2]", 0.4, shaft.polar_inertia, near=0.005, why=FITTED),
    ]
    for printed, unbalance in zip(UNBALANCES, shaft.unbalances, strict=True):
        rows.append(
            Row(f"unbalance at node {unbalance.node} [g.mm]", printed, 1e6 * unbalance.moment, near=1e-6)
        )
    return Exhibit(figure, rows, ["lengths and diameters are fitted: the drawing's cannot be read"])
