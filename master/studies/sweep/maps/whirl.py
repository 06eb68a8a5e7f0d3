"""Whirl maps: which drops whirl, and how large a part of those at one place."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.patches import Patch, Rectangle

from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.figures.style import BLACK, BLUE, ORANGE
from touchdown.master.results.whirl.share import CONFIDENCE, Share, clopper_pearson
from touchdown.master.results.whirl.told import Kind, has_verdict, kind, whirling
from touchdown.master.studies.sweep.journal import Member
from touchdown.master.studies.sweep.maps.field import Field
from touchdown.master.studies.sweep.maps.paper import cells, labelled, legend_below

COLOURS: Mapping[Kind, str] = {Kind.SETTLES: "#dddddd", Kind.TRANSIENT: BLUE, Kind.SUSTAINED: ORANGE}
HATCHES = {Kind.SUSTAINED: "////"}  # told apart in grey, too
MARKERS = {Kind.SETTLES: "o", Kind.TRANSIENT: "s", Kind.SUSTAINED: "^"}
FILLED = 0.96  # of a cell; the rest parts it from the next
MOST_TOLD = 100  # cells with their numbers in words
MARGIN = 4.0  # % beyond none and all

Kinds = Counter[Kind]  # how many drops of each


def whirl_map(axes: Axes, field: Field[list[Member]]) -> Axes:
    """Verdicts over one setting, or two: part of the drops that whirl, with its confidence interval.

    Raises TouchdownError where no drop has a verdict.
    """
    found = Field(
        field.labels, {place: _kinds(members) for place, members in field.spots.items()}, field.together
    )
    if not any(found.spots.values()):
        raise TouchdownError("no drop has a whirl verdict")
    several = any(kinds.total() > 1 for kinds in found.spots.values())
    if found.is_grid:
        _cells(axes, found)
    elif len(found.labels) == 2 or not several:
        _marks(axes, found)
    else:
        _lines(axes, found)
    labelled(axes, found)
    title = (
        f"part of the drops that whirl, {100.0 * CONFIDENCE:.0f} % interval"
        if several
        else "whirl of every drop"
    )
    title += _followed([m for members in field.spots.values() for m in members])
    if found.together:
        title += f"\neach place over {found.together}"
    axes.set_title(title, fontsize="medium")
    return axes


def _followed(members: Sequence[Member]) -> str:
    """Up to when drops were followed: a whirl at the end is one at that time."""
    ends = [end for m in members if isinstance(end := m.summary.get("end_time_s"), float)]
    if not ends:
        return ""
    reach = dict.fromkeys(f"{end:.3g}" for end in (min(ends), max(ends)))
    return f"; the end is at {' to '.join(reach)} s"


def _kinds(members: list[Member]) -> Kinds:
    return Counter(kind(whirling(m.summary)) for m in members if has_verdict(m.summary))


def _cells(axes: Axes, field: Field[Kinds]) -> None:
    """A cell per place, filled from the left by the parts of its verdicts."""
    told = len(field.spots) <= MOST_TOLD
    for x, y, kinds in cells(axes, field):
        left = x - 0.5 * FILLED
        for one in reversed(Kind):
            width = FILLED * kinds[one] / kinds.total() if kinds.total() else 0.0
            fill = {"facecolor": COLOURS[one], "hatch": HATCHES.get(one), "edgecolor": "#ffffff80"}
            axes.add_patch(Rectangle((left, y - 0.5 * FILLED), width, FILLED, lw=0, **fill))
            left += width
        if told and kinds.total() != 1:
            box = {"boxstyle": "round,pad=0.15", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
            axes.text(x, y, _told(kinds), ha="center", va="center", fontsize=7, color=BLACK, bbox=box)
    _legend(axes)


def _told(kinds: Kinds) -> str:
    if not kinds.total():
        return "no verdict"
    part = _share(kinds)
    return f"{100.0 * part.value:.0f} %\n{100.0 * part.low:.0f}–{100.0 * part.high:.0f} %"


def _share(kinds: Kinds, sustained: bool = False) -> Share:
    hits = kinds[Kind.SUSTAINED] + (0 if sustained else kinds[Kind.TRANSIENT])
    return clopper_pearson(hits, kinds.total())


def _marks(axes: Axes, field: Field[Kinds]) -> None:
    """A mark per place, of its gravest verdict; over one setting they stand on a line for each."""
    gravest = {
        place: max(kinds, key=list(Kind).index, default=None) for place, kinds in field.spots.items()
    }
    for height, one in enumerate(Kind):
        places = [place for place, worst in gravest.items() if worst is one]
        xs = [place[0] for place in places]
        ys = [place[1] for place in places] if len(field.labels) == 2 else [height] * len(places)
        axes.scatter(xs, ys, color=COLOURS[one], marker=MARKERS[one], edgecolor=BLACK, lw=0.4)
    if len(field.labels) == 1:
        axes.set_yticks(range(len(Kind)), [one.value for one in Kind])
        axes.margins(y=0.3)
    else:
        _legend(axes)


def _lines(axes: Axes, field: Field[Kinds]) -> None:
    """Parts over one setting, with their intervals as bars: bands of both would hide each other."""
    for sustained, one, style in ((False, Kind.TRANSIENT, "-o"), (True, Kind.SUSTAINED, "--^")):
        places = [x for x in field.along(0) if field.spots[(x,)].total()]
        parts = [_share(field.spots[(x,)], sustained) for x in places]
        label = f"{one.value if sustained else 'any whirl'}, {100.0 * CONFIDENCE:.0f} % interval as a bar"
        values = [100.0 * p.value for p in parts]
        below = [100.0 * (p.value - p.low) for p in parts]
        above = [100.0 * (p.high - p.value) for p in parts]
        caps = 2.0 if sustained else 4.0  # both are seen where they are the same
        axes.errorbar(
            places, values, (below, above), fmt=style, color=COLOURS[one], ms=4, capsize=caps, label=label
        )
    axes.set_ylim(-MARGIN, 100.0 + MARGIN)  # marks at none and at all are whole
    axes.set_ylabel("part of the drops [%]")
    axes.legend()


def _legend(axes: Axes) -> None:
    patches = [
        Patch(facecolor=colour, hatch=HATCHES.get(one), edgecolor="#ffffff80", label=one.value)
        for one, colour in COLOURS.items()
    ]
    legend_below(axes, patches)
