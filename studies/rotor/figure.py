"""Pictures of a rotor before it is dropped: Campbell diagram, critical speeds, modes, rest (Fig 19)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.patches import Polygon

from ...master.common.text import MM, RPM
from ...modelkit.kernel.writing import child_path
from ...reports.figures.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, save, sheet, sized
from ...rotor.beams.beam_body import PointMass
from ...rotor.beams.element import Element
from ...rotor.beams.shaft import Shaft
from ...rotor.modal.supported import MIN_DAMPING_RATIO, damping_ratios
from ...rotor.modal.whirl_speeds import HeldModes
from ...rotor.properties import RotorProperties
from .rotor_in_bearings import PLANAR_LIMIT, whirl_name

MAX_MODES_DRAWN = 6  # modes drawn
COLOURS = (BLACK, GREY, BLUE, ORANGE, GREEN, PURPLE)  # of the modes
AXIS = "position along the rotor's axis [mm]"
CORE, SLEEVE, DISC, EDGE = "#c8d3dc", "#ece3d0", "#b3c6b1", "#7f8a93"
WIDTH = 9.0  # inch, of a picture with side views
LABEL_INCHES = 1.5  # inch of it that labels take
VIEW_HEIGHT = 1.6  # of the largest radius: a side view's half height
MIN_ASPECT, MAX_ASPECT = 0.2, 0.4  # height over width of a side view
SHAPE_HEIGHT = 0.78  # of a side view's half height: a shape's 1


def draw_pictures(
    properties: RotorProperties, folder: Path, held: Mapping[str, tuple[HeldModes, str]]
) -> list[Path]:
    """campbell.png, modes.png and, where two nodes hold it, critical.png and rest.png in `folder`.

    held: Campbell diagrams in bearings and their titles, by the names of their pictures.
    """
    pictures = {"campbell": campbell, "modes": modes}
    if properties.critical:
        pictures["critical"] = critical
    if properties.rest is not None:
        pictures["rest"] = draw_rest
    drawn = {name: partial(picture, properties=properties) for name, picture in pictures.items()}
    drawn |= {name: partial(held_campbell, held=one, title=title) for name, (one, title) in held.items()}
    paths: list[Path] = []
    for name, picture in drawn.items():
        figure = sheet()
        picture(figure)
        paths.append(save(figure, child_path(folder, f"{name}.png"), dpi=110))
    return paths


def campbell(figure: FigureBase, properties: RotorProperties) -> list[Axes]:
    """Whirl frequencies of the free rotor [Hz] over speed [rpm], with the line where both are equal.

    The first of the properties' speeds is the one asked for, the others make the lines.
    """
    asked, speeds = RPM * properties.speeds[0], RPM * properties.speeds[1:]
    axes = sized(figure, 9.0, 6.5).subplots()
    drawn = range(1, min(len(properties.kinds), MAX_MODES_DRAWN))
    for k in drawn:
        axes.plot(
            speeds,
            properties.forward[1:, k],
            color=COLOURS[k],
            lw=1.4,
            label=f"{properties.kinds[k]}, forward",
        )
        if properties.frequencies[k] > 0.0:
            label = f"{properties.kinds[k]}, backward"
            axes.plot(speeds, properties.backward[1:, k], "--", color=COLOURS[k], lw=1.2, label=label)
    axes.plot(speeds, speeds / 60.0, ":", color=BLACK, lw=1.2, label="1x, once per turn")
    axes.axvline(asked, color=GREY, lw=0.8, label=f"{asked:.5g} rpm")
    axes.set_xlim(0.0, float(speeds[-1]))
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("rotor speed [rpm]")
    axes.set_ylabel("whirl frequency of the free rotor [Hz]")
    figure.legend(loc="outside right upper", fontsize="small")
    figure.suptitle(f"{properties.shaft.title}: Campbell diagram")
    return [axes]


def critical(figure: FigureBase, properties: RotorProperties) -> list[Axes]:
    """Undamped critical speeds [rpm] over the stiffness of the supports [N/m], for each way it is held.

    Dashed: the shaft's own supports there, with dots for its critical speeds on them, or dotted lines where
    the planes differ; grey: the first of the properties' speeds.
    """
    panels = sized(figure, 9.0, 1.0 + 4.2 * len(properties.critical)).subplots(
        len(properties.critical), 1, squeeze=False
    )
    for axes, found in zip(panels[:, 0], properties.critical, strict=True):
        axes.loglog(found.stiffness, RPM * found.speeds, color=BLUE, lw=1.4)
        names = ", ".join(s.name for s in found.places)
        for support in found.marked:
            where = "/".join(s.name for s in found.places if s.node == support.node)
            for value in {support.stiffness, support.stiffness_y or support.stiffness}:
                label = f"{where}: {value:.3g} N/m"
                axes.axvline(value, color=ORANGE, lw=1.0, ls="--", label=label)
        label, critical = "critical speeds on these supports", found.critical
        if any(s.stiffness_y not in (None, s.stiffness) for s in found.marked):  # no place on the scale
            for number, speed in enumerate(critical):
                shown_label = label if number == 0 else None
                axes.axhline(RPM * speed, color=ORANGE, lw=1.0, ls=":", label=shown_label)
        elif len(critical):
            middle = math.exp(np.mean([math.log(s.stiffness) for s in found.marked]))
            axes.plot(np.full(len(critical), middle), RPM * critical, "o", color=ORANGE, ms=5, label=label)
        if properties.speeds[0] > 0.0:
            asked = RPM * properties.speeds[0]
            axes.axhline(asked, color=GREY, lw=1.0, label=f"{asked:.5g} rpm")
        axes.set_xlabel(f"stiffness of each support at {names} [N/m]")
        axes.set_ylabel("critical speed, forward [rpm]")
        axes.grid(True, which="major", color=GREY, lw=0.3)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(loc="lower right", fontsize="small")
    figure.suptitle(f"{properties.shaft.title}: undamped critical speeds")
    return list(panels[:, 0])


def modes(figure: FigureBase, properties: RotorProperties) -> list[Axes]:
    """Shapes of the rigid and the first bending modes over the rotor's side view, to scale."""
    shaft, count = properties.shaft, min(len(properties.kinds), MAX_MODES_DRAWN)
    window = _window(shaft)
    sized(figure, WIDTH, 1.2 + count * (0.4 + window.height))
    panels = list(figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0])
    height = SHAPE_HEIGHT * window.reach
    to_shape_and_back = (lambda drawn: drawn / height), (lambda shape: shape * height)
    for k, axes in enumerate(panels):
        side_view(axes, shaft, named=k == 0)
        shape = properties.shapes[:, k]
        axes.plot(MM * shaft.positions(), height * shape, ".-", color=ORANGE, lw=1.5, ms=4)
        right = axes.secondary_yaxis("right", functions=to_shape_and_back)
        right.set_ylabel("shape [1]", color=ORANGE)
        right.set_yticks([-1.0, 0.0, 1.0])
        what = "rigid" if properties.frequencies[k] == 0.0 else f"{properties.frequencies[k]:.1f} Hz"
        _to_scale(axes, shaft)
        axes.set_title(f"{properties.kinds[k]}, {what}", fontsize="medium", pad=14 if k == 0 else 4)
    panels[-1].set_xlabel(AXIS)
    figure.suptitle(f"{shaft.title}: modes of the free rotor at rest")
    return panels


