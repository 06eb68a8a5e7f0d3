"""What masters do on a problem: every setting run, and the longest macro step at which motion dies away;
as a table, and as a picture of error against doSteps."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from textwrap import wrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from speeds.measured import Block

from cosimulated.masters import Master
from cosimulated.problems import Problem, Setting, UnableError

SHORTEST, LONGEST = 1e-4, 0.3  # s, where stable macro steps are looked for
CLOSE = 1.1  # ratio of a stable step and one that is not
HEAD = ("master", "asked for", "doSteps", "largest error [m]", "energy made", "at rest up to")


@dataclass(frozen=True)
class Result:
    """A master at one setting."""

    master: str
    own: bool  # whether it is this project's
    label: str
    calls: int = 0
    error: float = float("nan")  # m
    energy: float | None = None  # over what there was
    rests: str = ""  # its longest stable macro step, for people
    unable: str = ""  # why there is nothing

    def row(self) -> tuple[str, ...]:
        """Of the table."""
        if self.unable:
            return self.master, self.label, "-", "-", "-", self.rests
        energy = "-" if self.energy is None else f"{self.energy:.1e}"
        return self.master, self.label, f"{self.calls}", f"{self.error:.1e}", energy, self.rests


def result(master: Master, problem: Problem, setting: Setting) -> Result:
    """One run."""
    try:
        motion = master.run(problem, setting)
    except UnableError as reason:
        return Result(master.title, master.own, setting.label, unable=str(reason))
    with np.errstate(all="ignore"):
        error, energy = problem.error(motion), problem.energy(motion)
    unable = f"stops: {motion.ended}" if motion.ended else ""
    return Result(master.title, master.own, setting.label, motion.calls, error, energy, unable=unable)


class Stability:
    """Looks for the longest stable macro steps of masters on a problem.

    Where one master's bound is found, the next ones are tried first: several masters do the same.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem, self._bounds = problem, set[float]()

    def of(self, master: Master) -> str:
        """For people."""
        if self._problem.damped(LONGEST) is None:
            return "-"
        if master.at(LONGEST) is None:
            return "by tolerance"
        try:
            low, high = self._bracket(master)
        except UnableError:
            return "-"
        if low >= LONGEST:
            return f"above {1e3 * low:g} ms"
        return f"{1e3 * low:.2g} ms" if low > SHORTEST else f"below {1e3 * high:.2g} ms"

    def _bracket(self, master: Master) -> tuple[float, float]:
        """A stable step and one that is not (s)."""
        low, high = SHORTEST, LONGEST
        if self._rests(master, high):
            return high, high
        while high / low > CLOSE:
            known = sorted(bound for bound in self._bounds if low < bound < high)
            middle = known[len(known) // 2] if known else (low * high) ** 0.5
            low, high = (middle, high) if self._rests(master, middle) else (low, middle)
        self._bounds |= {low, high}
        return low, high

    def _rests(self, master: Master, step: float) -> bool:
        damped, setting = self._problem.damped(step), master.at(step)
        assert damped is not None
        assert setting is not None
        with np.errstate(all="ignore"):
            return damped.rests(master.run(damped, setting))


def compared(
    masters: Iterable[Master], problem: Problem, stability: Stability | None, coarsest: bool
) -> Iterator[Result]:
    """All settings of all masters, or the coarsest of each; stable steps where they are looked for."""
    for master in masters:
        tried = master.settings(problem)
        found = [result(master, problem, setting) for setting in (tried[:1] if coarsest else tried)]
        for one in found[:1]:
            yield replace(one, rests=stability.of(master) if stability else "-")
        yield from found[1:]


def table(title: str, found: Sequence[Result]) -> Iterator[str]:
    """Of a problem, a line each; under it stands why something is missing."""
    yield from Block(title, HEAD, tuple(one.row() for one in found)).lines()
    told = (f"  {one.master}, {one.label}: {one.unable}" for one in found if one.unable)
    yield from dict.fromkeys(told)


def keep(found: Sequence[Result], path: Path) -> None:
    """Results as JSON, for a picture of several runs."""
    path.write_text(json.dumps([asdict(one) for one in found], indent=1), encoding="utf-8")


def known(path: Path) -> list[Result]:
    """What `keep` wrote; nothing where there is no file."""
    if not path.is_file():
        return []
    return [Result(**one) for one in json.loads(path.read_text(encoding="utf-8"))]


# Okabe and Ito's colours, which the colour-blind tell apart, too; markers tell lines of one colour apart
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
MARKS = "os^vDP*"
ELSEWHERE = "xsv^Dd+"  # of other tools, which have broken lines
ACROSS = 2  # panels in a row
WIDE = 60  # letters of a title


def draw(found: Mapping[str, Sequence[Result]], path: Path) -> None:
    """`found` by the problems' titles; this project's ways have full lines."""
    down = -(-len(found) // ACROSS)
    figure = Figure(figsize=(11.0, 4.4 * down + 1.2), layout="constrained")
    panels = figure.subplots(down, ACROSS, squeeze=False).ravel()
    looks = styles([one for results in found.values() for one in results])
    for axes, (title, results) in zip(panels, found.items(), strict=False):
        _panel(axes, title, results, looks)
    for axes in panels[len(found) :]:
        axes.set_visible(False)
    shown = {
        name: line for axes in panels for line, name in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    handles = [shown[name] for name in looks if name in shown]
    figure.legend(handles=handles, loc="outside lower center", ncols=4, fontsize="small")
    figure.savefig(path, dpi=110)


def styles(results: Sequence[Result]) -> dict[str, dict[str, object]]:
    """How each master is drawn, the same in all panels."""
    looks: dict[str, dict[str, object]] = {}
    for ours in (True, False):
        names = dict.fromkeys(one.master for one in results if one.own == ours)
        for k, name in enumerate(names):
            looks[name] = {
                "color": COLOURS[k % len(COLOURS)],
                "marker": (MARKS if ours else ELSEWHERE)[k % len(MARKS)],
                "linestyle": ("-" if k < len(COLOURS) else "-.") if ours else ":",
                "markerfacecolor": COLOURS[k % len(COLOURS)] if ours else "none",
                "markersize": 5.0 if ours else 5.0 + 1.5 * k,  # equal results lie around each other
            }
    return looks


def _panel(
    axes: Axes, title: str, results: Sequence[Result], looks: Mapping[str, Mapping[str, object]]
) -> None:
    for name in dict.fromkeys(one.master for one in results):
        seen = [one for one in results if one.master == name and np.isfinite(one.error)]
        if seen:
            axes.loglog([one.calls for one in seen], [one.error for one in seen], label=name, **looks[name])
    axes.set_title("\n".join(wrap(title, WIDE)), fontsize="medium")
    axes.set_xlabel("doSteps of all FMUs")
    axes.set_ylabel("largest error [m]")
    axes.grid(True, alpha=0.3)
    axes.xaxis.set_minor_formatter(NullFormatter())
