"""Results of a study of verdicts, as lines, tables and figure."""

from __future__ import annotations

import itertools
import json
from collections import Counter
from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.projections.polar import PolarAxes

from ...master.quantities import most, summary_items
from ...master.results.settling import Trend
from ...master.results.whirl.verdict import how_it_goes_on, kind_of_whirl, worst_whirl
from ...master.scene.run_spec import SETTLED
from ...reports.figures.style import BLACK, GREY, sheet
from ..findings import Findings
from ..sweep.parts import WHIRL
from ..sweep.report import counted, titled, with_interval
from .study import (
    Circle,
    Edge,
    Study,
    Verdicts,
    Window,
    distance,
    edges,
    furthest,
    gaps,
    strays,
    whirling_share,
    windows,
)

INNER_RADIUS = 1.0  # radius, in rings


def _circles(study: Study) -> Figure:
    """Each phase that was run is a dot; its ring has the colour of its verdict half the way to the next."""
    figure = sheet(7.5, 7.5)
    axes = figure.add_subplot(projection="polar")
    assert isinstance(axes, PolarAxes)
    for ring, circle in enumerate(study.circles):
        _ring(axes, circle, INNER_RADIUS + ring)
    outermost = INNER_RADIUS + len(study.circles)
    axes.plot([np.radians(study.phase)] * 2, [0.0, outermost], color=GREY, ls="--", lw=1)
    axes.set_ylim(0.0, outermost)
    axes.set_yticks([])
    axes.grid(visible=False)
    patches = [Patch(color=look.colour, label=name.value) for name, look in WHIRL.looks.items()]
    line = axes.plot([], [], color=GREY, ls="--", lw=1, label="the scene's own phase")
    figure.legend(handles=[*patches, *line], loc="outside lower center", ncols=4)
    inwards = " | ".join(circle.title for circle in study.circles)
    title = f"{study.scene.title}\nphases of the unbalance, from the inmost ring: {inwards}"
    figure.suptitle(title, wrap=True)
    return figure


def _ring(axes: PolarAxes, circle: Circle, inner: float) -> None:
    for phase, before, after in gaps(circle.verdicts):
        begin, width = np.radians(phase - 0.5 * before), np.radians(0.5 * (before + after))
        colour = WHIRL.looks[kind_of_whirl(circle.verdicts[phase])].colour
        axes.bar(begin, 0.9, width=width, bottom=inner, align="edge", color=colour, lw=0)
        axes.plot(np.radians(phase), inner + 0.45, ".", color=BLACK, ms=3)


MAX_ROWS = 4  # of phases with equal verdicts in a window, to be told one by one
SETTLES = "no whirl"  # in words, where a circle has ""


def report_lines(study: Study) -> list[str]:
    """Windows, shares and strays with every choice of steps, and what the scene's own phase is worth."""
    plan, length = study.plan, f"{study.scene.run.duration:g} s"
    if study.scene.run.until == SETTLED:
        length = f"at most {length}, less where they settle before"
    lines = [
        f"{study.scene.title}: which phases of the unbalance whirl",
        f"phases {plan.spacing:g} deg apart, {plan.resolution:g} deg where neighbours' verdicts differ; "
        f"drops of {length}",
    ]
    if study.interrupted:
        lines.append("interrupted: what follows is of the phases that were run until then")
    for circle in study.circles:
        lines += ["", *_circle_lines(study, circle)]
    return [*lines, "", *_own_phase(study)]


def _circle_lines(study: Study, circle: Circle) -> Iterator[str]:
    yield f"{circle.title}: {len(circle.verdicts)} runs"
    if circle.verdicts:
        yield from _window_lines(circle)
        yield f"  share of phases that whirl: {with_interval(whirling_share(circle.verdicts))}"
        yield from _goes_on(circle)
        yield from _unsettled(circle)
        yield from _force_lines(circle)
        if study.reference is not None and circle is not study.reference:
            yield f"  {_against(circle, study.reference)}"
    stop = study.scene.run.stop_residual
    if over := circle.over_the_limit(stop):
        passed = f"the energy ledger passed {stop:g} of a connection's turnover"
        yield f"  in {over} of them {passed}, at which a run of the scene stops"
    for phase, reason in circle.failed.items():
        yield f"  {phase:g} deg failed: {reason}"


def _force_lines(circle: Circle) -> Iterator[str]:
    """Contact forces over the phases: repeatable in the first impact, one draw each in a chaotic drop."""
    keys = {"first impact": "first_impact_contact_force", "whole drop": "peak_contact_force"}
    for title, key in keys.items():
        if forces := circle.forces(key):
            low, high = map(newtons, forces)
            yield f"  largest contact force, {title}: {low} to {high} over the phases"


def _goes_on(circle: Circle) -> Iterator[str]:
    """When drops that whirl at the end ended, and how their whirls go on."""
    going = [m for m in circle.members.values() if not m.failed and how_it_goes_on(m.summary)]
    if not going:
        return
    counted = Counter(how_it_goes_on(m.summary) for m in going).most_common()
    ends = dict.fromkeys(f"{m.summary['end_time']:.3g}" for m in going)
    until = f"{min(ends, key=float)} to {max(ends, key=float)}" if len(ends) > 1 else next(iter(ends))
    how = ", ".join(f"{n} {trend}" for trend, n in counted)
    yield f"  still whirling at the end, at {until} s: {len(going)} runs: {how}"
    if any(how_it_goes_on(m.summary) != Trend.STEADY for m in going):
        yield "    only a longer --duration shows whether those last that are not steady"


