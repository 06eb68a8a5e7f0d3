"""Fig 17: orbits of rotor II on bearings out of line, and whether it whirls."""

from __future__ import annotations

import numpy as np

from touchdown.master.results.result import Result
from touchdown.master.results.summary import relative_orbit
from touchdown.master.studies.dissertation.exhibits.drops import PHASES, Drops, at_phases, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.exhibits.rotor2.cases import (
    CASES,
    as_printed,
    as_read,
    notes,
    printed_row,
    reading_row,
)
from touchdown.master.studies.dissertation.exhibits.whirls import orbit_sheets

BEYOND, RADIUS = 750.0, 1100.0  # um, in case 3b
DRAG = "the drag that keeps the whirl alive is an assumption, and decides how far it grows"
NDE = 0  # the first seat, A


def fig_17(drops: Drops) -> Exhibit:
    """The four cases as the source reads them, drawn; and as printed, counted."""
    read, printed = ({case: at_phases(scene(case)) for case in CASES} for scene in (as_read, as_printed))
    drops.of([scene for members in (*read.values(), *printed.values()) for scene in members])
    runs = {case: drops.of(members) for case, members in read.items()}
    rows = [reading_row(case, members) for case, members in runs.items()]
    rows += [printed_row(case, drops.of(members)) for case, members in printed.items()]
    rows += [_bounce(case, runs[case][0]) for case in ("1", "2")]
    rows += _whirl(runs["3b"][0])
    told = [*notes(), f"verdicts over {PHASES} phases of the unbalance; the pictures are of the first"]
    return Exhibit(orbit_sheets([members[0] for members in runs.values()], 2), rows, told)


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
    largest = float(np.max(radius))
    late = run.recording.time > 0.75 * run.recording.time[-1]
    return [
        Row(
            "case 3b: largest displacement at the NDE [um]",
            (BEYOND, np.inf),
            largest,
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
