"""Drawings that only a report has: the machine to scale, and contact maps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Annulus, Circle, Rectangle

from ..master.common.text import MM, UM
from ..rotor.beams.shaft import Shaft
from ..studies.rotor.figure import AXIS, CORE, EDGE, SLEEVE, disc_size, side_view
from .figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    TIME,
    apart,
    beginning,
    label_width,
    sized,
)

SECTORS = 72  # of the bore
TIME_BINS = 240  # of the run
FORCE_DECADES = 3.0  # of force shown at most
COLOURS = "viridis"


@dataclass(frozen=True)
class Presses:
    """How the journal presses on a bore: each of shape (rows,)."""

    title: str
    time: np.ndarray  # s
    angle: np.ndarray  # rad, of the place, counter-clockwise from +x
    force: np.ndarray  # N

    def largest(self) -> tuple[np.ndarray, np.ndarray, np.ma.MaskedArray]:
        """Edges of time (s) and of angle (deg, 0 at the bottom), and the largest force in each field.

        The field is (SECTORS, TIME_BINS), masked where nothing pressed.
        """
        moments = np.linspace(beginning(self.time), float(self.time[-1]), TIME_BINS + 1)
        sectors = np.linspace(-180.0, 180.0, SECTORS + 1)
        degrees = (np.degrees(self.angle) + 90.0 + 180.0) % 360.0 - 180.0
        when = np.clip(np.searchsorted(moments, self.time, "right") - 1, 0, TIME_BINS - 1)
        where = np.clip(np.searchsorted(sectors, degrees, "right") - 1, 0, SECTORS - 1)
        field = np.zeros((SECTORS, TIME_BINS))
        pressed = (self.force > 0.0) & (self.time >= moments[0])
        np.maximum.at(field, (where[pressed], when[pressed]), self.force[pressed])
        return moments, sectors, np.ma.masked_less_equal(field, 0.0)


def contact_map(figure: Figure, bores: list[Presses]) -> None:
    """Place over time, the colour telling the largest force there [N]."""
    fields = [bore.largest() for bore in bores]
    top = max(float(field.max()) for _, _, field in fields if field.count())
    norm = LogNorm(top * 10.0**-FORCE_DECADES, top, clip=True)
    panels = sized(figure, 9.4, 0.6 + 2.1 * len(bores)).subplots(len(bores), 1, squeeze=False, sharex=True)
    for axes, bore, (moments, sectors, field) in zip(panels[:, 0], bores, fields, strict=True):
        mesh = axes.pcolormesh(moments, sectors, field, norm=norm, cmap=COLOURS, rasterized=True)
        axes.set_yticks([-180, -90, 0, 90, 180], ["top", "left", "bottom", "right", "top"])
        axes.set_ylim(-180, 180)
        axes.set_title(bore.title)
        axes.grid(alpha=0.4, lw=0.5)
    panels[-1, 0].set_xlabel(TIME)
    figure.colorbar(mesh, ax=list(panels[:, 0]), label="largest contact force [N]", pad=0.015, aspect=14)


SEAL_HEIGHT = 0.2  # likewise, a seal
SIDE_WIDTH, BARS_HEIGHT = 8.6, 2.3  # inch, of the panels
SUPPORT_HEIGHT = 0.45  # of the rotor's largest radius: how tall a support is drawn that states no size
MIN_ASPECT, MAX_ASPECT = 0.16, 0.55  # height over width of a side view


@dataclass(frozen=True)
class Support:
    """A bearing, sensor or gap of the rotor: its place on the axis (m), its kind, and its size (m)."""

    position: float
    kind: str  # "touchdown", "magnetic", "sensor" or "gap"
    label: str
    inner: float = 0.0  # diameters; 0: not stated
    outer: float = 0.0
    width: float = 0.0
    gap: float = 0.0  # around the rotor, or along it on either side; 0: not stated
    left: float | None = None  # of the gap at least, in the run; None: not known
    axial: bool = False
    late: bool = False  # what is left is of a time from which on no figure is valid


@dataclass(frozen=True)
class SideView:
    """All that is drawn from the side."""

    shaft: Shaft
    supports: Sequence[Support]

    @property
    def ends(self) -> tuple[float, float]:
        """Of the rotor and its supports on the axis (m)."""
        starts = [0.0, *(s.position - s.width for s in self.supports)]
        stops = [float(self.shaft.positions()[-1]), *(s.position + s.width for s in self.supports)]
        return min(starts), max(stops)

    @property
    def radius(self) -> float:
        """The largest (m)."""
        widest = (e.widest for e in self.shaft.elements)
        return 0.5 * max(*widest, *(s.outer for s in self.supports), 1e-3)

    def disc(self, place: float) -> float:
        """The radius of the largest disc at a place on the axis (m), or 0."""
        at, shaft = self.shaft.positions(), self.shaft
        there = [p for p in shaft.points if abs(at[p.node - 1] - place) < 1e-6]
        return 0.5 * max((disc_size(p, shaft)[0] for p in there), default=0.0)

    def surface(self, place: float, largest: bool = False) -> float:
        """The rotor's radius at a place on its axis (m), the smaller or the larger one at a step."""
        positions = self.shaft.positions()
        there = [
            e.widest
            for start, e in zip(positions, self.shaft.elements, strict=False)
            if start - 1e-9 <= place <= start + e.length + 1e-9
        ]
        return 0.5 * (max if largest else min)(there, default=0.0)


