"""Balls as bodies in space: in the plane, in balance of momentum, at speed against Jones, and in a drop."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import root

import touchdown
from tests.support import in_space
from touchdown.bearings import angular_cageless, seat
from touchdown.bearings.angular.bodies import cage
from touchdown.bearings.angular.bodies.layout import (
    FIRST_BALL,
    RTX,
    RTY,
    RVZ,
    RWX,
    RWY,
    RZ,
    VX,
    VY,
    VZ,
    WX,
    WY,
    WZ,
    X,
    Y,
    Z,
)
from touchdown.bearings.angular.bodies.ring import axes_of
from touchdown.bearings.angular.row import SINGLE_REVERSED, TANDEM_REVERSED
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.micro_step import MICRO_STEP
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.modelkit.instance import Instance

MODELS = ("angular_cageless", "angular_caged")
PLANAR_LOADS = [*(("journal", name) for name in ("fx", "fy", "mz")), ("housing", "fx"), ("housing", "fy")]


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("seed", range(2))
def test_in_the_plane_forces_are_those_of_the_detailed_bearing(name: str, seed: int) -> None:
    plane, space, pairs = in_space.in_both(name, seed)
    dq, ds = (
        in_space.instant(plane, plane.record["q"].copy()),
        in_space.instant(space, space.record["q"].copy()),
    )
    loads = [[float(one.record["o"][body][load]) for body, load in PLANAR_LOADS] for one in (plane, space)]
    assert abs(loads[0][1]) > 10.0
    assert int(np.sum(plane.record["s"]["inner"]["normal"] > 0.0)) > 1
    assert name == "angular_cageless" or space.record["s"]["side"]["touching"][0] > 0
    assert loads[1] == pytest.approx(loads[0], rel=1e-9, abs=1e-9 * abs(loads[0][1]))
    scale = float(np.max(np.abs([dq[k] for _, k in pairs])))
    mine, theirs = np.array([(ds[to], dq[k]) for to, k in pairs]).T
    assert mine == pytest.approx(theirs, rel=1e-9, abs=1e-9 * scale)
    for k in (ring.RVX, ring.RVY, ring.RW):
        assert ds[k] == pytest.approx(dq[k], rel=1e-9, abs=1e-9 * abs(dq[ring.RVY]))


@pytest.mark.parametrize("name", MODELS)
def test_in_the_plane_peaks_of_a_fall_are_those_of_the_detailed_bearing(name: str) -> None:
    """From first touch on; before it balls rattle, and rounding grows."""
    found, parts = [], ["contact", "balls", "inner", "outer"]
    parts += ["pockets"] if name == "angular_caged" else []
    for bearing in (in_space.landed(in_space.PLANE[name]), in_space.landed(name)):
        bearing.step(0.0, 1.5e-3)
        found.append([float(bearing.record["o"][k]["peak_force"]) for k in parts])
    assert found[0][0] > 200.0
    assert min(found[0]) > 5.0
    assert found[1] == pytest.approx(found[0], rel=1e-6)


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("seed", range(2))
def test_momentum_and_its_moment_close_in_space(name: str, seed: int) -> None:
    """Of what balls, ring and cages gain, and what journal and housing get, nothing is left.

    About the housing's middle that goes for the journal and all inside, but for what the outer races do,
    which is summed up here from what is known of their contacts.
    """
    bearing, q = in_space.shaken(name, seed)
    dq = in_space.instant(bearing, q)
    r, n = bearing.record, in_space.balls_of(bearing)
    o, mass, inertia = r["o"], float(r["d"]["mass"]), float(r["d"]["inertia"])
    assert float(r["s"]["shoulder"]["normal"]) > 10.0
    assert float(r["s"]["ring"]["normal"]) > 10.0
    on_journal = np.array([o["journal"][k] for k in ("fx", "fy", "fz")])
    on_housing = np.array([o["housing"][k] for k in ("fx", "fy", "fz")])
    speeding, turning = in_space.of_balls(dq, VX, n), in_space.of_balls(dq, WX, n)
    of_ring = float(r["p"]["ring"]["mass"]) * dq[[ring.RVX, ring.RVY, RVZ]]
    of_cages, of_cages_moment = _of_cages(bearing, q, dq) if name == "angular_caged" else (0.0, 0.0)
    total = on_journal + on_housing + of_ring + mass * speeding.sum(axis=1) + of_cages
    assert total == pytest.approx(np.zeros(3), abs=1e-9 * float(np.max(np.abs(mass * speeding))))
    places = in_space.of_balls(q, X, n)
    moment = (mass * np.cross(places.T, speeding.T) + inertia * turning.T).sum(axis=0)
    rx, ry = (float(r["u"]["journal"][k]) for k in ("rx", "ry"))
    mx, my, about = (float(o["journal"][k]) for k in ("mx", "my", "mz"))
    at = np.array([float(r["u"]["journal"][k]) for k in "xyz"])
    along = math.sqrt(1.0 - rx**2 - ry**2)  # of its axis; mx, my and about do work on tilts and spin
    whole = np.array([along * mx, along * my, about / along - ry * mx + rx * my])
    on_journal_moment = whole + np.cross(at, on_journal)
    total = on_journal_moment + _of_ring(bearing, q, dq) + moment + of_cages_moment
    total -= _outer_moment(bearing, places)
    assert total == pytest.approx(np.zeros(3), abs=1e-9 * float(np.max(np.abs(on_journal_moment))))


def _of_ring(bearing: Instance, q: np.ndarray, dq: np.ndarray) -> np.ndarray:
    """What the ring gains of angular momentum about the middle (N m)."""
    p = bearing.record["p"]["ring"]
    i_p, i_t = float(p["inertia"]), float(p["transverse_inertia"])
    gyro = i_p * q[ring.RW]
    own = [i_t * dq[RWX] + gyro * q[RWY], i_t * dq[RWY] - gyro * q[RWX], i_p * dq[ring.RW]]
    axes = np.array(axes_of(q[RTX], q[RTY])).reshape(3, 3)
    gained = float(p["mass"]) * dq[[ring.RVX, ring.RVY, RVZ]]
    return axes.T @ own + np.cross(q[[ring.RX, ring.RY, RZ]], gained)


def _of_cages(bearing: Instance, q: np.ndarray, dq: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the cages gain of momentum and of its moment about the middle (N, N m), shaken as they are.

    Their own angular momentum is taken a moment before and after, as they turn.
    """
    d, moment = bearing.record["d"]["cage"], 1e-6  # s
    force, turning = np.zeros(3), np.zeros(3)
    for row in range(2):
        assert int(bearing.record["s"]["side"][row]["touching"]) > 1
        i = in_space.cage_of(bearing, row)
        gained = float(d["mass"]) * dq[i + cage.VX : i + cage.VX + 3]
        before, after = (_spin_of(d, (q + way * moment * dq)[i : i + 12]) for way in (-1.0, 1.0))
        force += gained
        turning += np.cross(q[i : i + 3], gained) + (after - before) / (2.0 * moment)
    return force, turning