def draw_rest(figure: FigureBase, properties: RotorProperties) -> list[Axes]:
    """Side view to scale, deflection [µm] and bending stress [MPa] of the rotor on rigid seats.

    Only for properties with `rest`; a superelement has no stress.
    """
    shaft, lying = properties.shaft, properties.rest
    assert lying is not None
    position = MM * shaft.positions()
    view_height = _window(shaft).height
    curves = [("deflection, upwards [µm]", position, 1e6 * lying.deflection, BLUE)]
    title = f"{shaft.title} at rest on its touchdown seats, rigidly held"
    if len(lying.bending):
        curves.append(("bending stress [MPa]", MM * lying.position, 1e-6 * lying.bending, ORANGE))
        title += "; sagging is positive stress"
    sized(figure, WIDTH, 1.4 + 2.8 * len(curves) + view_height)
    ratios = (view_height, *(2.8 for _ in curves))
    view, *panels = figure.subplots(len(ratios), 1, sharex=True, height_ratios=ratios)
    side_view(view, shaft, named=True)
    _supports(view, shaft)
    _to_scale(view, shaft)
    for axes, (label, places, values, colour) in zip(panels, curves, strict=True):
        axes.plot(places, values, ".-", color=colour, lw=1.4, ms=4)
        axes.set_ylabel(label)
        axes.axhline(0.0, color=GREY, lw=0.5)
        for node in sorted({s.node for s in shaft.seats}):
            axes.axvline(position[node - 1], color=GREY, lw=0.6, ls="--")
    panels[-1].set_xlabel(AXIS)
    figure.suptitle(title)
    return [view, *panels]