def draw_side(figure: Figure, view: SideView) -> None:
    """Rotor and what stands around it in mm, equal scales both ways; below, what is left of each gap."""
    begin, end = (MM * place for place in view.ends)
    radius = MM * view.radius
    discs = (view.disc(float(place)) for place in view.shaft.positions())
    tallest = MM * max(view.radius, *discs, *(_span(view, s)[1] for s in view.supports))
    reach = 1.4 * tallest
    half = max(0.53 * (end - begin), reach / MAX_ASPECT)
    reach = max(reach, MIN_ASPECT * half)
    middle = 0.5 * (begin + end)
    gaps = [s for s in view.supports if s.gap]
    heights = [SIDE_WIDTH * reach / half, *([BARS_HEIGHT] if gaps else [])]
    panels = sized(figure, 9.4, 0.9 + sum(heights)).subplots(
        len(heights), 1, sharex=True, squeeze=False, height_ratios=heights
    )[:, 0]
    axes = panels[0]
    side_view(axes, view.shaft, named=False)
    for place in {float(view.shaft.positions()[u.node - 1]) for u in view.shaft.unbalances}:
        axes.plot(MM * place, MM * view.surface(place), "v", color=PURPLE, ms=6, zorder=4)
    for support in view.supports:
        _draw_support(axes, support, view, radius)
    axes.set_xlim(middle - half, middle + half)
    axes.set_ylim(-reach, reach, auto=True)
    axes.set_aspect("equal", adjustable="datalim")
    panels[-1].set_xlabel(AXIS)
    _name_supports(axes, view, reach)
    if gaps:
        _draw_bars(panels[1], sorted(gaps, key=lambda s: s.position))


def _span(view: SideView, s: Support) -> tuple[float, float]:
    """Radii between which a support is drawn (m); where it states no size, those of a symbol."""
    is_gap = s.kind == "gap"
    surface = max(view.surface(s.position, s.kind == "magnetic"), view.disc(s.position) if is_gap else 0.0)
    inner = 0.5 * s.inner or surface
    return inner, 0.5 * s.outer or inner + (SEAL_HEIGHT if is_gap else SUPPORT_HEIGHT) * view.radius


KINDS = {"touchdown": BLUE, "magnetic": ORANGE, "sensor": BLACK, "gap": GREEN}


def _draw_support(axes: Axes, s: Support, view: SideView, radius: float) -> None:
    """Above and below the rotor: a ball between rings, a wound pole, a seal; a sensor's tip; faces."""
    inner, outer = (MM * r for r in _span(view, s))
    start, colour = MM * s.position, KINDS[s.kind]
    if s.kind == "sensor":
        axes.plot([start, start], [inner + 0.06 * radius, inner + 0.35 * radius], color=colour, lw=1.6)
        axes.plot(start, inner + 0.06 * radius, "v", color=colour, ms=4)
        return
    width = MM * s.width or (1.5 * SEAL_HEIGHT if s.kind == "gap" else 0.35) * radius
    for sign in (1.0, -1.0):
        if s.axial:
            ends = start + 0.3 * radius * np.array([-1.0, 1.0])
            axes.plot(ends, [sign * outer, sign * outer], "|-", color=colour, ms=8)
            continue
        low = sign * inner if sign > 0 else -outer
        corner, hatch = (start - 0.5 * width, low), "||||||" if s.kind == "gap" else ""
        frame = Rectangle(corner, width, outer - inner, fc="none", ec=colour, lw=1.6, zorder=3, hatch=hatch)
        axes.add_patch(frame)
        if s.kind == "touchdown":
            ball = Circle(
                (start, sign * 0.5 * (inner + outer)), 0.28 * (outer - inner), fc="none", ec=colour
            )
            axes.add_patch(ball)
        elif s.kind == "magnetic":
            xs = np.array([-0.5, 0.5]) * width + start
            axes.plot(xs, [low, low + outer - inner], color=colour, lw=0.9)
            axes.plot(xs, [low + outer - inner, low], color=colour, lw=0.9)


def _name_supports(axes: Axes, view: SideView, reach: float) -> None:
    """Names above their places, those of one place together."""
    top: dict[int, list[Support]] = {}
    for s in sorted(view.supports, key=lambda s: s.position):
        top.setdefault(round(MM * s.position), []).append(s)
    names = ["\n".join(s.label for s in there) for there in top.values()]
    for x, (place, there), name in zip(_spread(axes, list(top), names), top.items(), names, strict=True):
        surface = MM * max(_span(view, s)[1] for s in there)
        line = {"arrowstyle": "-", "color": GREY, "lw": 0.5}
        axes.annotate(name, (place, surface), (x, 0.99 * reach), ha="center", va="top", fontsize="small",
                      arrowprops=line)  # fmt: skip


