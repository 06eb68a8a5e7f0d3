"""Table 7: greatest indentations between the bodies of the four models."""

from __future__ import annotations

import statistics

from touchdown.master.studies.dissertation.bearings import (
    MEMBERS,
    READINGS,
    STEP_APART,
    TABLE_7,
    member,
    values_of,
)
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

DURATION = 5.0  # s
NEAR = 0.03
CHAOTIC = {"ball and ball", "ball and cage"}
NEAR_CHAOTIC = 0.3  # of the ensemble's median


def table_7(drops: Drops) -> Exhibit:
    """Medians over drops whose balls start 1e-7 rad apart; `touchdown compare-bearings` takes more."""
    scenes = {
        name: [member(model, k, DURATION, settings) for k in range(MEMBERS)]
        for name, (model, settings) in READINGS.items()
    }
    drops.of([scene for scenes_of in scenes.values() for scene in scenes_of])
    rows: list[Row] = []
    for quantity in TABLE_7:
        for name, source in quantity.source.items():
            values = values_of([run.summary for run in drops.of(scenes[name])], quantity.key)
            near = NEAR_CHAOTIC if quantity.title in CHAOTIC else NEAR
            rows.append(
                Row(
                    f"{quantity.title}, {name} [um]",
                    source,
                    statistics.median(values),
                    near,
                    why=quantity.hinges_on.get(name, ""),
                )
            )
    return Exhibit(None, rows, [f"medians of {MEMBERS} drops, balls {STEP_APART:g} rad apart at the start"])
