"""How many drops a machine survives, from the drops of a sweep; nothing is run again.

A drop ends it with the probability p that one goes beyond a limit, and takes shares d of what it has, such
as of its bearings' rating lives. Drops leave it as it was in all else. With p drawn from the sweep, and d
from those of its drops that end nothing,

    P(N) = (1 - p)^N P(d_1 + ... + d_N < 1)

p is known to Clopper and Pearson's interval; the sum's distribution is convolved on a grid. Drops that
failed count as beyond the limit, those that ended in the air as within it. Drops of a sweep stand for those
of the machine as far as its settings are drawn as they occur.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.signal import fftconvolve
from scipy.stats import spearmanr

from ...fmus.recipes import fmu_names, recipe
from ...master.common.errors import Ended, TouchdownError, one_of
from ...master.common.text import percent
from ...master.quantities import Item, Quantity, Worse, named, owned, values_of, worst
from ...master.results.settling import BEFORE_A_WHIRL, EARLY, UNSETTLED
from ...master.results.whirl.evidence import touched
from ...master.results.whirl.verdict import Share, clopper_pearson
from ...master.scene.requirements import KINDS, RequirementKind
from ...modelkit.errors import require
from ...modelkit.reader import number
from ...modelkit.variables import flatten
from .definition import Definition
from .members import Member
from .report import items_of, with_interval

LEAST_FOR_THREE = 6  # drops, of which the rule of three says something
CELLS = 16384  # of the grid of shares from 0 to 1
FEWEST = 8  # drops from which on settings are ranked
FEWEST_FOR_INDICES = 64  # and first-order indices told
BINS = 8  # of a setting's values, for its index
DRAWN = ("random", "Latin hypercube", "Sobol")  # samples that settings are drawn independently in
IN_THE_AIR = "in the air"
DAMPING = ("balls.damping_ratio", "balls.dissipation", "balls.damping")  # any one damps balls on races


@dataclass(frozen=True)
class Limit:
    """A limit that no seat, or what else has the quantity, may exceed in a drop."""

    quantity: Quantity
    value: float  # SI
    name: str = ""  # of the one seat, or what else has it, that it is for; "": all

    @property
    def at_least(self) -> bool:
        """Whether it is the least that is allowed."""
        return self.quantity.worse is Worse.SMALLER

    def words(self) -> str:
        """For people."""
        side = "below" if self.at_least else "above"
        value = f"{self.quantity.factor * self.value:g} {self.quantity.read_in}"
        return f"{Item(self.quantity, self.name).words} {side} {value}".rstrip()

    def worst(self, member: Member) -> float | None:
        """The worst value of a drop; None where it has none, or a touched bearing does not tell."""
        return worst(self._seen(member.summary), self.quantity)

    def _seen(self, summary: Mapping[str, Any]) -> Mapping[str, Any]:
        """A summary without other seats, where the limit is for one."""
        alone = {self.name: owned(summary, self.quantity.owner).get(self.name, {})}
        return {**summary, self.quantity.owner: alone} if self.name else summary

    def broken(self, member: Member) -> bool:
        """Whether a drop goes beyond it, or failed, or does not tell though it touched a bearing."""
        if member.failed:
            return True
        found = self.worst(member)
        if found is None:
            return touched(self._seen(member.summary))
        return found < self.value if self.at_least else found > self.value


DEFAULT = Limit(named("lowest_static_safety")[0], 1.0)


@dataclass(frozen=True)
class _Driver:
    """How much the limit's quantity follows a setting."""

    setting: str
    rank: float  # Spearman's correlation, -1 to 1
    index: float | None  # first-order Sobol index; None: the sample tells none


@dataclass(frozen=True)
class Survival:
    """Of drops like those of a sweep."""

    limit: Limit
    broken: int
    count: int
    shares: Mapping[str, np.ndarray]  # by bearing: of its life, what each drop within the limit takes
    untouched: int = 0  # of the count, drops that ended in the air
    early: int = 0  # that ended before a whirl could build up
    unsettled: int = 0  # others that had not settled
    drivers: Sequence[_Driver] = ()  # what the limit depends on, the strongest first
    warnings: Sequence[str] = ()

    @property
    def chance(self) -> Share:
        """The probability that a drop goes beyond the limit, with its interval."""
        return clopper_pearson(self.broken, self.count)

    def after(self, drops: int) -> Share:
        """The probability that the machine survives so many drops, with the interval of the limit's chance.

        Of several bearings each drop takes the largest share: no less than any of them is used up by.
        """
        worst = np.maximum.reduce(list(self.shares.values())) if self.shares else np.empty(0)
        p, used = self.chance, unspent(worst, drops)
        value, low, high = ((1.0 - part) ** drops * used for part in (p.value, p.high, p.low))
        return Share(value, low, high)


