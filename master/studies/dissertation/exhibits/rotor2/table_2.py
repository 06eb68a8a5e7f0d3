"""Table 2: frequencies of the bending modes of rotor II."""

from __future__ import annotations

from touchdown.master.results.figures.style import sheet
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row
from touchdown.master.studies.dissertation.first_peak import BENDING
from touchdown.master.studies.rotor.figure import modes
from touchdown.master.studies.rotor.report import SPEED, described, find_rotor

MEASURED = ((661.0, 670.0), (1096.0, 1130.0), (2406.0, 2427.0), (2857.0, 2895.0))  # Hz, two planes
RIGID = 2


def table_2(drops: Drops) -> Exhibit:
    """The surrogate's, beside the source's simulated and measured ones."""
    portrait = described(find_rotor("rotor_II"), SPEED, modes=RIGID + len(BENDING))
    ours = [float(value) for value in portrait.frequencies[RIGID:]]
    figure = sheet()
    modes(figure, portrait)
    rows = [
        Row(f"bending mode {k + 1}, simulated [Hz]", source, ours[k], near=0.005, why="fitted to it")
        for k, source in enumerate(BENDING)
    ]
    rows += [
        Row(
            f"bending mode {k + 1}, measured [Hz]",
            measured,
            ours[k],
            why="the source's own model differs as much: it is symmetric, the rotor is not quite",
        )
        for k, measured in enumerate(MEASURED)
    ]
    return Exhibit(figure, rows)
