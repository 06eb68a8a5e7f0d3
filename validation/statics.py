"""Ball bearings at rest: under radial load, thrust and moments; life and static rating."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..bearings import rating
from ..bearings.angular.angular_row import thrust_angle
from ..bearings.angular.pair_statics import MountedRows, RingBalance, balance, balls_on
from ..bearings.contact.materials import Elastic
from ..bearings.rating import RatedBearing
from ..bearings.rolling.ball_set import BallSet
from .case import Row

STEEL = Elastic(210e9, 0.3)
HELD = {"radial": ("y", "z", "rx", "ry"), "axial": ("x", "y", "rx", "ry"), "both": ("y", "rx"), "none": ()}


def _loaded(play: float, load: Sequence[float], held: str) -> RingBalance:
    """Of seven balls of 11.5 mm on a pitch circle of 43.5 mm, with a radial play (m), under a `load` on the
    inner ring; half the pitch diameter tilts it."""
    balls = BallSet(count=7, diameter=11.5e-3, pitch_diameter=43.5e-3, outer_conformity=1.06, play=play)
    bearing = MountedRows(replace(balls, modulus=STEEL.modulus), 0.0, rings=STEEL)
    rows = [row._replace(lever=0.5 * balls.pitch_diameter) for row in bearing.rows()]
    return balance(rows, bearing.angles(), load, HELD[held])


def _pose(play: float, load: Sequence[float], held: str) -> np.ndarray:
    """Of its inner ring (um, urad), (5,)."""
    return 1e6 * _loaded(play, load, held).pose


def deep_groove_radial() -> list[Row]:
    """Shift of the inner ring under 1000 N across the axis, a ball under the load, all else held; 7 balls
    of 11.5 mm, pitch circle 43.5 mm, conformities 0.52 and 0.53."""
    load = (1e3, 0.0, 0.0, 0.0, 0.0)
    return [
        Row("shift, no play", "um", 15.1101, _pose(0.0, load, "radial")[0]),
        Row("shift, 5 um of play", "um", 21.2230, _pose(5e-6, load, "radial")[0]),
    ]


def deep_groove_axial() -> list[Row]:
    """Shift of the same bearing's inner ring under 1000 N along the axis, all else held."""
    load = (0.0, 0.0, 1e3, 0.0, 0.0)
    return [
        Row("axial shift, no play", "um", 133.5381, _pose(0.0, load, "axial")[2]),
        Row("axial shift with play", "um", 149.1717, _pose(5e-6, load, "axial")[2]),
    ]


def deep_groove_combined() -> list[Row]:
    """1000 N across and 1000 N along, with 5 um of play; a tilt acts at half the pitch diameter, as in
    ISO/TS 16281, not at the radius of the groove's centres."""
    found = _pose(5e-6, (1e3, 0.0, 1e3, 0.0, 0.0), "both")
    return [
        Row("radial shift", "um", 19.5923, found[0]),
        Row("axial shift", "um", 146.4603, found[2]),
        Row("tilt", "urad", 2687.2, found[4], tolerance=3e-4),
    ]


def deep_groove_tilting() -> list[Row]:
    """1 N m on the inner ring, free to shift, no play; half the pitch diameter for the lever."""
    return [Row("tilt", "urad", 3695.7, _pose(0.0, (0.0, 0.0, 0.0, 0.0, 1.0), "both")[4])]


def deep_groove_all() -> list[Row]:
    """1000 N across, 1000 N along, and 1 N m about the line of the load across, with 5 um of play. The
    tests name the moment by its first component only; about the other axis shifts would be 21.4 or 17.6
    um."""
    x, y, z, rx, ry = _pose(5e-6, (1e3, 0.0, 1e3, 1.0, 0.0), "none")
    return [
        Row("radial shift", "um", 19.7144, math.hypot(x, y)),
        Row("axial shift", "um", 146.3084, z),
        Row("tilt", "urad", 2723.9, math.hypot(rx, ry)),
    ]


B218 = MountedRows(
    BallSet(count=16, diameter=22.23e-3, pitch_diameter=125.26e-3, conformity=1.0464, play=0.0),
    math.radians(40.0),
)


def _b218(load: float, stiffness: float | None = None) -> RingBalance:
    """The 218 under a thrust (N); stiffness: of a ball on both races (N/m^1.5), or its own.

    Tilts are about the centre of the circle of the inner groove's centres.
    """
    (row,) = B218.rows()
    row = row._replace(inner_at=0.0, outer_at=row.outer_at - row.inner_at)
    row = row if stiffness is None else row._replace(stiffness=stiffness)
    return balance([row], B218.angles(), (0.0, 0.0, load, 0.0, 0.0))


def thrust_closed_form() -> list[Row]:
    """The general balance in five coordinates against Harris' one equation for the angle, for the 218 under
    44.5 kN."""
    (row,) = B218.rows()
    load = 44.5e3
    angle = thrust_angle(B218.contact_angle, load / (16 * row.stiffness * row.free**1.5))
    found = _b218(load)
    return [
        Row("contact angle", "deg", math.degrees(angle), math.degrees(found.angles[0, 0])),
        Row("load of a ball", "N", load / (16.0 * math.sin(angle)), found.forces[0, 3]),
    ]