def _spin_of(d: np.ndarray, q: np.ndarray) -> np.ndarray:
    """A cage's angular momentum about its centre (N m s), in fixed axes."""
    axes = np.array(axes_of(q[cage.RX], q[cage.RY])).reshape(3, 3)
    across = float(d["transverse_inertia"])
    return axes.T @ [across * q[cage.W1], across * q[cage.W2], float(d["inertia"]) * q[cage.SPIN]]


def _outer_moment(bearing: Instance, places: np.ndarray) -> np.ndarray:
    """Moment (N m) of the outer races on the balls about the middle."""
    o, n = bearing.record["s"]["outer"], places.shape[1]
    direction, t, m = (np.array([o[f"{name}{k}"][:n] for k in "xyz"]) for name in "utm")
    force = o["normal"][:n] * direction + o["friction_t"][:n] * t + o["friction_m"][:n] * m
    at = places - float(bearing.record["d"]["ball_radius"]) * direction
    return np.cross(at.T, force.T).sum(axis=0)


def test_a_free_cage_turns_about_its_angular_momentum() -> None:
    """Its axis goes round that at L/I_t, whatever its tilt; pockets are as good as none."""
    soft = {"cage_contact__stiffness": 1e-9, "cage_friction__static": 0.0, "cage_friction__dynamic": 0.0}
    bearing = in_space.derived("angular_caged", **in_space.PAIRS["angular_caged"] | soft)
    q, i, d = bearing.record["q"], in_space.cage_of(bearing, 0), bearing.record["d"]["cage"]
    q[i + cage.RX : i + cage.RY + 1] = 0.05, -0.03
    q[i + cage.W1], q[i + cage.W2], q[i + cage.SPIN] = 8.0, 3.0, 100.0
    in_space.instant(bearing, q.copy())
    axis, whole = _axis_of(q[i : i + 12]), _spin_of(d, q[i : i + 12])
    span = 5e-3
    bearing.step(0.0, span)
    turned = float(np.linalg.norm(whole)) / float(d["transverse_inertia"]) * span
    assert turned > 0.9
    k = whole / np.linalg.norm(whole)
    expected = axis * np.cos(turned) + np.cross(k, axis) * np.sin(turned)
    expected += k * np.dot(k, axis) * (1.0 - np.cos(turned))
    assert float(np.linalg.norm(expected - axis)) > 0.02
    assert _axis_of(q[i : i + 12]) == pytest.approx(expected, abs=1e-7)
    assert _spin_of(d, q[i : i + 12]) == pytest.approx(whole, abs=1e-7 * float(np.linalg.norm(whole)))