def _spread(axes: Axes, places: Sequence[float], labels: Sequence[str]) -> np.ndarray:
    """Where labels at `places` (mm, ascending) stand beside each other."""
    low, high = axes.get_xlim()
    return apart(places, [label_width(one) * (high - low) / SIDE_WIDTH for one in labels], low, high)


def _draw_bars(axes: Axes, gaps: Sequence[Support]) -> None:
    """A bar for each gap [µm] at its place: its height is the size, filled as far as the rotor closed it.

    Red where the rotor hit what no rotor should; a touchdown bearing is there to be touched.
    """
    labels, places = [_left_words(s) for s in gaps], [MM * s.position for s in gaps]
    low, high = axes.get_xlim()
    width, tallest = 0.018 * (high - low), UM * max(s.gap for s in gaps)
    for s, x, place, label in zip(gaps, _spread(axes, places, labels), places, labels, strict=True):
        hit = s.kind != "touchdown" and s.left is not None and s.left <= 0.0
        colour = RED if hit else KINDS[s.kind]
        used = 0.0 if s.left is None else min(max(s.gap - s.left, 0.0), s.gap)
        axes.bar(x, UM * used, width, color=colour, alpha=0.55, lw=0, label=f"_{s.label}, used")
        axes.bar(x, UM * s.gap, width, fc="none", ec=colour, lw=1.2, label=f"_{s.label}")
        line = {"arrowstyle": "-", "color": GREY, "lw": 0.5}
        axes.annotate(
            label, (place, 1.85 * tallest), (x, UM * s.gap + 0.06 * tallest), ha="center", va="bottom",
            fontsize="small", color=RED if hit else BLACK, arrowprops=line,
        )  # fmt: skip
    axes.set_ylim(0.0, 1.85 * tallest)
    axes.set_yticks([tick for tick in axes.get_yticks() if tick <= tallest])
    axes.spines["left"].set_bounds(0.0, tallest)
    axes.set_ylabel("gap [µm]")


def _left_words(s: Support) -> str:
    """Name and size of a gap, and what is left of it."""
    size, along = UM * s.gap, " along" if s.axial else ""
    if s.left is None:
        state = "not recorded"
    elif s.left > 0.0:
        state = f"{UM * s.left:.3g} µm left"
    else:
        state = "touched" if s.kind == "touchdown" else f"closed, {-UM * s.left:.3g} µm beyond"
    return f"{s.label}\n{size:.3g} µm{along}\n{state}" + (",\nnot valid" if s.late else "")


@dataclass(frozen=True)
class Section:
    """A bearing along its axis (m): radii; no balls: a plain bore."""

    label: str
    journal: float
    clearance: float
    pitch: float = 0.0
    ball: float = 0.0
    balls: int = 0
    first_angle: float = -math.pi / 2


def sections(figure: Figure, bearings: Sequence[Section]) -> None:
    """Bearings along their axes in mm, equal scales; the clearance is too small to be seen so."""
    panels = sized(figure, 3.1 * len(bearings) + 0.4, 3.5).subplots(1, len(bearings), squeeze=False)[0]
    for axes, bearing in zip(panels, bearings, strict=True):
        _draw_section(axes, bearing)
        axes.set_title(bearing.label)
        axes.set_aspect("equal")
        axes.set_xlabel("[mm]")


def _draw_section(axes: Axes, b: Section) -> None:
    bore = MM * (b.journal + b.clearance)
    inner = MM * (b.pitch - b.ball) if b.balls else bore
    outer = MM * (b.pitch + b.ball) if b.balls else 1.25 * bore
    around = 1.0 + 0.12 * (outer - inner) / outer if b.balls else 1.0
    if b.balls:
        inner += 0.2 * MM * b.ball  # the groove's shoulder
        axes.add_patch(Annulus((0, 0), inner, inner - bore, fc=CORE, ec=EDGE, lw=0.8))
        shoulder = outer - 0.2 * MM * b.ball
        axes.add_patch(Annulus((0, 0), around * outer, around * outer - shoulder, fc=CORE, ec=EDGE, lw=0.8))
        for k in range(b.balls):
            angle = b.first_angle + 2.0 * math.pi * k / b.balls
            start = MM * b.pitch * math.cos(angle), MM * b.pitch * math.sin(angle)
            axes.add_patch(Circle(start, MM * b.ball, fc="#ffffff", ec=BLUE, lw=1.2, zorder=3))
    else:
        axes.add_patch(Annulus((0, 0), outer, outer - bore, fc=SLEEVE, ec=EDGE, lw=0.8))
    axes.add_patch(Circle((0, 0), MM * b.journal, fc="none", ec=ORANGE, lw=1.4))
    axes.plot(0, 0, "+", color=GREY)
    axes.text(0, 0.3 * MM * b.journal, "journal", ha="center", fontsize="small")
    axes.set_xlim(-1.15 * around * outer, 1.15 * around * outer)
    axes.set_ylim(-1.15 * around * outer, 1.15 * around * outer)
