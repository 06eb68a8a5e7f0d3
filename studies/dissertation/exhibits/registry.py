"""Which figures and tables of the source there are, made one by one or all."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import cast

from ....master.common.errors import TouchdownError, one_of
from ....master.common.progress import SILENT_PROGRESS, Progress
from ....reports.figures.style import darkened, styled
from .exhibit import Drops, Exhibit


@dataclass(frozen=True)
class Entry:
    """A figure or table that the models give."""

    name: str  # as it is asked for: "25", "table7"
    title: str
    module: str  # below this package; its function fig_NUMBER or table_NUMBER makes the exhibit

    @property
    def heading(self) -> str:
        """As the source calls it."""
        return heading(self.name)

    @property
    def key(self) -> str:
        """Of its function and its files: fig_25, table_7."""
        return self.heading.lower().replace(" ", "_")

    def make(self, drops: Drops) -> Exhibit:
        """Run what it needs and draw it. Raises TouchdownError where a run stops."""
        module = import_module(f"{__package__}.{self.module}")
        return cast("Callable[[Drops], Exhibit]", getattr(module, self.key))(drops)


ENTRIES = (
    Entry("12", "rotor I, its masses and where it is held", "rotor1"),
    Entry("13", "orbits of rotor I on the bearings of the measured rig, at both speeds", "rotor1"),
    Entry("14", "orbits of rotor I, bearings out of line by 0 to 450 um", "rotor1"),
    Entry("15", "spectra of rotor I running down for 16 s", "rotor1"),
    Entry("17", "orbits of rotor II, bearings out of line by 0 to 200 um", "rotor2"),
    Entry("18", "rotor II, its nodes and masses", "rotor2"),
    Entry("19", "rotor II lying on its touchdown bearings", "rotor2"),
    Entry("20", "stresses along rotor II in the drop", "rotor2"),
    Entry("22", "friction coefficients over sliding speed", "disk_motion"),
    Entry("23", "orbits of rotor and rings, bearing without a cage", "disk_motion"),
    Entry("24", "orbits of rotor, rings and cage, caged bearing", "disk_motion"),
    Entry("25", "circumferential speeds, bearing without a cage", "disk_motion"),
    Entry("26", "circumferential speeds, caged bearing", "disk_motion"),
    Entry("27", "which balls are pressed after 5 s", "disk_forces"),
    Entry("28", "spectrum of the inner ring's velocity, bearing without a cage", "disk_forces"),
    Entry("29", "the same at three rotor speeds", "disk_forces"),
    Entry("30", "contact forces, simplified caged bearing", "disk_forces"),
    Entry("31", "contact forces, detailed caged bearing", "disk_forces"),
    Entry("32", "contact forces, simplified bearing without a cage", "disk_forces"),
    Entry("33", "contact forces, detailed bearing without a cage", "disk_forces"),
    Entry("table1", "dimensions of the 6004 and the 6904", "rotor1"),
    Entry("table2", "bending frequencies of rotor II", "rotor2"),
    Entry("table3", "dimensions of rotor II's bearings and housings", "rotor2"),
    Entry("table4", "largest stresses in rotor II", "rotor2"),
    Entry("table5", "degrees of freedom of the bearing models", "disk_forces"),
    Entry("table6", "elastic contacts of the bearing models", "disk_forces"),
    Entry("table7", "greatest indentations in the four bearing models", "disk_forces"),
)

BEYOND = (
    Entry(
        "bearings", "the four bearing models, Table 7 and more with the spread over drops", "disk_forces"
    ),
    Entry("options", "what the bearing models' options change in Table 7", "disk_forces"),
    Entry(
        "rotors",
        "shares of phases that whirl (Fig 14), readings of Table 4 and what they hinge on",
        "rotors",
    ),
)
"""Larger studies beside the source's figures, made by name alone."""

ILLUSTRATION, SKETCH = "an illustration of the machine", "a sketch that explains the method"
ABSENT: Mapping[str, str] = {
    **dict.fromkeys("12", ILLUSTRATION),
    **{str(number): SKETCH for number in range(3, 12)},
    "16": "a sketch of how the rotor was measured",
    "21": "a sketch of the models' contacts; they are counted with Table 6",
}
"""Figures that no model gives, and why."""


def heading(name: str) -> str:
    """As the source calls a figure or table."""
    if not name[-1].isdigit():
        return name.capitalize()
    return f"Table {name.removeprefix('table')}" if name.startswith("table") else f"Fig {name}"


def entry(name: str) -> Entry:
    """The figure or table of that name; "Fig 25" and "table_7" are understood.

    Raises TouchdownError for one that the models do not give, with the reason.
    """
    short = name.lower()
    for part in ("figure", "fig", ".", "_", "-", " "):
        short = short.replace(part, "")
    entries = {one.name: one for one in (*ENTRIES, *BEYOND)}
    if short in entries:
        return entries[short]
    if short in ABSENT:
        raise TouchdownError(f"figure {short} is {ABSENT[short]}; `touchdown figure` lists those there are")
    raise TouchdownError(f"the source has no figure {name}; {one_of(short, entries)}")


@contextmanager
def dropping(
    jobs: int, progress: Progress = SILENT_PROGRESS, members: int | None = None
) -> Iterator[Drops]:
    """Drops whose recordings are gone at the end."""
    with tempfile.TemporaryDirectory(prefix="touchdown_") as folder:
        yield Drops(Path(folder), jobs, progress, members)


def make(entry: Entry, drops: Drops, dark: bool = False) -> Exhibit:
    """One exhibit. Raises TouchdownError where a run stops."""
    with styled():
        exhibit = entry.make(drops)
    if dark and exhibit.figure is not None:
        darkened(exhibit.figure)
    return exhibit


def make_all(
    entries: Iterable[Entry], drops: Drops, dark: bool = False
) -> dict[Entry, Exhibit | TouchdownError]:
    """All of them, each with what it is or why it failed; drops are run once."""
    made: dict[Entry, Exhibit | TouchdownError] = {}
    for entry in entries:
        try:
            made[entry] = make(entry, drops, dark)
        except TouchdownError as error:
            made[entry] = error
    return made
