"""Which touchdown bearing is best: those of the catalogue in one scene, ranked by what the scene requires.

Every bearing, and every mount, takes the same drops: drawn by a Latin hypercube over the phase of the
unbalance, friction and clearance. Ranked first by the share of drops that keep to all requirements, then by
the worst margin of each drop, in the median. A drop that fails keeps to none.

The journal and its clearance stay; where a bearing's bore is wider, a sleeve is taken to fill the rest.
What `touchdown new` derives from the bearing and the landing is derived anew for each.
"""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from operator import mul
from pathlib import Path
from statistics import median
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, get_type_hints

from ...bearings.catalogue import Bearing, speed_limits
from ...bearings.catalogue.landing import landing
from ...bearings.catalogue.load_sharing import harmonics_worth
from ...master.common.errors import Ended, TouchdownError, one_of
from ...master.common.files import write_records
from ...master.common.text import aligned, percent
from ...master.coupling.simulation import opened
from ...master.quantities import Owner, values_of
from ...master.results.required import margin_words, of_drops
from ...master.results.whirl.evidence import touched
from ...master.results.whirl.verdict import Share, clopper_pearson
from ...master.scene.file import read_settings
from ...master.scene.requirements import KINDS, limited
from ...master.scene.scene import Scene
from ...modelkit.reader import text_of
from ..sweep.design import Design
from ..sweep.members import Member
from ..sweep.report import failures, warned
from .bearings import find_bearing
from .machine_design import GRAVITY, rounded

if TYPE_CHECKING:
    import pandas

PHASES = (0.0, 2.0 * math.pi)  # rad


@dataclass(frozen=True)
class Spread:
    """How drops differ: parts of the scene's values to either side."""

    drops: int = 12
    friction: float = 0.3
    clearance: float = 0.1
    seed: int = 0


@dataclass(frozen=True)
class _Seat:
    """A touchdown bearing of the scene, as set."""

    component: str
    journal_radius: float  # m
    clearance: float  # m
    friction: float
    is_line: bool  # contact of journal and bore by geometry
    is_spatial: bool = False  # its bearing takes a contact angle
    speed: float = 0.0  # rad/s, of the fastest rotor at the start


@dataclass(frozen=True)
class Candidate:
    """A bearing in a mount."""

    bearing: str
    mount: str  # "" for the scene's own
    settings: Mapping[str, object]
    speed_factor: float = 0.0  # m rad/s, bore times the rotor's speed
    cages: tuple[str, ...] = ()  # that makers run so fast for long


@dataclass(frozen=True)
class _Ranked:
    """A candidate and what its drops were worth."""

    candidate: Candidate
    members: tuple[Member, ...]

    @property
    def passing(self) -> Share:
        """Share of drops that keep to all requirements, with its interval."""
        return clopper_pearson(sum(m.meets for m in self.members), len(self.members))

    @property
    def failed(self) -> int:
        """Drops that did not come to an end."""
        return sum(bool(m.failed) for m in self.members)

    @property
    def worst(self) -> tuple[float, str]:
        """Median over drops of their worst margin, and which requirement that mostly is of."""
        found = [min(_margins(m), default=NOTHING) for m in self.members]
        names = [name for _, name in found if name]
        most = max(set(names), key=names.count) if names else ""
        return median(margin for margin, _ in found), most


NOTHING = (-math.inf, "")  # margin, and of which requirement


def _margins(member: Member) -> list[tuple[float, str]]:
    """Margin and name of each requirement; -inf where a drop does not tell it. None of one that failed."""
    if member.failed:
        return []
    found = values_of(member.summary, "margin", Owner.REQUIREMENT)
    return [(-math.inf if margin is None else margin, name) for name, margin in found.items()]


def seats_of(scene: Scene) -> tuple[list[_Seat], str | None]:
    """Touchdown bearings that take a preset, and the rotor's setting of its phase, where it has one.

    Raises TouchdownError where there is no such bearing.
    """
    with opened(scene, in_process=True) as system:
        speeds = [f"{name}.speed" for name in scene.components]
        fastest = max((abs(system.value(name)) for name in speeds if name in system), default=0.0)
        seats = [
            _Seat(
                name,
                system.value(f"{name}.journal_radius"),
                system.value(f"{name}.clearance"),
                system.value(f"{name}.friction.dynamic"),
                f"{name}.contact.law" in system and system.value(f"{name}.contact.law") == 1.0,
                f"{name}.balls.contact_angle" in system,
                fastest,
            )
            for name in scene.components
            if f"{name}.balls.count" in system and f"{name}.journal_radius" in system
        ]
        angles = [f"{name}.unbalance_angle" for name in scene.components]
        angle = next((name for name in angles if name in system), None)
    if not seats:
        raise TouchdownError(f"scene {scene.name} has no ball bearing to rank")
    return seats, angle


