"""Motion of the bodies: orbits, speeds, and what is left of the gaps around the rotor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle, pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, PowerNorm, to_hex
from matplotlib.figure import FigureBase

from ...master.common.text import RPM, UM
from ...master.coupling.connections import Attachment, housing_port
from ...master.coupling.loop.span import zero_of
from ...master.results.final_state import Finished, ReadableSystem
from ...master.results.least_gaps import left_of
from ...master.results.recording import Recording
from ...master.results.summary import course_at, course_of_held, relative_orbit, seat_name
from ...master.results.whirl.contacts import WhirlDirection
from .style import (
    BLACK,
    BLUE,
    COLOURS,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    TIME,
    YELLOW,
    beginning,
    calm,
    draw_dense,
    key_below,
    key_beside,
    sized,
    thinned,
    within,
    zooms,
)

ROTOR, ROLLING_ON_ROTOR = "rotor", "rolling"  # turn with the rotor, and as what rolls on it without slip


@dataclass(frozen=True)
class _Turn:
    """Something that turns: its variable (rad/s, or m/s on a diameter), and how it is drawn."""

    variable: str
    label: str
    colour: str
    on: str = ""  # the diameter
    width: float = 1.0
    line: str = "-"


GROUPS: tuple[tuple[str, tuple[_Turn, ...]], ...] = (  # broad ones first, so that what coincides is seen
    (
        "rotor, ring",
        (
            _Turn("ring.omega", "inner ring", ORANGE, width=2.0),
            _Turn(ROLLING_ON_ROTOR, "inner ring without slip", BLUE, line=":", width=1.6),
            _Turn(ROTOR, "rotor", BLACK, line="--"),
        ),
    ),
    (
        "round the axis",
        (
            _Turn("speed.orbit", "balls, mean", GREEN, "balls.pitch_diameter", width=2.0),
            _Turn("speed.cage", "cage", YELLOW, "balls.pitch_diameter", line="--"),
        ),
    ),
    (
        "spin of the balls",
        (
            _Turn("hardest.speed", "ball hit hardest", GREY, "balls.diameter"),
            _Turn("speed.ball", "balls, mean", PURPLE, "balls.diameter", width=1.4),
        ),
    ),
)
NEAR = 0.5  # of the clearance, to either side
LANDING_S = 0.1  # s after the first touch, of an orbit from near
SPIN_UP_ZOOM = 1.5  # times the ring's first synchronism: here the zoom on the spin-up ends


@dataclass(frozen=True)
class _Track:
    """The orbit of a body [µm]."""

    label: str
    colour: str
    x: np.ndarray
    y: np.ndarray


def paths(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Rotor in the clearance circle, its landing from near, and the orbits of rings and cage [µm]."""
    system, recording = run.system, run.recording
    cage, rings = _cage(recording, a), _rings(system, recording, a)
    panels = [("rings", rings)] if rings else []
    panels += [("cage in front of the rings", [*rings, *cage])] if cage else []
    rows, columns = (1, 2 + len(panels)) if len(panels) < 2 else (2, 2)
    sized(figure, 5.2 * columns, 0.4 + 5.0 * rows)
    whole, near, *others = figure.subplots(rows, columns).flat
    draw_orbit(whole, run, a)
    _draw_landing(near, run, a)
    for axes, (title, tracks) in zip(others, panels, strict=True):
        for track in tracks:
            axes.plot(track.x, track.y, color=track.colour, lw=0.4, alpha=0.6, label=track.label)
        axes.set_title(f"{title} of {a.bearing}")
        axes.set_aspect("equal", adjustable="datalim")
        key_below(axes)
    for axes in others:
        axes.set_xlabel("x [µm]")
        axes.set_ylabel("y [µm]")
    figure.suptitle(f"{run.scene.title}\n{a.bearing}")
    return [whole, near, *others]


