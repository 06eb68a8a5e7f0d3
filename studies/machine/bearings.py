"""The bearings that scenes may take by name, as tables."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np

from ...bearings import catalogue
from ...bearings.angular.angular_row import ARRANGEMENTS, BACK_TO_BACK, CLAMPED, SINGLE, SINGLES
from ...bearings.angular.pair_statics import MountedRows, balance, balls_on
from ...bearings.catalogue import NUMBERS, OWN_FILE, Bearing, CatalogueError, speed_limits
from ...bearings.catalogue.load_sharing import HELD, RingSeat, ball_loads, harmonics_for
from ...bearings.catalogue.spinning import spun
from ...master.common.errors import TouchdownError, one_of
from ...master.common.text import MM, RPM, UM, aligned
from ...modelkit.units import per_display

SHOWN_IN = {"m": "mm", "N": "kN", "rad": "deg"}
MICROMETRE_KEYS = ("play",)  # in um
BORE_TOLERANCE = 1e-6  # m, of a bore asked for
HINTS = (
    "ceramic balls, as of hybrid bearings: `touchdown new --balls Si3N4`, or beside a preset in a scene "
    'balls.material = "Si3N4"',
    "duplex: a pair side by side is one set of balls with balls.rows = 2 (as 7914 pair); in a drop it "
    "takes thrust, too, where it has an arrangement (as 71907 DB); statics: `--thrust`",
    "numbers of one bearing and where each is from: `touchdown catalogue NAME`",
)


def available_bearings(folder: Path) -> dict[str, Bearing]:
    """All bearings that a scene in `folder` may take by name: its own first. Raises TouchdownError."""
    mine = catalogue.own(folder)
    return mine | {name: catalogue.bearing(name) for name in catalogue.built_in() if name not in mine}


def find_bearing(name: str, folder: Path) -> Bearing:
    """The bearing that a scene in `folder` calls `name`. Raises TouchdownError."""
    try:
        return catalogue.bearing(catalogue.bearing_reference(name, folder))
    except CatalogueError as error:
        raise TouchdownError(f"{error}; `touchdown catalogue` lists them") from None


def described(bearing: Bearing) -> str:
    """All numbers of a bearing, with unit, meaning and origin."""
    rows: list[tuple[str, ...]] = []
    for name, value in bearing.numbers().items():
        unit, meaning = NUMBERS[name]
        shown = "um" if name in MICROMETRE_KEYS else SHOWN_IN.get(unit, unit)
        number = f"{per_display(unit, shown) * value:.5g}"
        rows.append((name, number, shown if shown != "1" else "", f"{meaning} ({bearing.origins[name]})"))
    lines = [bearing.designation, *aligned(rows, "<><", "  ")]
    rated = bearing.capacity()
    if bearing.balls.rows > 1:
        lines.append(f"  all rows: C0 {1e-3 * rated.static:.4g} kN, C {1e-3 * rated.dynamic:.4g} kN")
    return "\n".join(lines)


SEATS = (
    ("held round by a rigid seat", HELD),
    ("in a soft seat of 1e8 N/m", RingSeat(stiffness=1e8)),
    ("in a soft seat of 5e6 N/m", RingSeat(stiffness=5e6)),
    ("loose in a rigid seat by 5 um (radial)", RingSeat(play=5e-6)),
    ("loose in a rigid seat by 20 um (radial)", RingSeat(play=20e-6)),
)
POSITIONS = (0.0, 0.5)  # of the load: on a ball, between two


def shared(bearing: Bearing, load: float) -> str:
    """The most loaded ball under a static radial `load` (N), by inner ring and outer ring's seat."""
    rings = ("rigid", 0), ("bends", harmonics_for(bearing.balls.count))
    rows = [("outer ring", *(f"inner ring {how}" for how, _ in rings))]
    for title, seat in SEATS:
        most = (
            max(float(ball_loads(bearing, load, top, offset, seat).max()) for offset in POSITIONS)
            for _, top in rings
        )
        rows.append((title, *(f"{force:.1f} N" for force in most)))
    title = f"{bearing.designation} under a static load of {load:g} N: most loaded ball, worst place"
    held = "Drops run with an outer ring that is held round, and an inner one that bends by ring.harmonics."
    return "\n".join([title, *aligned(rows, "<>", "  "), f"  {held}"])


def fast_enough(bearing: Bearing, speed: float) -> str:
    """Which cages run the bearing at `speed` (rad/s) for long, and by how much its inner ring grows."""
    unit = speed_limits.MM_RPM
    factor = speed_limits.speed_factor(bearing, speed) / unit
    lines = [f"{bearing.designation} at {RPM * speed:,.0f} rpm: {factor:,.0f} mm rpm over the bore"]
    rows: list[tuple[str, ...]] = []
    for cage, limit in speed_limits.limits(bearing).items():
        verdict = "runs for long" if factor <= limit / unit else "is too fast for long"
        rows.append((cage, f"{limit / unit:,.0f} mm rpm", verdict))
    lines += aligned(rows, "<><", "  ")
    lines.append(
        "  Makers' limits (NHBB; hybrids 20 % more) are of lubricated bearings that run for hours; without "
        "a cage they\n  state none. A landing lasts seconds: beyond them ask the maker."
    )
    lines += _growth_lines(bearing, speed)
    return "\n".join(lines)


def _growth_lines(bearing: Bearing, speed: float) -> Iterable[str]:
    """Lines on clearance gained and play lost by spin, once the inner ring runs with the shaft."""
    ring = spun(bearing, speed)
    judged = "which matters to the balls" if ring.matters else "which is little"
    yield (
        f"  inner ring by its spin: the bore grows by {1e6 * ring.bore:.4g} um on radius, the race by "
        f"{1e6 * ring.race:.4g} um, which comes off the play"
    )
    yield (f"  {ring.words()}, {judged}; drops have it with ring.growth = 1")


