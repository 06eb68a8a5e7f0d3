"""Fig 12: rotor I, as the surrogate that its stated masses, inertias and first frequency were fitted to."""

from __future__ import annotations

from touchdown.master.coupling.simulation import opened
from touchdown.master.results.figures.style import sheet
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.rotor.figure import drawing
from touchdown.master.studies.rotor.report import SPEED, described, find_rotor

SURROGATE = "lengths and diameters are fitted: the drawing's cannot be read"
FITTED = "fitted to it"


def fig_12(drops: Drops) -> Exhibit:
    """Side view to scale, and what the text states of the machine."""
    portrait = described(find_rotor("rotor_I"), SPEED, modes=5)
    shaft = portrait.shaft
    figure = sheet()
    drawing(figure, shaft)
    rows = [
        Row("mass [kg]", 3.3, shaft.mass, near=0.005, why=FITTED),
        Row("polar inertia [kg.m2]", 0.001, shaft.polar_inertia, near=0.005, why=FITTED),
        Row("diametral inertia [kg.m2]", 0.017, shaft.diametral_inertia, near=0.005, why=FITTED),
        Row("first bending frequency [Hz]", 1600.0, float(portrait.frequencies[2]), near=0.01, why=FITTED),
        Row("unbalance [g.mm]", 3.0, 1e6 * sum(one.moment for one in shaft.unbalances), near=1e-6),
        *_machine(),
    ]
    return Exhibit(figure, rows, [SURROGATE])


def _machine() -> list[Row]:
    """What the scene sets of housings and contact."""
    with opened(load_scene("rotor1-9000"), in_process=True) as system:
        value = system.value
        return [
            Row("clearance [mm]", 0.3, 1e3 * value("bearing_A.clearance"), near=1e-6),
            Row("housing's stiffness [N/m]", 2.5e8, value("housing_A.stiffness"), near=1e-6),
            Row("housing's damping [N.s/m]", 2500.0, value("housing_A.damping"), near=1e-6),
            Row("housing's mass [kg]", 5.0, value("housing_A.mass"), near=1e-6),
            Row("contact stiffness [N/m^(10/9)]", 2.4e9, value("bearing_A.contact.stiffness"), near=1e-6),
            Row(
                "dissipation of the contact [s/m]", 0.12, value("bearing_A.contact.dissipation"), near=1e-6
            ),
        ]