def speeds(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Speeds [rpm] of rotor and ring, of cage and balls round the axis, and of the balls' spin.

    While the ring is spun up, from then on, and at last. Balls spin against the ring; here they have its
    sign.
    """
    time = run.recording.time
    sync = run.system.value(f"{a.bearing}.ring.sync_time") - zero_of(run.scene, run.system)
    spun_up = SPIN_UP_ZOOM * (sync if sync > 0.0 else float(time[-1]))
    spans = zooms(time, spun_up)
    zoomed = int(np.sum(time >= spun_up)) > 1
    groups = [(title, shown) for title, turns in GROUPS if (shown := _turning(run, a, turns))]
    sized(figure, max(9.0, 1.0 + 5.5 * len(spans)), 1.2 + 2.4 * len(groups))
    grid = figure.subplots(len(groups), len(spans), squeeze=False, sharex="col")
    for row, (title, shown) in zip(grid, groups, strict=True):
        for axes, span in zip(row, spans, strict=True):
            later = zoomed and _is_whole(span, time)
            _draw_speeds(axes, time, _from(spun_up, time, shown) if later else shown, span)
            if later:
                _zoom(axes, [values[time >= spun_up] for _, values in shown])
            calm(axes, [values for _, values in shown])
        row[0].set_ylabel(f"{title} [rpm]")
        handles, labels = row[0].get_legend_handles_labels()
        key_beside(row[-1], handles[::-1], labels[::-1])  # the first is drawn in front
    for head, foot, span in zip(grid[0], grid[-1], spans, strict=True):
        head.set_title(_title(span, spans, _is_whole(span, time), zoomed))
        foot.set_xlabel(TIME)
    figure.suptitle(f"{run.scene.title}\n{a.bearing}")
    return list(grid.flat)


def _turning(run: Finished, a: Attachment, turns: tuple[_Turn, ...]) -> list[tuple[_Turn, np.ndarray]]:
    """The `turns` that were recorded, with their values (rpm)."""
    shown: list[tuple[_Turn, np.ndarray]] = []
    for turn in turns:
        of_rotor = turn.variable in (ROTOR, ROLLING_ON_ROTOR)
        name = a.motion("omega") if of_rotor else f"{a.bearing}.{turn.variable}"
        if name in run.recording:
            shown.append((turn, RPM * run.recording[name] / _radius(run, a, turn)))
    return shown


def _from(
    begin: float, time: np.ndarray, shown: list[tuple[_Turn, np.ndarray]]
) -> list[tuple[_Turn, np.ndarray]]:
    """The curves from `begin` (s) on; earlier values are not drawn."""
    return [(turn, np.where(time >= begin, values, np.nan)) for turn, values in shown]


def _radius(run: Finished, a: Attachment, turn: _Turn) -> float:
    """By what a variable is divided to be the spin: the radius (m) of a speed in m/s, or a ratio."""
    value = run.system.value
    if turn.variable == ROLLING_ON_ROTOR:
        journal = value(f"{a.bearing}.journal_radius")
        return (journal + value(f"{a.bearing}.clearance")) / journal
    return 0.5 * value(f"{a.bearing}.{turn.on}") if turn.on else 1.0


def _draw_speeds(
    axes: Axes, time: np.ndarray, shown: list[tuple[_Turn, np.ndarray]], span: tuple[float, float]
) -> None:
    part = within(time, span)
    for turn, values in shown:
        curve = thinned(time[part], values[part])
        axes.plot(*curve, turn.line, color=turn.colour, lw=turn.width, label=turn.label)
    axes.set_xlim(*span)
    axes.ticklabel_format(useOffset=False)


def _is_whole(span: tuple[float, float], time: np.ndarray) -> bool:
    return span == (beginning(time), float(time[-1]))


def distance(figure: FigureBase, run: Finished, a: Attachment) -> Axes:
    """How far the journal is from the bearing's middle [µm], beside the clearance."""
    recording = run.recording
    axes = sized(figure, 9, 4).subplots()
    radius = UM * np.hypot(*relative_orbit(run.system, a, recording))
    axes.plot(*thinned(recording.time, radius), color=BLUE, lw=0.6, label="journal")
    clearance = UM * run.system.value(f"{a.bearing}.clearance")
    axes.axhline(clearance, ls="--", color=GREY, lw=1, label="clearance")
    axes.set_ylabel("distance from the middle [µm]")
    return _over_time(axes, run, a)


def held(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Way of a journal that its bearing holds all the time [µm], and the force on it [N], over time."""
    force, way = course_of_held(a, run.recording)
    panels = list(sized(figure, 9, 6).subplots(2, sharex=True))
    for axes, pair, factor, name in zip(panels, (way, force), (UM, 1.0), ("journal", "force"), strict=True):
        for part, axis, color in zip(pair, ("across", "up"), (ORANGE, BLUE), strict=True):
            axes.plot(
                *thinned(run.recording.time, factor * part), color=color, lw=0.6, label=f"{name}, {axis}"
            )
        _over_time(axes, run, a)
    panels[0].set_xlabel("")
    panels[0].set_ylabel("displacement [µm]")
    panels[1].set_title("")
    panels[1].set_ylabel(f"force of {a.bearing} [N]")
    return panels


def slowing(figure: FigureBase, run: Finished, a: Attachment) -> Axes:
    """How the rotor's speed falls [rpm]: of a bearing that tells no speeds the only one known."""
    speed = RPM * run.recording[a.motion("omega")]
    axes = sized(figure, 9, 4).subplots()
    axes.plot(*thinned(run.recording.time, speed), color=BLACK, label="rotor")
    axes.ticklabel_format(useOffset=False)
    axes.set_ylabel("speed [rpm]")
    return _over_time(axes, run, a)


def has_faces(run: Finished, a: Attachment) -> bool:
    """Whether a shoulder of the rotor can land on the bearing."""
    names = (f"{a.bearing}.shoulder.gap_{side}" for side in ("minus", "plus"))
    faces = any(name in run.system and run.system.value(name) > 0.0 for name in names)
    return faces and a.motion("z") in run.recording and f"{a.bearing}.shoulder.force" in run.recording


def along(figure: FigureBase, run: Finished, a: Attachment) -> list[Axes]:
    """Rotor and ring along the shaft between the faces [µm], and the forces there [N]."""
    recording, time = run.recording, run.recording.time
    upper, lower = sized(figure, 9, 6).subplots(2, 1, sharex=True)
    port = housing_port(run.system, a.bearing)
    housing = recording[f"{port}.z"] if port and f"{port}.z" in recording else 0.0
    draw_dense(upper, time, UM * (recording[a.motion("z")] - housing), BLACK, "rotor")
    if (ring := f"{a.bearing}.along.z") in recording:
        draw_dense(upper, time, UM * (recording[ring] - housing), ORANGE, "inner ring")
    for side, sign in (("minus", -1.0), ("plus", 1.0)):
        gap = run.system.value(f"{a.bearing}.shoulder.gap_{side}")
        if gap > 0.0:
            style = {"ls": "--", "color": BLUE if sign > 0.0 else PURPLE, "lw": 1}
            upper.axhline(sign * UM * gap, label=f"face at {side} z", **style)
    upper.set_ylabel("along the shaft [µm]")
    key_beside(upper)
    draw_dense(lower, time, recording[f"{a.bearing}.shoulder.force"], BLUE, "face")
    if (balls := f"{a.bearing}.along.force") in recording:
        draw_dense(lower, time, recording[balls], GREEN, "balls on the ring")
    lower.set_ylabel("force along the shaft [N]")
    lower.set_xlabel(TIME)
    key_beside(lower)
    upper.set_title(f"{run.scene.title}\n{a.bearing}, along the shaft")
    return [upper, lower]


def _over_time(axes: Axes, run: Finished, a: Attachment) -> Axes:
    time = run.recording.time
    axes.set_xlim(beginning(time), float(time[-1]))
    axes.set_xlabel(TIME)
    axes.set_title(f"{run.scene.title}\n{a.bearing}")
    key_beside(axes)
    return axes


def draw_orbit(axes: Axes, run: Finished, a: Attachment) -> Axes:
    """The rotor in its clearance circle, as it lies to its housing [µm]."""
    reach = _draw(axes, run, a)
    key_below(axes, 2)
    _times_beside([axes], run.recording.time)
    _draw_arrows(axes, run, a, reach)
    axes.set_title(f"rotor in {a.bearing}")
    return axes


def draw_clearance(
    axes: Axes, run: Finished, a: Attachment, centre: Sequence[float], colour: str = GREY
) -> float:
    """The clearance as a circle about `centre` (µm); returns its radius, 0 where none is stated."""
    if "clearance" not in run.system.components[a.bearing].variables:
        return 0.0
    radius = UM * run.system.value(f"{a.bearing}.clearance")
    angle = np.linspace(0.0, 2.0 * np.pi, 721)
    circle = centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)
    axes.plot(*circle, "--", color=colour, lw=1, label="clearance")
    return radius


BY_TIME = LinearSegmentedColormap.from_list("time", (BLUE, GREEN, YELLOW, ORANGE), 24)
DENSE = 2_000  # points of one colour from which on their line is thin
LANDED_S, LANDED = 0.01, 0.25  # s, and the part of the colours for them: about when a rotor lands


def _early(time: np.ndarray) -> float:
    """Power of a colour's place: of long runs, too, the landing has colours of its own."""
    return float(np.clip(np.log(LANDED_S / max(np.ptp(time), LANDED_S)) / np.log(LANDED), 1.0, 4.0))


def _draw_by_time(axes: Axes, time: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    """A way coloured by its time (s), the landing in front: all that comes later would hide it."""
    begin = beginning(time)
    ends = begin + (time[-1] - begin) * np.linspace(0.0, 1.0, BY_TIME.N + 1) ** _early(time)
    edges = np.searchsorted(time, ends)
    edges[0], edges[-1] = 0, len(time)
    for number, (first, last) in enumerate(pairwise(edges)):
        part = slice(max(first - 1, 0), last)
        width, front = (0.6 if last - first < DENSE else 0.25), 2.0 - 0.01 * number
        axes.plot(x[part], y[part], color=to_hex(BY_TIME(number)), lw=width, zorder=front, label="_rotor",
                  rasterized=len(x) > MAX_ORBIT_POINTS)  # fmt: skip


def _times_beside(panels: list[Axes], time: np.ndarray) -> None:
    """The key of an orbit's colours, beside the last of its panels; time: (s), as recorded."""
    begin, end = beginning(time), float(time[-1])
    colours = ScalarMappable(PowerNorm(1.0 / _early(time), begin, end), BY_TIME)
    ticks = {"ticks": begin + (end - begin) * np.linspace(0.0, 1.0, 7) ** _early(time), "format": "%.2g"}
    panels[0].figure.colorbar(colours, ax=panels, label=TIME, fraction=0.04, pad=0.02, aspect=30, **ticks)


def _draw_arrows(axes: Axes, run: Finished, a: Attachment, reach: float) -> None:
    """How the rotor spins and, where it does, whirls: arrows outside the orbit, for which there is room."""
    course = course_at(run.system, a, run.recording, zero_of(run.scene, run.system))
    spin = 1.0 if np.median(run.recording[a.motion("omega")]) >= 0.0 else -1.0
    turns = [("spin", spin, 135.0)]
    if course is not None and (whirl := course.whirl.decisive) is not None:
        forward = whirl.direction is WhirlDirection.FORWARD
        turns.append(("whirl", spin if forward else -spin, 45.0))
    for name, sense, middle in turns:
        angle = np.radians(middle + sense * np.linspace(-14.0, 14.0, 15))
        x, y = 1.15 * reach * np.cos(angle), 1.15 * reach * np.sin(angle)
        axes.plot(x, y, color=BLACK, lw=1, label=f"_{name}")
        head = {"arrowstyle": "-|>", "color": BLACK, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", (x[-1], y[-1]), (x[-2], y[-2]), arrowprops=head)
        axes.text(1.3 * reach * np.cos(np.radians(middle)), 1.3 * reach * np.sin(np.radians(middle)), name,
                  ha="center", va="center")  # fmt: skip
    axes.set_xlim(-MARGIN * reach, MARGIN * reach)
    axes.set_ylim(-MARGIN * reach, MARGIN * reach)


def _draw_landing(axes: Axes, run: Finished, a: Attachment) -> None:
    """The rotor from near, about where it touches first, until soon after; without a touch, all of it."""
    touched = run.system.value(f"{a.bearing}.contact.first_time")  # -1: never
    landed = touched - zero_of(run.scene, run.system) if touched != -1.0 else np.inf
    _draw(axes, run, a, landed + LANDING_S)
    if touched != -1.0:
        x, y = (float(np.interp(landed, run.recording.time, part)) for part in _way(run, a))
        reach = NEAR * UM * run.system.value(f"{a.bearing}.clearance")
        axes.set_xlim(x - reach, x + reach)
        axes.set_ylim(y - 0.4 * reach, y + 1.6 * reach)
    axes.set_title(f"landing in {a.bearing}, to {min(landed + LANDING_S, run.recording.time[-1]):.3g} s")


def _rings(system: ReadableSystem, recording: Recording, a: Attachment) -> list[_Track]:
    tracks: list[_Track] = []
    if f"{a.bearing}.ring.x" in recording:
        x, y = (UM * recording[f"{a.bearing}.ring.{axis}"] for axis in "xy")
        tracks.append(_Track("inner ring", ORANGE, x, y))
    port = housing_port(system, a.bearing)
    if port is not None:
        x, y = (UM * recording[f"{port}.{axis}"] for axis in "xy")
        tracks.append(_Track("outer ring", GREEN, x, y))
    return tracks


def _cage(recording: Recording, a: Attachment) -> list[_Track]:
    if f"{a.bearing}.cage.x" not in recording:
        return []
    x, y = (UM * recording[f"{a.bearing}.cage.{axis}"] for axis in "xy")
    return [_Track("cage", PURPLE, x, y)]


def _zoom(axes: Axes, values: list[np.ndarray]) -> None:
    """Limit an axis to the range of `values` and a little more."""
    low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
    if high > low:
        axes.set_ylim(low - 0.05 * (high - low), high + 0.05 * (high - low))


def _title(span: tuple[float, float], spans: list[tuple[float, float]], whole: bool, zoomed: bool) -> str:
    if whole:
        return "whole run, speeds once spun up" if zoomed else "whole run"
    return "spin-up" if span == spans[0] else f"last {1e3 * (span[1] - span[0]):.0f} ms"


COLUMNS = 4  # at most
MARGIN = 1.2  # of the largest distance drawn, with room for arrows
MAX_ORBIT_POINTS = 12_000


def orbits(
    figure: FigureBase,
    run: Finished,
    seats: list[Attachment],
) -> list[Axes]:
    """Journal at each of `seats` in its clearance circle [µm], all to the same scale.

    The origin is the axis of the magnetic bearings. The circle stands where the housing is at the start,
    so that a misalignment shows; the journal is drawn as it lies to its housing.
    """
    columns = min(len(seats), COLUMNS)
    rows = -(-len(seats) // columns)
    sized(figure, 5.6 * columns, 0.5 + 6.0 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).flat)
    reach = max(_draw(axes, run, a) for axes, a in zip(panels, seats, strict=False))
    for axes, a in zip(panels, seats, strict=False):
        axes.set_title(f"{seat_name(a, seats)} ({a.bearing})\n{_verdict(run, a)}")
        _draw_arrows(axes, run, a, reach)
    for axes in panels[len(seats) :]:
        axes.set_visible(False)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False)
    _times_beside(panels, run.recording.time)
    figure.suptitle(run.scene.title)
    return panels[: len(seats)]


def _centre(run: Finished, a: Attachment) -> list[float]:
    """Where a bearing's housing is at the start (µm)."""
    port = housing_port(run.system, a.bearing)
    return [UM * float(run.recording[f"{port}.{axis}"][0]) if port else 0.0 for axis in "xy"]


def _way(run: Finished, a: Attachment) -> list[np.ndarray]:
    """The journal as it lies to its housing, which stands where it is at the start (µm)."""
    ways = zip(relative_orbit(run.system, a, run.recording), _centre(run, a), strict=True)
    return [UM * values + middle for values, middle in ways]


def _draw(axes: Axes, run: Finished, a: Attachment, until: float = np.inf) -> float:
    """One seat up to a time (s); returns how far from the origin anything lies (µm)."""
    centre, time = _centre(run, a), run.recording.time
    x, y = (values[time <= until] for values in _way(run, a))
    radius = draw_clearance(axes, run, a, centre)
    axes.plot(*centre, "+", color=GREY, ms=9, label="centre of the housing")
    _draw_by_time(axes, time, x, y)
    axes.plot(0.0, 0.0, "x", color=BLACK, ms=6, label="axis of the magnetic bearings")
    axes.plot(x[-1], y[-1], "o", color=BLACK, ms=5, zorder=3, label="rotor at the end")
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("x against the housing [µm]")
    axes.set_ylabel("y against the housing [µm]")
    return max(float(np.max(np.abs([x, y]))), *(abs(middle) + radius for middle in centre))


def _verdict(run: Finished, a: Attachment) -> str:
    """Whirl in words, with its length and frequency."""
    course = course_at(run.system, a, run.recording, zero_of(run.scene, run.system))
    if course is None:
        return "no clearance, no verdict"
    whirl = course.whirl
    if whirl.frequency is None:
        return course.words
    return f"{course.words}\n{whirl.revolutions:.1f} revolutions at {whirl.frequency:.0f} Hz"


GAPS_NEAR_S = 0.5  # s, of the gaps from near


def gaps_left(figure: FigureBase, run: Finished) -> list[Axes]:
    """Each gap of the scene over time [µm], in a panel of its own; at 0 the rotor touches the stator."""
    gaps, time = run.scene.gaps, run.recording.time
    spans = list(dict.fromkeys(zooms(time, GAPS_NEAR_S)[:2]))
    sized(figure, 1.5 + 5.5 * len(spans), 1.0 + 1.7 * len(gaps))
    grid = figure.subplots(len(gaps), len(spans), squeeze=False, sharex="col", sharey="row")
    for row, gap, colour in zip(grid, gaps, cycle(COLOURS), strict=False):
        found = left_of(gap, run.recording)
        for axes, span in zip(row, spans, strict=True):
            part = within(found.time, span)
            draw_dense(axes, found.time[part], UM * found.left[part], colour)
            axes.axhline(0.0, color=GREY, lw=1)
            axes.set_xlim(*span)
        since = found.since(0.0)
        least, when = UM * since.left[since.least], since.time[since.least]
        row[0].plot(
            [when], [least], "o", color=colour, ms=4, label=f"least, {least:.3g} µm at {when:.3g} s"
        )
        row[0].set_ylim(bottom=min(0.0, 1.2 * least))
        row[0].set_ylabel("gap left [µm]")
        along = " along the shaft" if gap.axial else ""
        row[0].set_title(f"{gap.name}, {1e3 * gap.size:g} mm{along}", loc="left")
        key_beside(row[-1], *row[0].get_legend_handles_labels())
    for foot in grid[-1]:
        foot.set_xlabel(TIME)
    figure.suptitle(f"{run.scene.title}\nrotor against stator")
    return list(grid.flat)