def _mounted(bearing: Bearing, arrangement: str = "", preload: float = 0.0) -> MountedRows:
    """The bearing beside its like in an `arrangement`, a word of `ARRANGEMENTS`, with `preload` (N).

    Without a word a pair is not changed, other bearings of two rows back to back, one with a row alone;
    rows are a width apart. Without a preload it is that of the pair. Raises TouchdownError.
    """
    words = ARRANGEMENTS.words
    if arrangement and arrangement not in words:
        raise TouchdownError(f"--arrangement {arrangement}: {one_of(arrangement, words)}")
    rows = bearing.balls.rows
    usual = bearing.arrangement if rows != 2 or bearing.arrangement != SINGLE else BACK_TO_BACK
    kind = words.index(arrangement) if arrangement else usual
    if rows > 2 or (rows == 2 and kind in SINGLES):
        raise TouchdownError(f"{bearing.designation} has {rows} rows; --thrust takes one, or pairs")
    if kind not in SINGLES and bearing.contact_angle == 0.0:
        raise TouchdownError(
            f"{bearing.designation} has no contact angle, and makes no pair; leave --arrangement out"
        )
    if preload and kind not in CLAMPED:
        raise TouchdownError(
            f"--preload clamps rows against each other, which {words[kind]} has none of; "
            'give --arrangement "back to back" or "face to face"'
        )
    return MountedRows(
        bearing.balls,
        bearing.contact_angle,
        bearing.rated().rings,
        arrangement=kind,
        distance=bearing.width / rows,
        preload=preload or (bearing.preload if kind in CLAMPED else 0.0),
    )


def pushed(bearing: Bearing, thrust: float, arrangement: str = "", preload: float = 0.0) -> str:
    """Shift, balls and stiffness of a bearing under a static `thrust` (N); otherwise as `_mounted`."""
    how = _mounted(bearing, arrangement, preload)
    rows, angles = how.rows(), how.angles()
    try:
        found = balance(rows, angles, (0.0, 0.0, thrust, 0.0, 0.0))
    except ValueError as error:
        raise TouchdownError(f"{bearing.designation} under {thrust:g} N along the shaft: {error}") from None
    preload = how.preload
    clamped = f", preload {preload:.4g} N, rows {1e3 * how.distance:g} mm apart" if preload else ""
    title = f"{bearing.designation}, {ARRANGEMENTS.words[how.arrangement]}{clamped}"
    table = [["inner ring shifts along the shaft by", f"{UM * found.pose[2]:.3f} um", ""]]
    for k, (forces, slants) in enumerate(zip(found.forces, found.angles, strict=True)):
        name = "each ball bears" if len(rows) == 1 else f"each ball of row {k + 1} bears"
        loaded = f"{forces.max():.1f} N", f"at a contact angle of {math.degrees(abs(slants[0])):.2f} deg"
        table.append([name, *(loaded if forces.max() > 0.0 else ("nothing", ""))])
    lines = [f"{title}, under a static thrust of {thrust:g} N", *aligned(table, "<><", "  ")]
    lines += _stiffness_lines("under it", found.stiffness)
    if preload:
        lines += _stiffness_lines("by preload alone", balls_on(rows, angles, np.zeros(5))[1])
    lines.append(
        "  Balls at rest. In drops angular_caged and angular_cageless have angles follow load and speed."
    )
    return "\n".join(lines)


def _stiffness_lines(when: str, stiffness: np.ndarray) -> Iterable[str]:
    """Radial, axial and tilting stiffness (5, 5)."""
    radial, axial, tilt = stiffness[0, 0], stiffness[2, 2], stiffness[4, 4]
    yield (
        f"  stiffness {when}: {1e-6 * radial:.4g} N/um radial, {1e-6 * axial:.4g} N/um axial, "
        f"{tilt:.4g} N m/rad tilt"
    )


def listed(bearings: Mapping[str, Bearing], bore: float | None = None) -> str:
    """A line per bearing: its size in mm, balls, ratings of a row in kN. bore: m, of those to list."""
    chosen = {n: b for n, b in bearings.items() if bore is None or abs(b.bore - bore) < BORE_TOLERANCE}
    if not chosen:
        there = ", ".join(f"{1e3 * size:g}" for size in sorted({b.bore for b in bearings.values()}))
        raise TouchdownError(
            f"no bearing has a bore of {1e3 * (bore or 0.0):g} mm; there are (mm): {there}; "
            'a number without a unit is in m, so write such as "70 mm"'
        )
    rows = [["", "bore x outside x width [mm]", "balls", "C [kN]", "C0 [kN]", "ratings by"]]
    for name, b in chosen.items():
        size = " x ".join(f"{MM * length:g}" for length in (b.bore, b.outside, b.width))
        balls = f"{b.balls.rows} x {b.balls.count}" if b.balls.rows > 1 else str(b.balls.count)
        ratings = (f"{1e-3 * rating:.4g}" for rating in (b.dynamic_rating, b.static_rating))
        by = " and ".join(dict.fromkeys((b.origins["dynamic_rating"], b.origins["static_rating"])))
        rows.append([name, size, balls, *ratings, by])
    return "\n".join((*aligned(rows, "<<>>><"), "", *HINTS))


def as_file(bearing: Bearing) -> str:
    """The bearing as text of a user's file (`bearings.toml`), which scenes beside it take."""
    return f"# To change and keep beside a scene as {OWN_FILE}.\n{catalogue.bearing_file_text(bearing)}"