@dataclass(frozen=True)
class _Window:
    """The range of a side view (mm)."""

    left: float
    right: float
    reach: float  # to either side of the axis

    @property
    def height(self) -> float:
        """Of a panel to scale (inch)."""
        return (WIDTH - LABEL_INCHES) * 2.0 * self.reach / (self.right - self.left)


def _window(shaft: Shaft) -> _Window:
    length = MM * float(shaft.positions()[-1])
    radius = 0.5 * MM * max((e.widest for e in shaft.elements), default=0.0)
    radius = max(radius, *(0.5 * MM * disc_size(point, shaft)[0] for point in shaft.points), 0.0)
    half = max(0.52 * length, VIEW_HEIGHT * radius / MAX_ASPECT)
    reach = max(VIEW_HEIGHT * radius, MIN_ASPECT * half)
    return _Window(0.5 * length - half, 0.5 * length + half, reach)


def side_view(axes: Axes, shaft: Shaft, named: bool) -> None:
    """Outlines of the elements and discs in mm, to scale; places by name.

    Of a superelement, which has no outline, the nodes on the axis.
    """
    position = MM * shaft.positions()
    for start, e in zip(position, shaft.elements, strict=False):
        for layer in reversed(e.layers):
            _cone(axes, start, layer, 0, SLEEVE)
        if e.sleeve_diameter:
            _cone(axes, start, replace(e, outer_diameter=e.sleeve_diameter), 0, SLEEVE)
        _cone(axes, start, e, 0, CORE)
        if any(e.diameters(end)[1] for end in (0.0, 1.0)):
            _cone(axes, start, e, 1, "white")
    _draw_points(axes, shaft)
    axes.axhline(0.0, color=EDGE, lw=0.5, ls="-.")
    if shaft.elements:
        axes.set_ylabel("radius [mm]")
    else:
        axes.plot(position, np.zeros_like(position), ".", color=EDGE, ms=4)
        axes.set_yticks([])
        axes.set_ylabel("no outline")
    if named:
        _names(axes, shaft)


def _to_scale(axes: Axes, shaft: Shaft) -> None:
    """Once all is drawn: mm as long either way. Panels stay in line; the radii shown give way."""
    window = _window(shaft)
    axes.set_xlim(window.left, window.right)
    axes.set_ylim(-window.reach, window.reach, auto=True)
    axes.set_aspect("equal", adjustable="datalim")


def _names(axes: Axes, shaft: Shaft) -> None:
    """Names of the stations over the view; of those at one node together."""
    by_node: dict[int, list[str]] = {}
    for s in shaft.stations:
        by_node.setdefault(s.node, []).append(s.name)
    for node, names in by_node.items():
        x = MM * shaft.positions()[node - 1]
        axes.axvline(x, color=EDGE, lw=0.6, ls=":")
        place = ("data", "axes fraction")
        axes.annotate(", ".join(names), (x, 1.02), xycoords=place, ha="center", fontsize="small")


