"""Results of sweeps, and their folders: written, and read back at any time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, overload

from ...master.common.errors import Ended
from ...master.scene.file import restored
from ...master.scene.scene import Scene
from ...modelkit.errors import require
from ...modelkit.kernel.writing import replacing_by_name
from .definition import Definition, read_definition
from .members import MEMBERS_FILE, Member, read_journal
from .report import write_table

if TYPE_CHECKING:
    import xarray

    from .maps import MapPlot

DATASET, TABLE = "sweep.nc", "sweep.csv"
NOT_RUN = "not run"


@dataclass(frozen=True, repr=False, eq=False)
class Sweep(Sequence[Member]):
    """Results of a sweep: its members in the order of their numbers.

    A member has its `number`, `settings`, `summary`, how it `ended`, and why it `failed`, or "".
    """

    definition: Definition
    members: tuple[Member, ...]
    folder: Path  # a temporary one, gone by now, where none was asked for

    def __len__(self) -> int:
        return len(self.members)

    @overload
    def __getitem__(self, place: int) -> Member: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[Member]: ...
    def __getitem__(self, place: int | slice) -> Member | Sequence[Member]:
        return self.members[place]

    def __iter__(self) -> Iterator[Member]:
        return iter(self.members)

    def scene(self, number: int) -> Scene:
        """The scene of a member, to run it again. Raises TouchdownError where there is none."""
        asked = self.definition
        require(number in asked.numbers, f"the sweep has drops 1 to {len(asked.points)}, and no {number}")
        scene = asked.at(restored(asked.scene), number)
        return replace(scene, name=f"{scene.name}-{number}")

    def worst(self, quantity: str) -> Member:
        """The member with the worst value of a quantity, by its key or its path; see `survival`."""
        from .survival import worst_member

        return worst_member(self.members, quantity)

    @cached_property
    def data(self) -> xarray.Dataset:
        """All quantities and settings over the dimension `member`, in SI; `units` as attributes."""
        from .sweep_dataset import dataset

        return dataset(self.definition, self.members)

    @property
    def plot(self) -> MapPlot:
        """Pictures over one or two settings: `plot.whirl()`, `capture()`, `force()`, `stress()`."""
        from .maps import MapPlot

        return MapPlot(self.definition, self.members)

    def __repr__(self) -> str:
        ended = ", ".join(f"{count} {how}" for how, count in self.counts.items())
        return f"<Sweep of {self.definition.scene['name']}, {self.definition.about}: {ended}>"

    @property
    def counts(self) -> dict[str, int]:
        """How many members ended how, in words."""
        words = [member.ended.value for member in self.members]
        return {word: words.count(word) for word in dict.fromkeys(words)}


def write_results(sweep: Sweep, folder: Path) -> None:
    """sweep.nc and sweep.csv, older ones replaced when they are whole. Raises OSError."""
    with replacing_by_name(folder / DATASET) as temporary:
        sweep.data.to_netcdf(temporary, engine="h5netcdf")
    write_table(sweep.members, folder / TABLE)


def read(folder: Path) -> Sweep:
    """The present sweep in `folder`, also while it runs. Raises TouchdownError where there is none."""
    asked = read_definition(folder)
    known = read_journal(folder / MEMBERS_FILE, asked.by_number).members
    members = (
        known.get(number) or Member(number, settings, {}, NOT_RUN, Ended.INTERRUPTED)
        for number, settings in asked.by_number.items()
    )
    return Sweep(asked, tuple(members), folder)