def _axis_of(q: np.ndarray) -> np.ndarray:
    """A cage's axis."""
    return np.array(axes_of(q[cage.RX], q[cage.RY])[6:])


def test_each_row_of_a_pair_has_half_of_the_cages() -> None:
    """They start among their balls, of which none is pressed into its pocket."""
    bearing = in_space.derived(
        "angular_caged", **in_space.PAIRS["angular_caged"] | {"cage__clearance": 0.0}
    )
    d, o = bearing.record["d"], bearing.record["o"]
    assert float(d["cage"]["mass"]) == pytest.approx(1.1e-3)
    assert float(d["cage"]["inertia"]) == pytest.approx(1.1e-3 * 14.25e-3**2)
    at = [float(o[part]["z"]) for part in ("cage", "second_cage")]
    assert at == pytest.approx([float(d["z"][0]), float(d["z"][15])])
    assert at[0] < -4e-3 < 4e-3 < at[1]
    assert float(o["pockets"]["indentation"]) < 1e-12


def test_spinning_balls_lose_nothing_where_macro_steps_begin() -> None:
    """Damping is not taken in by that a ball's velocity turns: a pair rolls on as in one macro step."""
    heats = []
    for parts in (1, 200):
        bearing, speed = in_space.derived("angular_cageless", **in_space.PAIRS["angular_cageless"]), 900.0
        q, n = bearing.record["q"], in_space.balls_of(bearing)
        (x, y, z), angle = in_space.of_balls(q, X, n).copy(), math.radians(25.0)
        orbit = 0.5 * (1.0 - 4.8 / 28.5 * math.cos(angle)) * speed
        roll, radius = -orbit * 28.5 / 4.8, np.hypot(x, y)
        across = roll * math.sin(angle) * np.sign(z) / radius
        in_space.of_balls(q, VX, n)[:] = -orbit * y, orbit * x, 0.0 * z
        in_space.of_balls(q, WX, n)[:] = across * x, across * y, roll * math.cos(angle) + 0.0 * z
        q[ring.RW] = speed
        refill(bearing)
        bearing.step(0.0, 1e-3)  # it rolls smoothly
        before = float(bearing.record["o"]["energy"]["dissipated"])
        for k in range(parts):
            bearing.step(1e-3 + 1e-2 / parts * k, 1e-2 / parts)
        heats.append(float(bearing.record["o"]["energy"]["dissipated"]) - before)
    assert heats[0] > 1e-6
    assert heats[1] == pytest.approx(heats[0], rel=1e-4)