def _cone(axes: Axes, start: float, e: Element, which: int, colour: str) -> None:
    """Outside (`which` = 0) or bore (1) of a cylinder or cone that begins at `start` (mm)."""
    _outline(axes, start, e.length, (e.diameters(0.0)[which], e.diameters(1.0)[which]), colour)


def _outline(axes: Axes, start: float, length: float, diameters: tuple[float, float], colour: str) -> None:
    """Of a body of revolution from `start` (mm) on, with diameters at its ends; its lengths in m."""
    first, second = (0.5 * MM * diameter for diameter in diameters)
    end = start + MM * length
    corners = [(start, -first), (start, first), (end, second), (end, -second)]
    axes.add_patch(Polygon(corners, facecolor=colour, edgecolor=EDGE, lw=0.6))


def _supports(axes: Axes, shaft: Shaft) -> None:
    """A triangle under every seat, at the shaft's surface there."""
    position = MM * shaft.positions()
    for node in sorted({s.node for s in shaft.seats}):
        touching = shaft.elements[max(node - 2, 0) : node]
        radius = 0.5 * MM * max((e.widest for e in touching), default=0.0)
        axes.plot(position[node - 1], -radius, marker=6, color=GREEN, ms=11)


def drawing(figure: FigureBase, shaft: Shaft) -> list[Axes]:
    """The rotor's side view alone, to scale."""
    sized(figure, WIDTH, 1.2 + _window(shaft).height)
    axes = figure.subplots()
    side_view(axes, shaft, named=True)
    window = _window(shaft)
    axes.set_xlim(window.left, window.right)
    axes.set_ylim(-window.reach, window.reach)
    axes.set_aspect("equal")
    axes.set_xlabel(AXIS)
    axes.set_title(shaft.title, pad=18)
    return [axes]


def _draw_points(axes: Axes, shaft: Shaft) -> None:
    """Discs to scale, as wide and large as their inertias make them; masses without, as diamonds."""
    position = MM * shaft.positions()
    for point in shaft.points:
        place, diameter, width = position[point.node - 1], *disc_size(point, shaft)
        if diameter > 0.0:
            _outline(axes, place - 0.5 * MM * width, width, (diameter, diameter), DISC)
        else:
            axes.plot(place, 0.0, "D", color=EDGE, ms=5)


def disc_size(point: PointMass, shaft: Shaft) -> tuple[float, float]:
    """Outer diameter and width (m) of the disc on the shaft that has a point's inertias; 0, 0 without one.

    Jp/m = (D2 + d2)/8, Jd/m = (3 (D2 + d2)/4 + w2)/12; d is the shaft's diameter beside the node.
    """
    if point.mass <= 0.0 or point.polar_inertia <= 0.0:
        return 0.0, 0.0
    beside = shaft.elements[max(point.node - 2, 0) : point.node]
    squares = 8.0 * point.polar_inertia / point.mass
    outer = squares - min(e.outer_diameter for e in beside) ** 2
    width = 12.0 * point.diametral_inertia / point.mass - 0.75 * squares
    if outer <= 0.0:
        return 0.0, 0.0
    return math.sqrt(outer), math.sqrt(max(width, 0.0))


SCALE_MARGIN = 1.15  # of the highest line that counts: the end of the scale
MAX_SPEED_RATIO = 2.5  # times the highest speed: lines from there on are not followed by the scale
SENSE_STYLES = (  # of each sense: name, marker, colour
    ("forward", "^", BLUE),
    ("backward", "v", ORANGE),
    ("planar", "o", GREEN),
)
MARKER_STRIDE = 2  # speeds, of the markers