def candidates(
    scene: Scene,
    seats: Sequence[_Seat],
    names: Sequence[str],
    mounts: Mapping[str, Mapping[str, object]],
    at: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> list[Candidate]:
    """Every bearing in every mount; with some `at` seats of their own every combination.

    names: of all other seats. Raises TouchdownError where the journal does not go into one.
    """
    weight = _landed_weight(scene, len(seats))
    groups = [([_seat_named(key, scene, seats)], tuple(chosen), f"{key}=") for key, chosen in at.items()]
    taken = [seat for few, _, _ in groups for seat in few]
    if twice := [seat.component for seat in taken if taken.count(seat) > 1]:
        raise TouchdownError(f"--at names {twice[0]} twice; give it once")
    if others := [seat for seat in seats if seat not in taken]:
        groups += [(others, tuple(names), "others=" if at else "")] if names else []
    for _, chosen, _ in groups:
        if twice := sorted({name for name in chosen if chosen.count(name) > 1}):
            raise TouchdownError(f"{'--at' if at else '--bearings'} has {twice[0]} twice; name it once")
    found: list[Candidate] = []
    tried = dict(mounts) or {"": dict[str, object]()}
    speed = max(seat.speed for seat in seats)
    for combination in product(*(chosen for _, chosen, _ in groups)):
        bearings = [find_bearing(name, scene.folder) for name in combination]
        settings: dict[str, object] = {}
        for (few, _, _), name, bearing in zip(groups, combination, bearings, strict=True):
            for seat in few:
                settings |= _taken(scene, seat, name, bearing, weight)
        titles = (f"{where}{name}" for (_, _, where), name in zip(groups, combination, strict=True))
        fastest = max(speed_limits.speed_factor(bearing, speed) for bearing in bearings)
        runs = [speed_limits.cages_for(bearing, speed) for bearing in bearings]
        cages = tuple(cage for cage in runs[0] if all(cage in others for others in runs))
        title = ", ".join(titles)
        found += [
            Candidate(title, mount, {**settings, **changes}, fastest, cages)
            for mount, changes in tried.items()
        ]
    return found


def _seat_named(key: str, scene: Scene, seats: Sequence[_Seat]) -> _Seat:
    """The seat of a bearing, or of the rotor's port at it. Raises TouchdownError where there is none."""
    journals = [(one, port) for one, port in scene.attach if one.endswith(".journal")]
    ports = {bearing.partition(".")[0]: port.rpartition(".")[2] for bearing, port in journals}
    for seat in seats:
        if key in (seat.component, ports.get(seat.component)):
            return seat
    known = [ports.get(seat.component, seat.component) for seat in seats]
    raise TouchdownError(f"--at {key}: there is no such seat; {one_of(key, known)}")


def _taken(scene: Scene, seat: _Seat, name: str, bearing: Bearing, weight: float) -> dict[str, object]:
    """Settings of a seat that takes a bearing. Raises TouchdownError where it cannot."""
    bore = 2.0 * (seat.journal_radius + seat.clearance)
    if bearing.bore < bore * (1.0 - 1e-9):
        raise TouchdownError(
            f"{name} has a bore of {1e3 * bearing.bore:g} mm; journal and clearance at "
            f"{seat.component} take {1e3 * bore:g} mm; leave it out, or change the journal"
        )
    if bearing.angle_in_drops > 0.0 and not seat.is_spatial:
        raise TouchdownError(
            f"{name} is a pair with a contact angle, and {seat.component} is planar; set "
            f"{seat.component}'s fmu to angular_simplified in the scene, or leave {name} out"
        )
    settings = {f"{seat.component}.preset": name} | _fitted(bearing, seat, weight)
    kept = scene.components[seat.component].set
    if "damping" in kept:  # the scene's for each bearing whose catalogue has none: one assumption
        settings[f"{seat.component}.damping"] = bearing.damping or kept["damping"]
    return settings


def _landed_weight(scene: Scene, seats: int) -> float:
    """On each touchdown bearing (N), in equal parts: of the masses that scale the scene's energy."""
    with opened(scene, in_process=True) as system:
        system.initialise()  # a rotor of a file has its mass from then on
        named = [name for name in scene.energy_scale if name.endswith(".mass")]
        masses = [system.value(name) for name in named if name in system]
    return sum(masses) * GRAVITY / seats


def _fitted(bearing: Bearing, seat: _Seat, weight: float) -> dict[str, object]:
    """Settings that depend on the bearing where its contacts follow from geometry."""
    if not seat.is_line or weight <= 0.0:
        return {}
    sleeved = replace(bearing, bore=2.0 * (seat.journal_radius + seat.clearance))
    hit = landing(sleeved, seat.clearance, weight * seat.clearance)
    return {
        f"{seat.component}.contact.load": rounded(hit.load, down=True),
        f"{seat.component}.balls.expected_indentation": hit.indentation,
        f"{seat.component}.ring.harmonics": harmonics_worth(sleeved, hit.load)[0],
    }


def _design(
    seats: Sequence[_Seat], angle: str | None, chosen: Sequence[Candidate], spread: Spread
) -> Design:
    """All drops of all candidates. Raises TouchdownError for a spread that cannot be."""
    for name in ("friction", "clearance"):
        if not 0.0 <= getattr(spread, name) < 1.0:
            raise TouchdownError(f"{name} = {getattr(spread, name):g}; give a part from 0 to below 1")
    ranges: dict[str, tuple[float, float]] = {} if angle is None else {angle: PHASES}
    for seat in seats:
        for name, value, part in (
            ("friction.dynamic", seat.friction, spread.friction),
            ("clearance", seat.clearance, spread.clearance),
        ):
            if part > 0.0:
                ranges[f"{seat.component}.{name}"] = ((1.0 - part) * value, (1.0 + part) * value)
    drops = Design.latin(ranges, spread.drops, spread.seed)
    return mul(Design.table([one.settings for one in chosen]), drops)


def ranked(chosen: Sequence[Candidate], members: Sequence[Member]) -> list[_Ranked]:
    """The candidates, the best first; members: in the order of `_design`."""
    each = len(members) // len(chosen)
    found = [_Ranked(one, tuple(members[k * each : (k + 1) * each])) for k, one in enumerate(chosen)]
    return sorted(found, key=lambda one: (one.passing.value, one.worst[0]), reverse=True)


class Row(NamedTuple):
    """A candidate in the ranking, as `rank.csv` has it."""

    place: int
    bearing: str
    mount: str
    drops: int
    failed: int
    share: float  # of drops that keep to all requirements
    share_low: float
    share_high: float
    worst_requirement: str
    worst_margin_median: float
    speed_factor_mm_rpm: float
    cages: str  # that makers run so fast for long


HEAD = "bearing", "meets all", "worst requirement, median margin", "d n, mm rpm", "cages for that"


def rows_of(found: Sequence[_Ranked]) -> list[Row]:
    """The ranking, the best first."""
    return [
        Row(
            place,
            one.candidate.bearing,
            one.candidate.mount,
            len(one.members),
            one.failed,
            *one.passing,
            one.worst[1],
            one.worst[0],
            one.candidate.speed_factor / speed_limits.MM_RPM,
            "; ".join(one.candidate.cages),
        )
        for place, one in enumerate(found, start=1)
    ]


def answer(first: Row) -> str:
    """What the ranking comes to, by its first row."""
    title, share, worst, *_ = cells(first)
    if first.share == 1.0:
        return f"{title} ranks first: it meets all requirements in each of its {first.drops} drops."
    return (
        f"None meets all requirements in every drop; closest is {title}, in {share} of its drops; worst "
        f"requirement, median margin: {worst}."
    )


def _margin_shown(margin: float) -> str:
    return margin_words(margin) if math.isfinite(margin) else "not known"


def cells(row: Row) -> tuple[str, ...]:
    """A candidate in words, under `HEAD`."""
    share = f"{percent(row.share, 2)} ({percent(row.share_low, 2)} to {percent(row.share_high, 2)})"
    name, shown = row.worst_requirement, _margin_shown(row.worst_margin_median)
    worst = f"{limited(name).words}, {shown}" if name else "-"
    failed = f"; {row.failed} of {row.drops} drops failed" if row.failed else ""
    title = f"{row.bearing} in {row.mount}" if row.mount else row.bearing
    return title, share, worst + failed, f"{row.speed_factor_mm_rpm:,.0f}", row.cages or "none"


def notes(found: Sequence[_Ranked]) -> Iterator[str]:
    """Notes on the table: its assumptions, and the failures and warnings of drops."""
    yield from assumptions([one.candidate for one in found])
    members = sorted((m for one in found for m in one.members), key=lambda m: m.number)
    ended = [m for m in members if not m.failed]
    if untouched := sum(not touched(m.summary) for m in ended):
        part = f"{untouched} of {len(ended)} drops"
        yield f"{part} ended before the rotor touched a bearing; give a longer --duration"
    for what, lines in (("failed:", failures(members)), ("warnings:", warned(members))):
        if lines:
            yield from (what, *lines)


def assumptions(chosen: Sequence[Candidate]) -> Iterator[str]:
    """The assumptions of the ranking."""
    if len(chosen) > 1:
        yield "all take the same drops; an interval is of a bearing's own drops alone"
    if fast := sorted({one.bearing for one in chosen if not one.cages and one.speed_factor > 0.0}):
        yield (
            f"{', '.join(fast)}: faster than makers run any cage for long; ask the maker, whose limits for "
            "seconds are higher (`touchdown catalogue NAME --speed`)"
        )
    mounts = {one.mount: set(one.settings) for one in chosen if one.mount}
    bearing_keys = set.intersection(*mounts.values()) if mounts else set[str]()
    for mount, names in mounts.items():
        others = set.union(*mounts.values()) - names - bearing_keys
        if others:
            yield f"mount {mount} says nothing of {', '.join(sorted(others))}: the scene's values stay"


TABLE = "rank.csv"


def read_table(folder: Path) -> list[Row]:
    """The ranking in a folder, the best first; none where there is none. Raises TouchdownError."""
    path = folder / TABLE
    if not path.is_file():
        return []
    kinds = get_type_hints(Row)
    try:
        written = csv.DictReader(text_of(path).splitlines(), strict=True)
        table = [Row(**{name: kind(row[name]) for name, kind in kinds.items()}) for row in written]
        if unknown := {row.worst_requirement.partition(".")[0] for row in table} - {"", *KINDS}:
            raise ValueError(unknown)
        return table
    except (ValueError, TypeError, KeyError, csv.Error):
        raise TouchdownError(f"{path} is not as `touchdown rank` leaves it; rank again") from None


@dataclass(frozen=True)
class Ranking:
    """Candidates, the best first."""

    candidates: Sequence[_Ranked]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C kept drops from running."""
        return any(m.ended is Ended.INTERRUPTED for one in self.candidates for m in one.members)

    def lines(self) -> Iterator[str]:
        """The answer, a table for people, and notes on it."""
        yield answer(rows_of(self.candidates)[0])
        for place, line in enumerate(aligned([HEAD, *map(cells, rows_of(self.candidates))])):
            yield f"{place or '':>4}  {line}"
        yield from self._by_mount()
        yield from notes(self.candidates)

    def _by_mount(self) -> Iterator[str]:
        """Where there are several mounts, a table of them: medians over all drops in each."""
        drops: dict[str, list[Member]] = {}
        for one in self.candidates:
            drops.setdefault(one.candidate.mount, []).extend(one.members)
        if len(drops) < 2:
            return
        margins = {mount: [{n: x for x, n in _margins(m)} for m in each] for mount, each in drops.items()}
        names = list(dict.fromkeys(name for each in margins.values() for one in each for name in one))
        rows = [("mount, all bearings", "meets all", *(f"{limited(name).words}, median" for name in names))]
        for mount, each in drops.items():
            told = [[one[name] for one in margins[mount] if name in one] for name in names]
            shown = (_margin_shown(median(values) if values else -math.inf) for values in told)
            rows.append((mount, percent(sum(m.meets for m in each) / len(each), 2), *shown))
        yield from ("", *aligned(rows), "")

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each candidate, as `rank.csv` has it."""
        import pandas

        return pandas.DataFrame(rows_of(self.candidates))

    def write(self, folder: Path) -> None:
        """The ranking as `TABLE` in a folder."""
        write_records([row._asdict() for row in rows_of(self.candidates)], folder / TABLE)


Runner = Callable[[Scene, Design], Sequence[Member]]


def rank(
    scene: Scene,
    names: Sequence[str],
    mounts: Mapping[str, Mapping[str, object]],
    spread: Spread,
    run: Runner,
    at: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> Ranking:
    """Rank bearings of these `names`, each in all `mounts` (settings by name), by what the scene requires.

    at: names for some seats, by the rotor's port or the bearing: every combination is tried. run(scene,
    design) runs a sweep. Raises TouchdownError where nothing is required, or to choose.
    """
    if not of_drops(scene.requirements):
        raise TouchdownError(
            f"scene {scene.name} requires nothing to rank by; add [requirements], such as ball_pressure = "
            f'"2.5 GPa"; {one_of("", KINDS)}'
        )
    if not names and not at:
        raise TouchdownError("--bearings is missing; `touchdown catalogue` lists what there is")
    seats, angle = seats_of(scene)
    chosen = candidates(scene, seats, names, mounts, at)
    return Ranking(ranked(chosen, run(scene, _design(seats, angle, chosen, spread))))


def mounts_in(paths: Sequence[str | os.PathLike[str]]) -> dict[str, dict[str, object]]:
    """Settings by the files' names without ending. Raises TouchdownError where two are the same."""
    found: dict[str, dict[str, object]] = {}
    for path in map(Path, paths):
        if path.stem in found:
            raise TouchdownError(f"--mount {path}: there is a mount {path.stem} already; rename one")
        found[path.stem] = read_settings(path)
    return found