def _unsettled(circle: Circle) -> Iterator[str]:
    """How many drops without a whirl had not settled when they ended."""
    ended = [m for m in circle.members.values() if not m.failed and not worst_whirl(m.summary)]
    moving = sum(m.summary.get("settling_time") is None for m in ended)
    if moving:
        yield f"  not settled at the end, without a whirl so far: {moving} runs"
        yield "    only a longer --duration shows whether those whirl later"


def _window_lines(circle: Circle) -> Iterator[str]:
    found = windows(circle.verdicts)
    alone = strays(circle.verdicts)
    if not found:
        yield "  no window whirls"
    for window in found:
        yield f"  whirls {reach(window)}: {whirls_in_words(circle.verdicts, window)}"
    if alone:
        listed = ", ".join(f"{phase:g} deg ({circle.verdicts[phase] or SETTLES})" for phase in alone)
        yield f"  outliers, alone among the others: {listed}"


def whirls_in_words(verdicts: Verdicts, window: Window) -> str:
    """How the phases of a window whirl: from where to where, or how often where it changes too often."""
    rows = [(words, list(row)) for words, row in itertools.groupby(window.phases, key=verdicts.__getitem__)]
    if 1 < len(rows) <= MAX_ROWS:
        return ", ".join(f"{row[0]:g} to {row[-1]:g} {words}" for words, row in rows)
    counted = Counter(verdicts[phase] for phase in window.phases).most_common()
    return ", ".join(f"{n} x {words}" for words, n in counted)


def reach(window: Window) -> str:
    """From where to where, with what the edges are known to."""
    if window.begin is None or window.end is None:
        return "all the way round"
    return f"from {_edge(window.begin)} to {_edge(window.end)} deg"


def _edge(edge: Edge) -> str:
    return f"{edge.middle:g} ({edge.low:g} to {edge.high:g})"


def newtons(force: float) -> str:
    """A force for people."""
    return f"{force:.0f} N" if force < 1e4 else f"{1e-3 * force:.1f} kN"


def _against(circle: Circle, reference: Circle) -> str:
    """How far the edges are from the reference's, and how many strays there are on either."""
    mine, theirs = edges(circle.verdicts), edges(reference.verdicts)
    off = max(filter(None, (furthest(mine, theirs), furthest(theirs, mine))), default=0.0)
    found = f"{len(mine)} edges against the reference's {len(theirs)}"
    if mine and theirs:
        found += f", at most {off:.3g} deg off"
    alone, others = len(strays(circle.verdicts)), len(strays(reference.verdicts))
    return (
        f"{found}; outliers {alone} of {len(circle.verdicts)} against {others} of {len(reference.verdicts)}"
    )


def _own_phase(study: Study) -> Iterator[str]:
    """The verdict at the scene's own phase, and its distance from an edge."""
    for circle in study.circles:
        words = circle.verdicts.get(study.phase)
        if words is None:
            continue
        found = f"phase {study.phase:g} deg, the scene's own, with {circle.title}: {words or SETTLES}"
        yield f"{found}, {_nearest(circle, study.phase, study.plan.spacing)}"


def _nearest(circle: Circle, phase: float, spacing: float) -> str:
    """How far a phase is from the nearest edge: near it where a neighbour in the grid lies beyond."""
    known = edges(circle.verdicts)
    if phase in strays(circle.verdicts):
        return "an outlier, alone among the others"
    if not known:
        return f"and no edge between the phases run, {spacing:g} deg apart"
    edge = min(known, key=lambda e: distance(e.middle, phase))
    away = distance(edge.middle, phase)
    if away < spacing:
        return f"near an edge, at {_edge(edge)} deg: another phase of the grid would say otherwise"
    return f"{away:.3g} deg from the nearest edge"


def findings(study: Study) -> Findings:
    """phases.csv has a row per run with all its quantities, verdict.json the windows; and verdict.png."""
    pictured = any(circle.verdicts for circle in study.circles)
    return Findings(
        report_lines(study),
        tables={"phases.csv": _records(study)},
        texts={"verdict.json": json.dumps(_as_plain(study), indent=2) + "\n"},
        pictures={"verdict.png": lambda: _circles(study)} if pictured else {},
    )


def _records(study: Study) -> Iterator[dict[str, object]]:
    for circle in study.circles:
        for phase, m in circle.members.items():
            yield {
                "steps": circle.title,
                "phase [deg]": phase,
                "verdict": (circle.verdicts[phase] or SETTLES) if phase in circle.verdicts else "",
                "largest_contact_force [N]": most(m.summary, "peak_contact_force"),
                "failed": circle.failed.get(phase, m.failed),
                **{titled(item): counted(item.of(m.summary)) for item in summary_items(m.summary)},
            }


def _as_plain(study: Study) -> dict[str, object]:
    """The results for JSON: angles in degrees, forces in N."""
    return {
        "scene": study.scene.name,
        "phase_deg": study.phase,
        "grid_deg": study.plan.spacing,
        "resolution_deg": study.plan.resolution,
        "interrupted": study.interrupted,
        "circles": [_plain_circle(circle) for circle in study.circles],
    }


def _plain_circle(circle: Circle) -> dict[str, object]:
    known = circle.verdicts
    return {
        "steps": circle.title,
        "verdicts": {f"{phase:g}": words or SETTLES for phase, words in known.items()},
        "windows_deg": [
            {"begin": window.begin, "end": window.end, "width": window.width} for window in windows(known)
        ],
        "strays_deg": strays(known),
        "share": whirling_share(known)._asdict() if known else None,
        "largest_contact_force_N": circle.largest_force(),
        "failed": {f"{phase:g}": reason for phase, reason in circle.failed.items()},
    }
