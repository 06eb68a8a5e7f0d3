"""Ball loads of an inner ring that bends, beside 2-D finite elements, over 95 sizes of the catalogue.

The reference is no beam: plane stress with the thickness of the section. The displacement, U(r) cos n a
outwards and V(r) sin n a along, is in quadratic elements over the radius, one problem for each harmonic n.
The energy of the ring is

    pi/2 int (E/(1 - nu^2) (e_r^2 + e_a^2 + 2 nu e_r e_a) + G g^2) t r dr
    e_r = U'    e_a = (U + n V)/r    g = V' - (V + n U)/r

The journal presses the bore along a strip, a ball the race along `BALL_PATCH`; their approaches are means
over these. Ball loads then follow from the stiffness of the balls' contacts, as in `ball_loads`. Printed
first: a thin ring under two opposite loads, whose closed forms are pi/4 - 2/pi and 2/pi - 1/2.

    python benchmarks/ring_elements.py
"""

from __future__ import annotations

import math
from typing import NamedTuple, cast

import numpy as np
from scipy.linalg import solveh_banded
from scipy.optimize import brentq
from scipy.special import j1

from touchdown.bearings import catalogue
from touchdown.bearings.catalogue import Bearing
from touchdown.bearings.catalogue.load_sharing import ball_loads, harmonics_for, inner_groove
from touchdown.bearings.contact.materials import elastic_of
from touchdown.bearings.rolling.ball_set import RaceStiffness, set_stiffness
from touchdown.bearings.rolling.bending import Groove
from touchdown.modelkit.variables import as_record

SERIES, CODES = ("618", "619", "60", "62", "63"), range(2, 21)
LOADS = (0.05, 0.2)  # of the static rating
OFFSETS = (0.0, 0.5)  # of the load: on a ball, between two
HARMONICS = 160
BELOW, ABOVE = 24, 8  # elements under the race's bottom, and in the shoulders
BALL_PATCH = 0.5e-3  # m, half of what a ball presses along the race
GAUSS = np.polynomial.legendre.leggauss(3)


class Elastic(NamedTuple):
    """Of a ring."""

    modulus: float  # Pa
    poisson: float


def thickness(groove: Groove, r: np.ndarray) -> np.ndarray:
    """Of the section at radii r (m)."""
    centre = groove.bottom + groove.arc
    chord = 2.0 * np.sqrt(np.maximum(groove.arc**2 - (centre - r) ** 2, 0.0))
    return groove.width - np.where(r > groove.bottom, groove.rows * chord, 0.0)


def compliance(groove: Groove, elastic: Elastic, n: int) -> np.ndarray:
    """Of harmonic `n`: U (m) at bore and race by radial loads of unit generalised force there, (2, 2).

    Rigid motion, of n = 1, is left out: U of the race does not move.
    """
    corners = np.append(
        np.linspace(groove.bore, groove.bottom, BELOW + 1),
        np.linspace(groove.bottom, groove.shoulder, ABOVE + 1)[1:],
    )
    at = np.sort(np.append(corners, 0.5 * (corners[1:] + corners[:-1])))
    stiffness = np.zeros((6, 2 * len(at)))  # upper bands
    e, nu = elastic
    law = e / (1.0 - nu**2) * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]])
    for first in range(0, len(at) - 2, 2):
        a, c = at[first], at[first + 2]
        for x, weight in zip(*GAUSS, strict=True):
            r, half = 0.5 * (a + c) + 0.5 * (c - a) * x, 0.5 * (c - a)
            shape = np.array([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)])
            slope = np.array([x - 0.5, -2.0 * x, x + 0.5]) / half
            strain = np.zeros((3, 6))
            strain[0, 0::2], strain[1, 0::2], strain[1, 1::2] = slope, shape / r, n * shape / r
            strain[2, 0::2], strain[2, 1::2] = -n * shape / r, slope - shape / r
            t = float(thickness(groove, np.array([r]))[0])
            part = math.pi * (2.0 if n == 0 else 1.0) * weight * half * r * t * strain.T @ law @ strain
            for i in range(6):
                for j in range(i, 6):
                    stiffness[5 + i - j, 2 * first + j] += part[i, j]
    bore, race = 0, 2 * (2 * BELOW)
    if n == 0:
        stiffness[5, 1::2] += stiffness[5].max()  # nothing moves along
    if n == 1:
        stiffness[5, race] *= 1e12
    loads = np.zeros((2 * len(at), 2))
    loads[bore, 0] = loads[race, 1] = 1.0
    return np.asarray(solveh_banded(stiffness, loads))[[bore, race]]


