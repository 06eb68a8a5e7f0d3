"""Words on what comes near to a whirl and is none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from touchdown.master.results.whirl.contacts import FOLLOWED, TURN, March, Orbit, wrapped
from touchdown.master.results.whirl.stretches import stretches
from touchdown.master.results.whirl.told import short_of_one
from touchdown.master.results.whirl.turning import BACK, Turning

TOO_COARSE = "cannot tell: sampled too coarsely"
LOOPS = 2.0 * TURN  # a bounce or two may chance to circle the centre once
WIDE = 0.2  # of the clearance, least radius of an orbit to remark on; on magnetic bearings it is smaller


def on_turnings(turnings: Sequence[Turning], spin: float) -> str:
    """On contacts that marched, but not as a whirl does; spin: of the rotor (rad/s, its sign counts)."""
    if any(t.turns >= 1.0 for t in turnings):
        return "creeps along the bore"
    best = max((t for t in turnings if not t.creeps), key=lambda t: t.turns, default=None)
    if best is None:
        return ""
    return f"near miss: {short_of_one(best.turns)} turn {best.direction(spin)}"


def on_circling(orbit: Orbit, marches: Sequence[March]) -> str:
    """On an orbit that circles the bearing's centre, or its own, and presses on the bore in places only."""
    touched = np.zeros(len(orbit.time), dtype=bool)
    for march in marches:
        touched[march.rows] = True
    loops = [*_loops(orbit), *_loops(_about_its_mean(orbit))]
    if not loops:
        return ""
    rubs = any(touched[first : last + 1].any() for first, last in loops)
    return "partial rub" if rubs else "orbits without contact"


def _about_its_mean(orbit: Orbit) -> Orbit:
    known = np.isfinite(orbit.radius)
    x, y = (float(np.mean(part, where=known)) if known.any() else 0.0 for part in (orbit.x, orbit.y))
    return orbit._replace(x=orbit.x - x, y=orbit.y - y)


def _loops(orbit: Orbit) -> Iterator[tuple[int, int]]:
    """First and last rows of circling one way by LOOPS or more about the origin, WIDE."""
    angle = orbit.angle
    wide = orbit.radius >= WIDE
    joined = wide[:-1] & wide[1:] & (np.abs(wrapped(np.diff(angle))) < FOLLOWED)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], joined, [False]]).astype(int)))
    for first, last in edges.reshape(-1, 2).tolist():
        unwrapped = np.unwrap(angle[first : last + 1])
        for s in stretches(unwrapped, BACK):
            if abs(s.turn) >= LOOPS:
                yield first + s.first, first + s.last