@dataclass(frozen=True)
class Turning:
    """A row that turns under a thrust; angles expected at inner and outer race (deg), with the moment."""

    count: int
    diameter: float  # m
    pitch: float  # m
    conformities: tuple[float, float]
    contact_angle: float  # deg
    ball: tuple[float, float, float]  # Pa, 1, kg/m3
    rings: tuple[float, float]
    thrust: float  # N
    rpm: float
    damping: float  # N s/m2, of the races, by which vibrations of the start die out
    inner: float
    outer: float

    @property
    def speed(self) -> float:
        """Of the inner ring (rad/s)."""
        return self.rpm * math.pi / 30.0


STEEL, CERAMIC = (207e9, 0.3), (310e9, 0.26, 3200.0)
ROWS = {
    "218": Turning(
        *(16, 22.23e-3, 125.26e-3, (1.0464, 1.0464), 40.0, (205.9e9, 0.3, 7800.0), (205.9e9, 0.3)),
        *(17800.0, 10000.0, 3e7, 48.17, 33.78),
    ),
    "7014": Turning(
        *(20, 12e-3, 90e-3, (1.04, 1.06), 15.0, CERAMIC, STEEL, 1000.0, 18000.0, 3e7, 22.145, 12.137)
    ),
    "71904": Turning(
        *(17, 4.8e-3, 28.5e-3, (1.04, 1.06), 25.0, CERAMIC, STEEL, 100.0, 36000.0, 1e7, 33.62, 18.79)
    ),
}


def turned(row: Turning, pitch: float | None = None) -> Instance:
    """The row with an inner ring too heavy to be moved, at its speed, balls about where they will roll.

    pitch: of their spins' axis out of the shaft's at the start (rad); by default the inner contact angle.
    """
    bearing = in_space.derived(
        "angular_cageless",
        balls__count=row.count,
        balls__diameter=row.diameter,
        balls__pitch_diameter=row.pitch,
        balls__conformity=row.conformities[0],
        balls__outer_conformity=row.conformities[1],
        balls__contact_angle=math.radians(row.contact_angle),
        balls__modulus=row.ball[0],
        balls__poisson=row.ball[1],
        balls__density=row.ball[2],
        balls__damping=row.damping,
        ring__modulus=row.rings[0],
        ring__poisson=row.rings[1],
        ring__mass=1e13,
        ring__inertia=1e13,
        journal_radius=0.3 * row.pitch,
        clearance=1e-3,
    )
    q, n = bearing.record["q"], row.count
    angle, speed = balance(row, bearing, 0.0, 0.0).inner, row.speed  # about which the balls are to roll
    orbit = 0.5 * (1.0 - row.diameter * math.cos(angle) / row.pitch) * speed
    roll = -orbit * row.pitch / row.diameter
    jones = balance(
        row, bearing, orbit, float(bearing.record["d"]["inertia"]) * orbit * abs(roll) * math.sin(angle)
    )
    q[RZ], q[ring.RW] = jones.z, speed
    around = np.arctan2(q[FIRST_BALL + n : FIRST_BALL + 2 * n], q[FIRST_BALL : FIRST_BALL + n])
    groove = bearing.record["d"]["outer_groove"]
    radius, along = groove["circle"][0] + jones.ball[0], groove["along"][0] + jones.ball[1]
    zero, one, tilt = np.zeros(n), np.ones(n), angle if pitch is None else pitch
    for k, value in (
        (X, radius * np.cos(around)),
        (Y, radius * np.sin(around)),
        (Z, along * one),
        (VX, -orbit * radius * np.sin(around)),
        (VY, orbit * radius * np.cos(around)),
        (VZ, zero),
        (WX, -roll * math.sin(tilt) * np.cos(around)),
        (WY, -roll * math.sin(tilt) * np.sin(around)),
        (WZ, roll * math.cos(tilt) * one),
    ):
        q[FIRST_BALL + k * n : FIRST_BALL + (k + 1) * n] = value
    refill(bearing)
    return bearing


