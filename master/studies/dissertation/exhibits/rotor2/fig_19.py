"""Fig 19: bending stress and deflection of rotor II lying on its touchdown bearings."""

from __future__ import annotations

import numpy as np

from touchdown.master.coupling.simulation import opened
from touchdown.master.results.figures.style import sheet
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.rotor.figure import rest
from touchdown.master.studies.rotor.report import SPEED, described, find_rotor

MOTOR = (323.5, 571.4)  # mm, the surrogate's middle part
ZERO = 1e-3  # of the largest stress


def fig_19(drops: Drops) -> Exhibit:
    """The rotor at rest; how far its bearings give way stands in the rows."""
    portrait = described(find_rotor("rotor_II"), SPEED, modes=5)
    lying, shaft = portrait.rest, portrait.shaft
    assert lying is not None
    figure = sheet()
    rest(figure, portrait)
    stress = np.abs(lying.bending)
    largest = float(np.max(stress))
    middle = (1e3 * lying.position > MOTOR[0]) & (1e3 * lying.position < MOTOR[1])
    ends = float(max(stress[0], stress[-1])) / largest
    inside = float(np.max(stress[middle])) / largest
    sag_a, sag_b = _sag(*lying.reactions)
    length = float(shaft.positions()[-1])
    towards = shaft.centre_of_mass / length
    rows = [
        Row("bending stress at the ends", "zero", f"{ends:.1g} of the largest", holds=ends < ZERO),
        Row(
            "bending stress in the motor's part", "low", f"{inside:.2f} of the largest", holds=inside < 0.5
        ),
        Row(
            "centre of mass",
            "on the NDE side",
            f"at {towards:.2f} of the length from the NDE",
            holds=towards < 0.5,
            why="of the surrogate, whose lengths are fitted" if towards >= 0.5 else "",
        ),
        Row(
            "bearings' nodes give way",
            "not equally",
            f"NDE {sag_a:.2f}, DE {sag_b:.2f} um on the housings' springs",
            holds=abs(sag_a - sag_b) > 0.1 * max(sag_a, sag_b),
        ),
        Row("largest bending stress [MPa]", None, 1e-6 * largest),
    ]
    return Exhibit(figure, rows, ["the picture holds the seats rigidly; lengths and diameters are fitted"])


def _sag(load_a: float, load_b: float) -> tuple[float, float]:
    """How far the housings' springs give way under loads (N) at both ends (um)."""
    with opened(load_scene("rotor2-case1"), in_process=True) as system:
        a, b = (system.value(f"housing_{seat}.stiffness") for seat in "AB")
    return 1e6 * load_a / a, 1e6 * load_b / b