def two_loads() -> tuple[float, float]:
    """How a thin ring's diameter shrinks under two opposite loads P, and grows across, in P R^3/(E I)."""
    radius, height, width = 50e-3, 1e-3, 10e-3
    thin = Groove(radius - 0.5 * height, radius, radius + 0.5 * height, width, 1.0, 0)
    elastic = Elastic(207e9, 0.3)
    unit = radius**3 / (elastic.modulus * width * height**3 / 12.0)
    even = {n: 4.0 * float(compliance(thin, elastic, n)[1, 1]) / unit for n in range(0, 200, 2)}
    return sum(even.values()), -sum((-1.0) ** (n // 2) * c for n, c in even.items())


class Ring(NamedTuple):
    """Compliances at bore and race for each harmonic: (harmonics, 2, 2), m/N."""

    groove: Groove
    harmonics: np.ndarray


def ring_of(bearing: Bearing) -> Ring:
    groove = inner_groove(bearing)
    found = elastic_of(as_record(bearing.ring))
    elastic = Elastic(float(found.modulus), float(found.poisson))
    return Ring(groove, np.array([compliance(groove, elastic, n) for n in range(HARMONICS + 1)]))


def by_elements(
    bearing: Bearing, ring: Ring, load: float, offset: float, strip: float = 0.02
) -> np.ndarray:
    """Loads (N) of the balls in a row of a journal that presses with `load` (N); as `ball_loads`.

    strip: half the angle (rad) that the journal presses; ball loads hardly depend on it.
    """
    count = bearing.balls.count
    angles = 2.0 * math.pi / count * (np.arange(count) - offset)
    n = np.arange(HARMONICS + 1)
    patch = np.sinc(n * BALL_PATCH / ring.groove.bottom / math.pi)
    pressed = np.append(1.0, 2.0 * j1(n[1:] * strip) / (n[1:] * strip))
    ahead = np.cos(n * angles[:, None]) @ (ring.harmonics[:, 0, 1] * pressed * patch)
    apart = np.cos(n * (angles[:, None, None] - angles[None, :, None]))
    among = apart @ (ring.harmonics[:, 1, 1] * patch**2)
    stiffness = as_record(RaceStiffness())
    set_stiffness(stiffness, as_record(bearing.balls), elastic_of(as_record(bearing.ring)))
    k, play = float(stiffness["series"]), bearing.balls.play
    row = load / bearing.balls.rows
    along = np.cos(angles)  # across the load there is balance by symmetry

    def sharing(moved: float) -> np.ndarray:
        """Loads where the ring as a whole moves by `moved` (m), by Newton's rule."""
        loads = np.zeros(count)
        depth = np.full(count, -1.0)
        for _ in range(200):
            wanted = moved * along + ahead * row - among @ loads - play
            if np.max(np.abs(wanted - depth)) < 1e-15:
                break
            depth = wanted
            pressed_in = np.maximum(depth, 0.0)
            slope = 1.5 * k * np.sqrt(pressed_in)
            off = k * pressed_in**1.5 - loads
            loads = loads + 0.7 * np.linalg.solve(np.eye(count) + slope[:, None] * among, off)
        return np.maximum(loads, 0.0)

    reach = 4.0 * (load / k) ** (2.0 / 3.0) + play + float(np.abs(ahead).max()) * row
    moved = brentq(
        lambda x: float(sharing(x) @ along) - row, -reach, 4.0 * reach, xtol=1e-13, full_output=False
    )
    return sharing(cast(float, moved))


def main() -> None:
    print("thin ring, two opposite loads: {:.4f} and {:.4f} P R^3/(E I)".format(*two_loads()))
    for name in ("6904", "6004"):
        bearing = catalogue.bearing(name)
        loads = [by_elements(bearing, ring_of(bearing), 350.0, offset).max() for offset in OFFSETS]
        print(f"{name} under 350 N: {loads[0]:.1f} N on a ball, {loads[1]:.1f} N between two")
    off: list[tuple[float, float, str]] = []
    for series in SERIES:
        for code in CODES:
            bearing = catalogue.bearing(f"{series}{code:02d}")
            ring = ring_of(bearing)
            for part in LOADS:
                for offset in OFFSETS:
                    load = part * bearing.static_rating
                    elements = by_elements(bearing, ring, load, offset).max()
                    used, full = (
                        ball_loads(bearing, load, top, offset).max() / elements - 1.0
                        for top in (harmonics_for(bearing.balls.count), 40)
                    )
                    place = "on a ball" if offset == 0.0 else "between two"
                    off.append((used, full, f"{bearing.designation} under {part:g} C0, {place}"))
        print(f"{series}: {len(off)} cases so far", flush=True)
    for at, title in ((0, "harmonics in use"), (1, "all harmonics")):
        sizes = np.abs([case[at] for case in off])
        worst = off[int(np.argmax(sizes))]
        print(
            f"most loaded ball by {title} over elements: median {100 * np.median(sizes):.1f} %, 95 of 100 "
            f"within {100 * np.quantile(sizes, 0.95):.1f} %, at most {100 * worst[at]:+.1f} % ({worst[2]})"
        )


if __name__ == "__main__":
    main()