def thrust_218() -> list[Row]:
    """Angle, shift and ball load of 16 balls of 22.23 mm under two thrusts, from dimensions and steel."""
    rows = []
    for load, angle, shift, ball in ((17.8e3, 41.498, 36.006, 1679.0), (44.5e3, 42.640, 64.596, 4105.8)):
        found, label = _b218(load), f"at {load / 1e3:g} kN"
        rows += [
            Row(f"contact angle {label}", "deg", angle, math.degrees(found.angles[0, 0])),
            Row(f"axial shift {label}", "um", shift, 1e6 * found.pose[2]),
            Row(f"load of a ball {label}", "N", ball, found.forces[0, 0]),
        ]
    return rows


def stiffness_218() -> list[Row]:
    """Slope of the load at 17.8 kN, with the published 1.473318e10 N/m^1.5 for a ball on both races. A tilt
    is about the centre of the circle of the inner groove's centres; theirs is not told (about the middle of
    the balls, 0.33 mm away, it would be 1.15 % less)."""
    found = _b218(17.8e3, 1.473318e10).stiffness
    return [
        Row("radial stiffness", "N/m", 4.86428e8, found[0, 0]),
        Row("axial stiffness", "N/m", 7.66931e8, found[2, 2]),
        Row("tilt stiffness", "N m/rad", 1.52319e6, found[4, 4]),
    ]


def stribeck() -> list[Row]:
    """Largest load of a ball, times balls over load: deep groove bearings without play under 1000 N."""
    rows = []
    for count in (9, 16):
        balls = BallSet(count=count, diameter=8e-3, pitch_diameter=60e-3, play=0.0)
        bearing = MountedRows(balls, 0.0)
        found = balance(bearing.rows(), bearing.angles(), (1e3, 0.0, 0.0, 0.0, 0.0), HELD["radial"])
        rows.append(Row(f"ball load, {count} balls", "F/Z", 4.37, count * float(found.forces.max()) / 1e3))
    return rows


LIVES = {  # million turns: play (m), load (N, N m), what is held
    "radial": (13163.019, 0.0, (1e3, 0.0, 0.0, 0.0, 0.0), "radial"),
    "radial, play": (10795.7948, 5e-6, (1e3, 0.0, 0.0, 0.0, 0.0), "radial"),
    "axial": (2222.7318, 0.0, (0.0, 0.0, 1e3, 0.0, 0.0), "axial"),
    "axial, play": (3115.8781, 5e-6, (0.0, 0.0, 1e3, 0.0, 0.0), "axial"),
    "both": (1630.5367, 5e-6, (1e3, 0.0, 1e3, 0.0, 0.0), "both"),
    "all loads": (1627.7479, 5e-6, (1e3, 0.0, 1e3, 1.0, 0.0), "none"),
}


def reference_life() -> list[Row]:
    """L10r of the bearing of 7 balls, C = 23.4 kN, under the loads of the cases above. Under a moment
    alone, 1 N m, it is 0.6 % longer than MASTA's 785 145: balls that hardly touch decide."""
    bearing = RatedBearing(
        7, 11.5e-3, 43.5e-3, inner_groove=0.52, outer_groove=0.53, balls=STEEL, rings=STEEL
    )
    rows = []
    for name, (theirs, play, load, held) in LIVES.items():
        ours = 1e-6 * rating.reference_rating_life(bearing, 23400.0, _loaded(play, load, held).forces[0])
        rows.append(Row(f"L10r, {name}", "million turns", theirs, ours))
    return rows


SJOEVALL = {0.1: 0.1156, 0.2: 0.1590, 0.3: 0.1892, 0.4: 0.2117, 0.5: 0.2288, 0.7: 0.2505, 0.9: 0.2576}


def load_zone() -> list[Row]:
    """F/(Z Q_max) of deep groove bearings over the loaded part of the diameter: 0.5 without play, less with
    it."""
    rows = []
    for part, theirs in SJOEVALL.items():
        depth = 10e-6  # m, of the most loaded ball
        shift = depth / (2.0 * part)  # of both races' approach, which the play takes part - 1/2 of
        balls = BallSet(count=120, diameter=8e-3, pitch_diameter=400e-3, play=shift - depth)
        bearing = MountedRows(balls, 0.0)
        (row,) = bearing.rows()
        load, _ = balls_on([row], bearing.angles(), np.array([shift, 0.0, 0.0, 0.0, 0.0]))
        most = row.stiffness * depth**1.5
        rows.append(Row(f"J_r at {part:g}", "", theirs, float(load[0]) / (120 * most)))
    return rows


F_0 = {0.01: 14.9, 0.05: 15.7, 0.10: 16.4, 0.15: 15.2, 0.20: 14.0}


def iso_76() -> list[Row]:
    """C_0/(Z D^2) from 4200 MPa under the most loaded ball by Hertz's whole theory, over D cos(a)/D_pw."""
    return [
        Row(f"f_0 at {g:g}", "MPa", f, rating.static_rating(RatedBearing(10, 10e-3, 10e-3 / g)) / 1e3)
        for g, f in F_0.items()
    ]