def refill(bearing: Instance) -> None:
    """Have contacts hold the energy of where they were put: they give back no more than they took."""
    in_space.instant(bearing, bearing.record["q"].copy())
    angular_cageless.fill_accounts(bearing.record)


@dataclass(frozen=True)
class Jones:
    """A row in balance under its thrust, all balls alike."""

    z: float  # m, of the inner ring
    inner: float  # rad
    outer: float
    ball: tuple[float, float]  # m, of its centre from that of the outer arc, outwards and along


def balance(row: Turning, bearing: Instance, orbit: float, moment: float) -> Jones:
    """Jones' balance of balls that orbit (rad/s) under a gyroscopic `moment` (N m), held as loads share it.

    Harris, Rolling Bearing Analysis, with both races' friction square to the contact lines. Unknown are the
    ball's centre in the plane through the shaft, and the ring's place along it.
    """
    d = bearing.record["d"]
    k_i, k_o = float(d["stiffness"]["inner"]), float(d["stiffness"]["outer"])
    r_i, r_o = ((c / 2.0 - 0.5) * row.diameter for c in row.conformities)
    across, free = (r_i + r_o) * math.cos(math.radians(row.contact_angle)), math.radians(row.contact_angle)
    whole = 0.5 * float(d["mass"]) * row.pitch * orbit**2, moment
    throw = 0.0
    unit = r_i + r_o

    def forces(u: np.ndarray) -> tuple[float, float, float, float]:
        x_1, x_2, z = u * unit
        at_i = z + unit * math.sin(free) - x_1, across - x_2
        q_o = k_o * max(math.hypot(x_1, x_2) - r_o, 0.0) ** 1.5
        q_i = k_i * max(math.hypot(*at_i) - r_i, 0.0) ** 1.5
        return q_i, math.atan2(*at_i), q_o, math.atan2(x_1, x_2)

    def off(u: np.ndarray) -> list[float]:
        q_i, a_i, q_o, a_o = forces(u)
        f_i, f_o = (2.0 * moment / row.diameter * q / (q_i + q_o) for q in (q_i, q_o))
        along = q_i * math.sin(a_i) - q_o * math.sin(a_o) + f_i * math.cos(a_i) - f_o * math.cos(a_o)
        out = q_i * math.cos(a_i) - q_o * math.cos(a_o) - f_i * math.sin(a_i) + f_o * math.sin(a_o) + throw
        thrust = row.count * (q_i * math.sin(a_i) + f_i * math.cos(a_i)) - row.thrust
        return [along / row.thrust, out / row.thrust, thrust / row.thrust]

    reach = (r_o + 1e-3 * unit) / unit
    start = np.array([reach * math.sin(free), reach * math.cos(free), 2e-3])
    found = root(off, start)
    for share in (0.25, 0.5, 0.75, 1.0):  # of what the speed does
        throw, moment = share * whole[0], share * whole[1]
        found = root(off, start, tol=1e-13, method="lm")
        start = found.x
    assert np.max(np.abs(found.fun)) < 1e-9
    _, a_i, _, a_o = forces(found.x)
    x_1, x_2, z = found.x * unit
    return Jones(z, a_i, a_o, (x_2, x_1))