def held_campbell(figure: FigureBase, held: HeldModes, title: str) -> list[Axes]:
    """Damped whirl frequencies [Hz] over speed [rpm] above the damping ratios [1], critical speeds marked.

    Forward, backward and planar whirl differ in marker and colour; what grows is crossed out. Grey: the
    speed that the modes are told at.
    """
    axes, damping = sized(figure, 9.0, 8.0).subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    speeds = RPM * held.lines.speeds
    hertz = np.imag(held.lines.roots) / (2.0 * math.pi)
    shown = _shown(held, hertz)
    for panel, values in ((axes, hertz), (damping, damping_ratios(held.lines.roots))):
        panel.plot(speeds, values[:, shown], color=GREY, lw=0.7, zorder=1)
        _marks(panel, held, values, shown)
    axes.plot(speeds, speeds / 60.0, ":", color=BLACK, lw=1.2, label="1x, once per turn")
    axes.plot([], [], color=GREY, lw=0.8, label=f"{RPM * held.speed:.5g} rpm")
    _draw_critical(axes, held)
    for panel in (axes, damping):
        panel.axvline(RPM * held.speed, color=GREY, lw=0.8, zorder=0)
    axes.set_xlim(0.0, float(speeds[-1]))
    top = np.nanmax(hertz[:, shown], initial=float(speeds[-1]) / 60.0)
    axes.set_ylim(0.0, SCALE_MARGIN * float(top))
    axes.set_ylabel("damped whirl frequency [Hz]")
    damping.axhline(0.0, color=BLACK, lw=0.6)
    damping.set_ylabel("damping ratio [1]")
    damping.set_xlabel("rotor speed [rpm]")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside right upper", fontsize="small")
    figure.suptitle(title)
    return [axes, damping]


def _shown(held: HeldModes, hertz: np.ndarray) -> np.ndarray:
    """Lines to draw: those that begin below MAX_SPEED_RATIO times the highest speed, or the lowest."""
    limit = MAX_SPEED_RATIO * held.lines.speeds[-1] / (2.0 * math.pi)
    slow = hertz[: max(1, len(hertz) // 4)]  # where whirls of a mode have not parted
    lowest = np.nanmin(np.where(np.isnan(slow), np.inf, slow), axis=0)
    return np.flatnonzero((lowest < limit) | (np.argsort(np.argsort(lowest)) < 4))


def _marks(panel: Axes, held: HeldModes, values: np.ndarray, shown: np.ndarray) -> None:
    """Markers of the lines `shown`, by sense, and of what grows."""
    places, sense = np.broadcast_to(RPM * held.lines.speeds[:, None], values.shape), held.lines.sense
    turns = {
        "forward": sense >= PLANAR_LIMIT,
        "backward": sense <= -PLANAR_LIMIT,
        "planar": np.abs(sense) < PLANAR_LIMIT,
    }
    for name, marker, colour in SENSE_STYLES:
        there = turns[name][::MARKER_STRIDE, shown]
        if there.any():
            x, y = (array[::MARKER_STRIDE, shown][there] for array in (places, values))
            panel.plot(x, y, marker, color=colour, ms=4, mew=0.0, ls="none", label=name)
    growing = (damping_ratios(held.lines.roots) < -MIN_DAMPING_RATIO)[:, shown]
    if growing.any():
        x, y = (array[:, shown][growing] for array in (places, values))
        panel.plot(x, y, "x", color=PURPLE, ms=7, mew=1.6, ls="none", label="grows: unstable")


def _draw_critical(axes: Axes, held: HeldModes) -> None:
    """Circles where a line crosses the spin, in the colour of its whirl; their speeds are in the legend."""
    for one in held.lines.crossings:
        speed, name = RPM * one.speed, whirl_name(one.sense)
        colour = next(colour for known, _, colour in SENSE_STYLES if known == name)
        label = f"critical, {name}:\n{speed:.0f} rpm, {speed / 60.0:.1f} Hz"
        axes.plot(speed, speed / 60.0, "o", mfc="none", mec=colour, ms=9, mew=1.3, ls="none", label=label)
