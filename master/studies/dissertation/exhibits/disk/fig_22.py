"""Fig 22: friction coefficients with Stribeck effect (Makkar et al.), as the models compute them."""

from __future__ import annotations

import numpy as np

from touchdown.bearings.contact.friction import FrictionLaw, coefficient, settle
from touchdown.master.results.figures.style import BLUE, GREY, ORANGE, sheet
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.modelkit.variables import as_record

CONTACTS = (  # as the source colours them, with its static and its sliding coefficient
    ("balls, balls and cage", BLUE, 0.03, 0.02),
    ("balls and rings, rotor and ring", ORANGE, 0.15, 0.10),
)
SPEEDS = np.linspace(-1.0, 1.0, 1601)  # m/s
PLATEAU = 1.0  # m/s, where what rises is done
VISCOUS = "the viscous term of 1e-4 s/m, at 1 m/s"


def fig_22(drops: Drops) -> Exhibit:
    """Both curves; g1 is found from the peak, the other constants but g4 are assumed (g2, g3, g5)."""
    figure = sheet(9.0, 5.0)
    axes = figure.subplots()
    rows: list[Row] = []
    for name, colour, static, sliding in CONTACTS:
        law = np.array([as_record(FrictionLaw(static=static, dynamic=sliding))]).view(np.recarray)[0]
        settle(law)
        curve = np.array([coefficient(speed, law) for speed in SPEEDS])
        axes.plot(SPEEDS, curve, color=colour, lw=1.6, label=name)
        axes.axhline(static, color=GREY, lw=0.8, ls="--")
        axes.axhline(sliding, color=GREY, lw=0.8, ls=":")
        rows += [
            Row(f"{name}: static, the peak [1]", static, float(np.max(curve)), near=0.001),
            Row(f"{name}: sliding [1]", sliding, coefficient(PLATEAU, law), near=0.01, why=VISCOUS),
        ]
    axes.set_xlabel("sliding speed [m/s]")
    axes.set_ylabel("friction coefficient [1]")
    axes.set_title(
        "friction of section 4.3; dashed and dotted: the source's static and sliding coefficients"
    )
    axes.legend(loc="lower right")
    notes = ["slopes g2 = g5 = 100 s/m and g3 = 10 s/m are assumed, g1 follows from the peak"]
    return Exhibit(figure, rows, notes)