def run_in(bearing: Instance, begin: float, span: float) -> None:
    """Turn for a `span` (s), in macro steps of 1 ms."""
    for k in range(round(span / 1e-3)):
        bearing.step(begin + 1e-3 * k, 1e-3)


def at_speed(row: Turning, pitch: float | None = None) -> tuple[float, float]:
    """Contact angles inside and outside (deg) that a `turned` row settles to, which are those of Jones.

    The ring is held where Jones has it under the thrust, with the orbit and the spin that the balls take.
    """
    bearing = turned(row, pitch)
    run_in(bearing, 0.0, 0.01)
    jones = None
    for k in range(2):
        jones = balance(row, bearing, *turning_of(bearing, row))
        bearing.record["q"][RZ] = jones.z
        refill(bearing)
        run_in(bearing, 0.1 * (k + 1), 0.02)
    assert jones is not None
    orbit, _ = turning_of(bearing, row)
    assert 0.4 < orbit / row.speed < 0.5  # they roll
    along = bearing.record["o"]["along"]
    inner, outer = (math.degrees(float(along[key])) for key in ("contact_angle", "outer_angle"))
    assert inner == pytest.approx(math.degrees(jones.inner), abs=0.05)
    assert outer == pytest.approx(math.degrees(jones.outer), abs=0.05)
    return inner, outer


@pytest.mark.parametrize("name", list(ROWS))
def test_contact_angles_at_speed_are_those_of_jones_with_the_gyroscopic_moment(name: str) -> None:
    """Which the motion brings about by itself; without that moment they are off by 0.6 to 1.2 degrees."""
    row = ROWS[name]
    assert at_speed(row) == pytest.approx((row.inner, row.outer), abs=0.05)


def test_contact_angles_at_speed_depend_on_how_balls_rolled_at_the_start() -> None:
    """By 1.3 deg in the 218: nothing brakes their spin out of the plane, and races hold any of it."""
    starts = {80.0: (47.68, 34.34), -30.0: (49.00, 32.82)}  # deg: inner, outer
    for pitch, angles in starts.items():
        assert at_speed(ROWS["218"], math.radians(pitch)) == pytest.approx(angles, abs=0.05)


def turning_of(bearing: Instance, row: Turning) -> tuple[float, float]:
    """(Orbit (rad/s), gyroscopic moment (N m)) of a ball, the mean of all."""
    places, speeds, spins = (in_space.of_balls(bearing.record["q"], k, row.count) for k in (X, VX, WX))
    distance = np.hypot(places[0], places[1])
    orbit = float(np.mean((places[0] * speeds[1] - places[1] * speeds[0]) / distance**2))
    outwards = float(np.mean((spins[0] * places[0] + spins[1] * places[1]) / distance))
    return orbit, float(bearing.record["d"]["inertia"]) * orbit * abs(outwards)


@pytest.mark.parametrize(("name", "fall"), list(zip(MODELS * 2, in_space.FALLS, strict=True)))
def test_peaks_of_a_fall_are_those_of_a_sixteenth_of_the_step(name: str, fall: str) -> None:
    """But for that in the bore with cages, after a landing along the shaft that shook them.

    There starts that differ by a microradian differ by half of a per cent, at any step.
    """
    case = in_space.FALLS[fall]
    coarse, fine = (
        in_space.peaks(in_space.fallen(name, case, MICRO_STEP / part)[0]) for part in (1.0, 16.0)
    )
    if case.along != 0.0:
        assert fine[0] > 400.0
    if case.down > 0.0:
        assert fine[1] > 300.0
    if name == "angular_caged" and case.along != 0.0:
        assert coarse[1] == pytest.approx(fine[1], rel=2e-2)
        coarse[1] = fine[1]
    assert coarse == pytest.approx(fine, rel=3e-3)


ARRANGED: dict[str, dict[str, float]] = {  # back to back by a preload is the pair of all other falls
    "face to face": {"arrangement": 2},
    "in tandem": {"arrangement": TANDEM_REVERSED, "preload": 0.0},  # the rotor falls towards -z
    "single": {"arrangement": SINGLE_REVERSED, "balls__rows": 1, "preload": 0.0},
    "by an interference": {"preload": 0.0, "interference": 2e-6},
}


