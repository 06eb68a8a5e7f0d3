"""Results of sweeps, and their folders: written, read back at any time, put together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, overload

from ....modelkit.kernel.writing import replacing_by_name
from ...common.errors import Ended, TouchdownError
from ...common.files import writing_to
from ...results.folder import claimed
from . import definition
from .definition import Definition, differences, read_definition
from .members import MEMBERS_FILE, Member, read_journal, write_journal
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

    @cached_property
    def data(self) -> xarray.Dataset:
        """All figures over the dimension `member`, and settings in SI; `units` as attributes."""
        from .dataset import dataset

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
    with replacing_by_name(folder / DATASET) as made:
        sweep.data.to_netcdf(made, engine="h5netcdf")
    write_table(sweep.members, folder / TABLE)


def read(folder: Path) -> Sweep:
    """The sweep in `folder` as it is now, also while it runs. Raises TouchdownError where there is none."""
    asked = read_definition(folder)
    members = _read_members(folder, asked)
    return _assembled(asked, members, folder)


def merge(folders: Iterable[Path], folder: Path | None) -> Sweep:
    """The sweeps in `folders`, parts of one, as one; `folder`: where it is written, and may go on.

    What `folder` has of it already is taken, too. Raises TouchdownError where they are of different
    sweeps, or have different figures for a member.
    """
    parts = list(folders)
    if folder is not None and (folder / definition.DEFINITION_FILE).exists() and folder not in parts:
        parts.append(folder)
    if not parts:
        raise TouchdownError("nothing to merge; name a folder of a sweep")
    if len(parts) == 1 and folder is None:
        return read(parts[0])
    asked = read_definition(parts[0]).unsharded
    members: dict[int, Member] = {}
    for part in parts:
        if found := differences(read_definition(part).unsharded, asked):
            raise TouchdownError(
                f"{part} and {parts[0]} are of different sweeps: {'; '.join(found)}; leave one of them out"
            )
        _take(members, _read_members(part, asked), part)
    if folder is None:
        return _assembled(asked, members, parts[0])
    with claimed(folder), writing_to(folder):
        _take(members, _read_members(folder, asked), folder)  # what a sweep added there before it ended
        merged = _assembled(asked, members, folder)
        asked.write(folder)
        write_journal(folder / MEMBERS_FILE, [members[n] for n in sorted(members)])
        write_results(merged, folder)
    return merged


def _assembled(asked: Definition, members: dict[int, Member], folder: Path) -> Sweep:
    every = (
        members.get(n) or Member(n, asked.settings(n), {}, NOT_RUN, Ended.INTERRUPTED)
        for n in asked.numbers
    )
    return Sweep(asked, tuple(every), folder)


def _read_members(folder: Path, asked: Definition) -> dict[int, Member]:
    return read_journal(folder / MEMBERS_FILE, asked.by_number).members


def _take(members: dict[int, Member], more: dict[int, Member], source: Path) -> None:
    """Add members of another folder; of one that is in both, the one that did not fail."""
    for number, member in more.items():
        known = members.get(number)
        if known is None or known.failed:
            members[number] = member
        elif not member.failed and member.summary != known.summary:
            one, other = known.summary, member.summary
            key = next(key for key in {**one, **other} if one.get(key) != other.get(key))
            raise TouchdownError(
                f"member {number} is not the same in {source} as in the folders before: {key} is "
                f"{other.get(key)}, not {one.get(key)}; leave one of them out"
            )