def unspent(shares: np.ndarray, drops: int, cells: int = CELLS) -> float:
    """Probability that the sum of `drops` shares, drawn from `shares` (any number), is below 1."""
    if drops < 1 or not len(shares):
        return 1.0
    one, whole = _distribution(shares, cells), None
    while drops:  # by the binary digits of the number; what is beyond 1 is spent, and stays so
        if drops & 1:
            whole = one if whole is None else np.maximum(fftconvolve(whole, one)[:cells], 0.0)
        drops >>= 1
        if drops:
            one = np.maximum(fftconvolve(one, one)[:cells], 0.0)
    assert whole is not None
    return float(min(whole.sum(), 1.0))


def _distribution(shares: np.ndarray, cells: int) -> np.ndarray:
    """Of shares on a grid of `cells` from 0 on, each between two of its places so that means stay."""
    positions = np.asarray(shares, float) * cells
    below = np.floor(positions)
    part = positions - below
    found = np.zeros(cells + 1)
    for place, weight in ((below, 1.0 - part), (below + 1.0, part)):
        inside = place < cells
        np.add.at(found, place[inside].astype(int), weight[inside])
    return found[:cells] / len(positions)


def survival_of(definition: Definition, members: Sequence[Member], limit: str | None = None) -> Survival:
    """From a sweep, with what its limit (`read_limit`; None: `DEFAULT`) depends on."""
    chosen = read_limit(limit, members) if limit else DEFAULT
    by = _drivers(definition, members, chosen)
    return replace(survival(members, chosen), drivers=by, warnings=undamped(definition))


def survival(members: Sequence[Member], limit: Limit = DEFAULT) -> Survival:
    """From the drops of a sweep that were run. Raises TouchdownError where none tells of the limit."""
    run = [m for m in members if m.failed or m.summary]
    run = [m for m in run if m.ended is not Ended.INTERRUPTED]
    if all(m.failed or limit.worst(m) is None for m in run):
        key, keys = limit.quantity.key, {item.quantity.key for item in _told(members)}
        raise TouchdownError(f"no drop of the sweep has a quantity {key}; {one_of(key, keys)}")
    within = [m for m in run if not limit.broken(m)]
    shares = {
        item.name: np.array([1.0 / n if (n := item.of(m.summary)) else 0.0 for m in within])
        for item in items_of(within)
        if item.quantity.key == "drops_until_fatigue"
    }
    ends = Counter("" if m.failed else _ended(m.summary) for m in run)
    left = ends[IN_THE_AIR], ends[EARLY], ends[UNSETTLED]
    return Survival(limit, len(run) - len(within), len(run), shares, *left)


def _ended(summary: Mapping[str, Any]) -> str:
    """What a drop did not come to, by its end; "" where it came to all."""
    if not touched(summary):
        return IN_THE_AIR
    words = [text for text in values_of(summary, "settled").values() if text]
    if words and all(text == EARLY for text in words):
        return EARLY
    return UNSETTLED if any(text.startswith(UNSETTLED) for text in words) else ""


def _told(members: Sequence[Member]) -> list[Item]:
    """The numbers that any member tells."""
    found = [item for item in items_of(members) if item.quantity.unit]
    return [one for one in found if any(one.of(m.summary) is not None for m in members)]


def _drivers(definition: Definition, members: Sequence[Member], limit: Limit) -> list[_Driver]:
    """Settings by how much the limit's quantity follows them, the strongest first; none of few drops."""
    rows = [(m, worst) for m in members if not m.failed and (worst := limit.worst(m)) is not None]
    if len(rows) < FEWEST:
        return []
    figure = np.array([worst for _, worst in rows])
    drawn = any(kind in definition.about for kind in DRAWN) and len(rows) >= FEWEST_FOR_INDICES
    found: list[_Driver] = []
    for k, column in enumerate(definition.columns):
        values = [definition.values[m.number - 1][k] for m, _ in rows]
        if (
            not all(isinstance(v, int | float) for v in values)
            or len(set(values)) < 2
            or np.ptp(figure) == 0.0
        ):
            continue
        inputs = np.array(values, float)
        rank = float(np.asarray(spearmanr(inputs, figure))[0])
        found.append(_Driver(column.name, rank, first_order(inputs, figure) if drawn else None))
    return sorted(found, key=lambda d: -abs(d.rank if d.index is None else d.index))


def first_order(setting: np.ndarray, figure: np.ndarray) -> float:
    """First-order Sobol index of a setting (n,) for a figure (n,), both drawn: variance of means in bins.

    Less what chance alone makes of them; 0 at least.
    """
    order = np.argsort(setting, kind="stable")
    groups = np.array_split(figure[order], BINS)
    whole = float(np.var(figure))
    between = sum(len(g) * (g.mean() - figure.mean()) ** 2 for g in groups) / len(figure)
    within = sum(((g - g.mean()) ** 2).sum() for g in groups) / (len(figure) - BINS)
    return float(max(0.0, (between - within * (BINS - 1) / len(figure)) / whole))