def energy_made(bearing: Instance, before: float) -> tuple[float, float]:
    """Energy beyond `before`, with heat and what went to rotor and housing; its heat (J)."""
    o, q = bearing.record["o"], bearing.record["q"]
    inside = sum(float(o["energy"][part]) for part in ("kinetic", "potential", "dissipated"))
    return inside - before + float(q[seat.JE] + q[seat.HE]), float(o["energy"]["dissipated"])


@pytest.mark.parametrize(("name", "fall"), list(zip(MODELS[::-1] * 2, in_space.FALLS, strict=True)))
def test_energy_of_a_fall_closes(name: str, fall: str) -> None:
    """What is inside has, its heat, and what went to rotor and housing."""
    bearing, before = in_space.fallen(name, in_space.FALLS[fall], MICRO_STEP)
    made, heat = energy_made(bearing, before)
    q = bearing.record["q"]
    turnover = heat + abs(float(q[seat.JE])) + abs(float(q[seat.HE]))
    assert heat > 0.01
    assert name == "angular_cageless" or float(bearing.record["o"]["pockets"]["peak_force"]) > 1.0
    assert made == pytest.approx(0.0, abs=1e-5 * turnover)


@pytest.mark.parametrize(("name", "rows"), list(zip(MODELS[::-1] * 2, ARRANGED, strict=True)))
def test_energy_closes_however_rows_stand(name: str, rows: str) -> None:
    """To 1.5e-5 of the heat, face to face with cages; at half the step to a quarter of that."""
    bearing, before = in_space.fallen(
        name, in_space.FALLS["upright, off centre"], MICRO_STEP, **ARRANGED[rows]
    )
    made, heat = energy_made(bearing, before)
    assert float(bearing.record["o"]["shoulder"]["peak_force"]) > 100.0
    assert heat > 0.01
    assert made == pytest.approx(0.0, abs=3e-5 * heat)


BRIEF = [*((name, seed) for name in MODELS for seed in (3,)), ("angular_caged", 4)]  # the last: one row


@pytest.mark.parametrize(("name", "seed"), BRIEF)
def test_a_tilted_rotor_under_thrust_makes_no_energy(name: str, seed: int) -> None:
    """Over 0.1 s, of turnover and heat."""
    found = in_space.balance_of(in_space.undamped(name, seed, 0.1))
    assert found.face > 100.0
    assert found.tilt > 5e-4
    assert found.error < 5e-5


TOPPLES = ("angular_caged", 5)  # a rotor that a bearing without a land does not keep upright for 2 s
LONG = [(name, seed) for name in MODELS for seed in range(10) if (name, seed) != TOPPLES]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "seed"), LONG)
def test_tilted_rotors_under_thrust_make_no_energy_for_long(name: str, seed: int) -> None:
    """Over 2 s, of turnover and heat."""
    found = in_space.balance_of(in_space.undamped(name, seed, 2.0))
    assert found.face > 100.0
    assert found.tilt > 1e-3
    assert found.error < 1e-4


def test_a_cage_that_no_body_can_be_is_refused() -> None:
    """Half of the moment about the axis is a flat ring's."""
    scene = touchdown.load("disk-upright-caged").set({"bearing.cage.inertia": 1e-6})
    with opened(scene.set({"bearing.cage.transverse_inertia": 5e-7}), in_process=True) as system:
        system.initialise()
    slender = scene.set({"bearing.cage.transverse_inertia": 4.9e-7})
    message = r"cage.transverse_inertia = 4.9e-07 kg.m2 is below 5e-07 kg.m2, half of that about the axis"
    with pytest.raises(TouchdownError, match=message), opened(slender, in_process=True) as system:
        system.initialise()
