"""Table 4: largest stresses in rotor II."""

from __future__ import annotations

from collections.abc import Sequence

from touchdown.master.studies.dissertation.ensemble import numbers
from touchdown.master.studies.dissertation.exhibits.drops import PHASES, Drops, at_phases
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.exhibits.rotor2.cases import (
    CASES,
    WHIRLING,
    as_printed,
    as_read,
    notes,
    reading_row,
)
from touchdown.master.studies.dissertation.first_peak import WAIT
from touchdown.master.studies.dissertation.readings import READINGS, SOURCE
from touchdown.master.studies.dissertation.table_4 import (
    COLUMNS,
    HEADERS,
    Ensemble,
    Figures,
    median,
    medians,
)

NEAR = 0.5  # of the source's value
WHIRL_STRESS = "how a whirl's stress lies in the planes is the instant's; in 3b the drag decides how much"
WHOLE = "the later and larger peak, with all modes, friction and offsets as printed"


def table_4(drops: Drops) -> Exhibit:
    """Medians over phases as the source reads each case; then what is largest in the drops as printed."""
    figures = _as_read(drops)
    rows: list[Row] = []
    for case in CASES:
        for header, source, ours in zip(HEADERS, SOURCE[case][:4], medians(figures[case]), strict=True):
            rows.append(
                Row(
                    f"case {case}: {header} [MPa]",
                    source,
                    ours,
                    NEAR,
                    why=WHIRL_STRESS if WHIRLING[case] else "",
                )
            )
    for case in CASES:
        runs = drops.of(at_phases(as_printed(case)))
        largest = median(numbers([run.summary for run in runs], COLUMNS[0]))
        rows.append(Row(f"case {case} as printed: {HEADERS[0]} [MPa]", SOURCE[case][0], largest, why=WHOLE))
        rows.append(reading_row(case, drops.of(at_phases(as_read(case)))))
    return Exhibit(None, rows, [*notes(), f"medians over {PHASES} phases of the unbalance"])


def _as_read(drops: Drops) -> dict[str, Sequence[Figures]]:
    """Of each case the figures of its drops: at the first distinct peak, or at the largest."""
    first = [case for case in CASES if READINGS[case][0].first]
    drops.progress.planned(len(first) * PHASES)
    ensemble = Ensemble(PHASES, drops.folder, drops.jobs, drops.progress.done)
    figures: dict[str, Sequence[Figures]] = dict(
        zip(first, ensemble.to_first_peak([(as_read(case), WAIT) for case in first]), strict=True)
    )
    for case in CASES:
        if case not in first:
            figures[case] = [run.summary for run in drops.of(at_phases(as_read(case)))]
    return figures
