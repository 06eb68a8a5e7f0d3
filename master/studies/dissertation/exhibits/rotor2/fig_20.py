"""Fig 20: bending and shear stress along rotor II in both planes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from touchdown.master.results.ending import Ending
from touchdown.master.results.figures.stress import draw_along
from touchdown.master.results.figures.style import sheet
from touchdown.master.results.stresses import KINDS, MPA, along
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.exhibits.rotor2.cases import CASES, as_read, notes
from touchdown.master.studies.dissertation.first_peak import ending_at_first_peak
from touchdown.master.studies.dissertation.readings import READINGS, SOURCE
from touchdown.master.studies.dissertation.table_4 import SHORT

FIRST_HALF = (1, 13)  # nodes of the non-drive end's half
ONE_DROP = "one phase of the unbalance; Table 4 has the medians"


def fig_20(drops: Drops) -> Exhibit:
    """Stresses along the rotor at the instants of Table 4, one drop of each case."""
    late = [case for case in CASES if not READINGS[case][0].first]
    endings: dict[str, Ending] = {
        case: ending_at_first_peak(as_read(case).set(SHORT)) for case in CASES if case not in late
    }
    endings |= {
        case: run.ending for case, run in zip(late, drops.of(list(map(as_read, late))), strict=True)
    }
    figure = sheet(13.0, 3.4 * len(CASES))
    grid = figure.subplots(len(CASES), len(KINDS), sharex=True)
    for case, row in zip(CASES, grid, strict=True):
        for kind, axes in zip(KINDS, row, strict=True):
            draw_along(axes, endings[case].components["rotor"], kind, kept=True)
            axes.set_title(f"case {case}: {kind}")
    return Exhibit(
        figure, [_where(case, endings[case]) for case in CASES] + _grows(endings), [*notes(), ONE_DROP]
    )


def _where(case: str, told: Ending) -> Row:
    """At which node the vertical bending stress is largest."""
    nodes, values = along(told.components["rotor"], "bending_y")
    node = nodes[int(np.argmax(np.abs(values)))]
    return Row(
        f"case {case}: node of the largest vertical bending stress",
        FIRST_HALF,
        node,
        why='"at the NDE side, near where the lamination ends"',
    )


def _grows(endings: Mapping[str, Ending]) -> list[Row]:
    """Stress by case: the source's grows from 2 to 3b."""
    own = [_largest(endings[case], "bending_y") for case in CASES]
    return [
        Row(
            f"case {case}: largest vertical bending stress [MPa]",
            SOURCE[case][0],
            value,
            near=0.5,
            why=ONE_DROP,
        )
        for case, value in zip(CASES, own, strict=True)
    ]


def _largest(told: Ending, variable: str) -> float:
    return MPA * float(np.max(np.abs(along(told.components["rotor"], variable)[1])))
