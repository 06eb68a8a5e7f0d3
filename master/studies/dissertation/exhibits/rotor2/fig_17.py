"""Fig 17: orbits of rotor II on bearings out of line, and whether it whirls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from touchdown.master.results.result import Result
from touchdown.master.results.summary import relative_orbit
from touchdown.master.studies.dissertation.exhibits.drops import PHASES, Drops, at_phases, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.exhibits.rotor2.cases import (
    CASES,
    WHIRLING,
    as_printed,
    as_read,
    notes,
)
from touchdown.master.studies.dissertation.exhibits.whirls import (
    SETTLES,
    WHIRLS,
    orbit_sheets,
    verdict_row,
)

FITTED = "as the source reads"
BEYOND, RADIUS = 750.0, 1100.0  # um, in case 3b
AS_PRINTED = "with the offsets, the friction and no drag as printed nothing whirls"
DRAG = "the drag that keeps the whirl alive is an assumption, and decides how far it grows"
ASSUMED = "offsets, and in case 3b a drag, are assumed so that it does"
NDE = 0  # the first seat, A


def fig_17(drops: Drops) -> Exhibit:
    """The four cases as the source reads them, drawn; and as printed, counted."""
    readings = {FITTED: as_read, "as printed": as_printed}
    scenes = {(case, how): at_phases(scene(case)) for how, scene in readings.items() for case in CASES}
    drops.of([scene for members in scenes.values() for scene in members])
    rows: list[Row] = []
    for (case, how), members in scenes.items():
        source = WHIRLS if WHIRLING[case] else SETTLES
        row = verdict_row(f"case {case}, {how}", source, drops.of(members), why=AS_PRINTED)
        fitted = WHIRLING[case] and how == FITTED
        rows.append(replace(row, why=ASSUMED) if fitted else row)
    first = {case: drops.of(scenes[case, FITTED])[0] for case in CASES}
    rows += [_bounce(case, first[case]) for case in ("1", "2")]
    rows += _whirl(first["3b"])
    told = [*notes(), f"verdicts over {PHASES} phases of the unbalance; the pictures are of the first"]
    return Exhibit(orbit_sheets(list(first.values()), 2), rows, told)


def _bounce(case: str, run: Result) -> Row:
    """How high the non-drive end bounces, of the clearance."""
    seat = seats_of(run)[NDE]
    _, y = relative_orbit(run.ending, seat, run.recording)
    clearance = run.ending.value(f"{seat.bearing}.clearance")
    landed = run.recording.time > float(str(run.summary[f"first_contact_time_s_{seat.bearing}"]))
    share = float(np.max(y[landed])) / clearance
    return Row(
        f"case {case}: highest bounce at the NDE",
        "very near the top",
        f"{share:+.2f} of the clearance above the middle",
        holds=share > 0.8,
        why="how high it bounces hangs on the phase of the unbalance",
    )


def _whirl(run: Result) -> list[Row]:
    """How far out the whirl of case 3b goes at the non-drive end."""
    seat = seats_of(run)[NDE]
    x, y = (run.recording[seat.motion(axis)] for axis in "xy")
    radius = 1e6 * np.hypot(x, y)
    late = run.recording.time > 0.75 * run.recording.time[-1]
    return [
        Row(
            "case 3b: largest displacement at the NDE [um]",
            (BEYOND, np.inf),
            float(np.max(radius)),
            why=DRAG,
        ),
        Row(
            "case 3b: distance that the whirl keeps, last quarter [um]",
            RADIUS,
            float(np.median(radius[late])),
            near=0.15,
            why=DRAG,
        ),
    ]
