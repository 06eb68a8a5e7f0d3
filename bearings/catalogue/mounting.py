"""The meaning of a designation: contact angle, ceramic balls, pairs, as in `71907 AC/HC DB`.

    C, AC        contact angle of 15 or 25 degrees, of the sizes of angular contact; C where none is said.
                 SKF writes CD and ACD, where D is the inner design
    HC, HC5      hybrid: balls of silicon nitride
    DB, DF, DT   a pair back to back, face to face or in tandem: both bearings as one set of two rows

Makers write the same in many ways; these are common to several. A pair's rows are a bearing's width apart,
and its preload, but for tandem, is the light one of `LIGHT_PRELOAD`, a round number from makers' catalogues
(from memory; they go from 0.3 to 0.7 %). Ratings are those of a row.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace

from ..angular.angular_row import ARRANGEMENTS, BACK_TO_BACK, CLAMPED, FACE_TO_FACE, TANDEM
from ..contact.materials import SILICON_NITRIDE
from .entry import Bearing

ANGLES = {word: math.radians(15.0) for word in ("C", "CD")}
ANGLES |= {word: math.radians(25.0) for word in ("AC", "ACD")}
CERAMIC = ("HC", "HC5")
PAIRS = {"DB": BACK_TO_BACK, "DF": FACE_TO_FACE, "DT": TANDEM}
LIGHT_PRELOAD = 0.005  # of a row's dynamic rating


def mounted_bearing(name: str, known: Callable[[str, float | None], Bearing | None]) -> Bearing | None:
    """The bearing `name`, whose beginning is one that is `known`; None where no such bearing exists.

    known(beginning, contact angle): a bearing, where it exists and comes with that angle (rad; None: any).
    """
    words = name.replace("/", " ").split()
    for length in range(len(words), 0, -1):
        begins, suffixes = " ".join(words[:length]), words[length:]
        angles = [ANGLES[word] for word in suffixes if word in ANGLES]
        pairs = [PAIRS[word] for word in suffixes if word in PAIRS]
        ceramic = [word for word in suffixes if word in CERAMIC]
        if len(angles) + len(pairs) + len(ceramic) != len(suffixes) or len(pairs) > 1 or len(ceramic) > 1:
            continue
        found = known(begins, angles[0] if angles else None) if len(angles) < 2 else None
        if found is None:
            continue
        if ceramic:
            found = found.with_balls(SILICON_NITRIDE)
        if pairs and (found.contact_angle == 0.0 or found.balls.rows != 1):
            return None
        found = paired(found, pairs[0]) if pairs else found
        return replace(found, designation=name)
    return None


def nearest(name: str, known: Callable[[str, float | None], Bearing | None]) -> str | None:
    """What `mounted_bearing` takes of a maker's name such as 7014CDGA/HCP4A; None for an unknown size.

    known: as of `mounted_bearing`. Precision, cage, seals and clearance (C2 to C5) are left out.
    """
    size = re.search(r"\d{4,5}", name)
    if size is None:
        return None
    rest, ceramic = re.subn(r"HC5?", " ", name[: size.start()] + " " + name[size.end() :])
    angle = re.search(r"(A?C)(?![1-5])", rest)
    pair = re.search(r"\bD[BFT]\b", rest)
    said = [found for found in (angle and angle[1], "HC" if ceramic else None, pair and pair[0]) if found]
    for words in (said, [word for word in said if word == "HC"], []):
        if mounted_bearing(called := " ".join((size[0], *words)), known):
            return called
    return None


def paired(one: Bearing, arrangement: int) -> Bearing:
    """Two of a bearing with a row side by side, in an `arrangement`, as one set of two rows."""
    preload = LIGHT_PRELOAD * one.dynamic_rating if arrangement in CLAMPED else 0.0
    origins = {
        "rows": "a pair",
        "width": f"two of {one.width:g} m",
        "row_distance": "width of one",
        "preload": f"{100.0 * LIGHT_PRELOAD:g} % of a row's dynamic rating"
        if preload
        else "none in tandem",
    }
    of_both = ("ring_mass", "ring_inertia", "outer_ring_mass", "cage_mass", "damping")
    origins |= {name: f"two of: {one.origins[name]}" for name in of_both}
    return replace(
        one,
        designation=f"{one.designation}, {ARRANGEMENTS.words[arrangement]}",
        width=2.0 * one.width,
        balls=replace(one.balls, rows=2, play=0.0),
        ring=replace(one.ring, mass=2.0 * one.ring.mass, inertia=2.0 * one.ring.inertia),
        outer_ring=2.0 * one.outer_ring,
        cage=2.0 * one.cage,
        damping=2.0 * one.damping,
        arrangement=arrangement,
        row_distance=one.width,
        preload=preload,
        origins={**one.origins, **origins},
    )