def lines(found: Survival, drops: Sequence[int]) -> Iterator[str]:
    """The results, for people."""
    share = with_interval(found.chance)
    yield f"{found.broken} of {found.count} drops: {found.limit.words()} ({share})"
    if found.broken == 0 and found.count >= LEAST_FOR_THREE:
        least = f"one in {found.count / 3.0:.0f} cannot be excluded (rule of three)"
        yield f"  {least}; more drops would say more"
    if found.untouched:
        yield (
            f"  {found.untouched} of them ended before the rotor touched a bearing, and count as survived; "
            "give a longer --duration unless it was caught"
        )
    for count, how in ((found.early, f"ended {BEFORE_A_WHIRL}"), (found.unsettled, f"had {UNSETTLED}")):
        if count:
            yield f"  {count} of them {how}; a longer --duration would say more"
    if drops:
        yield f"{'drops':>6}  survived with probability"
    for n in drops:
        one = found.after(n)
        yield f"{n:>6}  {percent(one.value)} ({percent(one.low)} to {percent(one.high)})"
    for name, shares in found.shares.items():
        text = f"{shares.mean():.2g} in the mean, {shares.max():.2g} at most"
        yield f"life that a drop within the limit takes, {name}: {text}"
    if found.drivers:
        yield f"{found.limit.quantity.words}, Spearman's rank correlation with what varies:"
        for one in found.drivers:
            index = "" if one.index is None else f", first-order index {one.index:.2f}"
            yield f"  {one.setting}: {one.rank:+.2f}{index}"


def undamped(definition: Definition) -> list[str]:
    """A line where balls of a sweep's bearings have no damping, or none."""
    varied = {name for column in definition.columns for name in column.settings}
    bearings = [
        name
        for name, spec in definition.scene["components"].items()
        if DAMPING[0] in _parameters(spec["fmu"])
        and not any(_is_set(spec["set"].get(one)) or f"{name}.{one}" in varied for one in DAMPING)
    ]
    if not bearings:
        return []
    return [
        f"balls of {', '.join(bearings)} have no damping ({DAMPING[0]}, {DAMPING[1]}): rare large ball "
        "loads depend on it, above all on a soft mount; set it, or vary it in the sweep"
    ]


def _parameters(fmu: str) -> set[str]:
    """Names of the parameters of one of the project's models; of other FMUs none are known."""
    return {v.name for v in flatten(recipe(fmu).model.parameters())} if fmu in fmu_names() else set()


def _is_set(value: object) -> bool:
    """Whether a setting, as it stands in a scene, is not 0."""
    return value is not None and str(value).split()[0].strip("0.") != ""


def read_limit(text: str, found: Sequence[Member]) -> Limit:
    """A limit as NAME=VALUE, of a requirement as in scenes or of a quantity of the sweep's drops.

    A key is that of all seats, a path of one. What is worse when it is smaller, such as a safety, must not
    fall below it, all else not exceed it. A value has a unit where its quantity has one. Raises
    TouchdownError.
    """
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals:
        raise TouchdownError(f"limit {text}: write NAME=VALUE")
    kind, seat = _quantity(name, found, f"limit {text}: ")
    unit, example = kind.quantity.unit, kind.example or f"1 {kind.quantity.read_in}".rstrip()
    read = number(unit, size=kind.size, example=example, strict=unit != "1")
    return Limit(kind.quantity, read.read(value, f"limit {name}"), seat)


def worst_member(members: Sequence[Member], name: str) -> Member:
    """The one with the worst value of a quantity, named as in `read_limit`. Raises TouchdownError."""
    kind, seat = _quantity(name, members)
    limit = Limit(kind.quantity, math.nan, seat)
    told = {
        value: m for m in reversed(members) if (value := limit.worst(m)) is not None
    }  # the first of many
    require(told, f"no drop of the sweep tells its {name}")
    return told[(min if limit.at_least else max)(told)]


def _quantity(name: str, found: Sequence[Member], where: str = "") -> tuple[RequirementKind, str]:
    """What a name means, and the one seat or gap that it is for, or "". Raises TouchdownError."""
    by_path = {item.path: item for item in _told(found)}
    keys = {item.quantity.key for item in by_path.values()}
    if name not in (*KINDS, *keys, *by_path):
        near = one_of(name, by_path if "." in name else {*KINDS, *keys})
        raise TouchdownError(f"{where}no drop has a quantity {name}; {near}")
    kind, seat = KINDS.get(name), ""
    if kind is None and name in keys:
        kind = RequirementKind(named(name)[0])
    elif kind is None:
        kind, seat = RequirementKind(by_path[name].quantity), by_path[name].name
    require(kind.quantity.worse is not Worse.NEITHER, f"{where}neither more nor less of {name} is worse")
    return kind, seat
