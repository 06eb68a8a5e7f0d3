"""How hard pairs are clamped: as mounted, and once their ring turns as the rotor at the shutdown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ...bearings.angular.clamping import Clamping, clamping
from ..coupling.connections import Attachment
from .final_state import Finished
from .ratings import Rated, rated

THROWN = "balls.centrifugal"  # of models whose balls are no bodies, which always are


def clampings(run: Finished, a: Attachment) -> list[Clamping]:
    """At rest, and as fast as the rotor is at the scene's zero; [] of a bearing without a clamped pair."""

    def value(name: str, default: float) -> float:
        full = f"{a.bearing}.{name}"
        return run.system.value(full) if full in run.system else default

    omega, spins = a.motion("omega"), (0.0,)
    if omega in run.recording:
        row = min(int(np.searchsorted(run.recording.time, -1e-12)), len(run.recording.time) - 1)
        spins = 0.0, float(run.recording[omega][row])
    return clamping(value, value(THROWN, 1.0) == 1.0, spins)


def pair_quantities(run: Finished, a: Attachment) -> dict[str, object]:
    """Preload and interference of a seat's pair."""
    found: dict[str, object] = {}
    for one, when in zip(clampings(run, a), ("standing", "turning"), strict=False):
        found |= {f"pair_preload_{when}": one.preload, f"pair_interference_{when}": one.interference}
    return found


def clamping_warnings(run: Finished, seats: Sequence[Attachment]) -> Iterator[str]:
    """A warning of a pair whose clamping alone dents its races."""
    for a in seats:
        found, bearing = clampings(run, a), rated(run, a)
        if not found or not isinstance(bearing, Rated):
            continue
        hardest = max(found, key=lambda one: one.ball)
        limit = bearing.bearing.pressure_limit
        if hardest.ball > (most := bearing.load_at(limit)):
            when = "as mounted" if hardest is found[0] else "at the rotor's speed"
            yield (
                f"{a.bearing}: its rows are clamped by {hardest.preload:.3g} N {when}, which presses each "
                f"ball by {hardest.ball:.3g} N; {most:.3g} N, {1e-9 * limit:g} GPa, dents a race. Check "
                f"{a.bearing}.preload or .interference"
            )
