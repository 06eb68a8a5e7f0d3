"""The simplified bearing in space: loads of its balls, the plane it comes from, axial landings."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import touchdown
from tests.support.bearing_states import instance_of
from tests.support.in_space import PAIRS, put
from touchdown.bearings import seat
from touchdown.bearings.angular import inner_ring
from touchdown.bearings.angular.angular_row import ARRANGEMENTS
from touchdown.bearings.angular.pair_statics import MountedRows, balls_on
from touchdown.bearings.contact.materials import SILICON_NITRIDE
from touchdown.bearings.rolling import ring
from touchdown.bearings.rolling.ball_set import BallSet
from touchdown.master.common.errors import Ended, TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.modelkit.instance import Instance

BALLS = BallSet(
    count=17,
    diameter=4.8e-3,
    pitch_diameter=28.5e-3,
    outer_conformity=1.06,
    play=0.0,
    material=SILICON_NITRIDE,
)
PAIR = MountedRows(BALLS, math.radians(25.0), arrangement=1, distance=9e-3, preload=100.0)
PAIRED = touchdown.load("disk-caged-simplified").swap(bearing="angular_simplified")
SETTINGS: dict[str, object] = {  # a hybrid pair of the size 71904 on an upright shaft, without its magnets
    "bearing.balls.contact_angle": "25 deg",
    "bearing.arrangement": "back to back",
    "bearing.row_distance": "9 mm",
    "bearing.preload": 100.0,
    "bearing.balls.rows": 2,
    "bearing.balls.play": 0.0,
    "bearing.balls.count": BALLS.count,
    "bearing.balls.diameter": BALLS.diameter,
    "bearing.balls.pitch_diameter": BALLS.pitch_diameter,
    "bearing.balls.outer_conformity": BALLS.outer_conformity,
    "bearing.balls.material": "Si3N4",
    "bearing.balls.hertz": "exact",
    "bearing.balls.damping_ratio": 0.05,
    "bearing.ring.mass": 0.019,
    "bearing.shoulder.gap_minus": "0.15 mm",
    "bearing.shoulder.stiffness": 5e8,
    "bearing.shoulder.dissipation": 5.0,
    "bearing.balls.expected_indentation": 3e-6,
    "bearing.shoulder.radius": "11.2 mm",
    "inclination": "90 deg",
    "rotor.axial": 1,
    "run.macro_step": "50 us",
}


def paired() -> Instance:
    """A bearing with the balls of `PAIR`, still unstarted."""
    instance = instance_of("angular_simplified")
    p = instance.record["p"]
    for name in ("count", "diameter", "pitch_diameter", "outer_conformity", "play", "material"):
        p["balls"][name] = getattr(BALLS, name)
    p["balls"]["contact_angle"], p["balls"]["rows"] = PAIR.contact_angle, 2
    p["arrangement"], p["row_distance"], p["preload"] = PAIR.arrangement, PAIR.distance, PAIR.preload
    p["rolling"]["f1"] = 0.0
    return instance


def rates(instance: Instance, q: np.ndarray) -> np.ndarray:
    """Derivative of the state, all as it stands."""
    dq = np.zeros(len(q))
    instance.model.instant(0.0, q, dq, instance.words)  # type: ignore[misc]
    return dq


def test_balls_load_the_ring_as_at_rest() -> None:
    """At ten poses of the ring, with that of its cage: the sums of `balls_on`, which take no damping."""
    instance, draw = paired(), np.random.default_rng(3)
    instance.start(0.0)
    m = instance.record
    p, n = m["p"], int(m["n"])
    mass, weight = float(p["ring"]["mass"]), float(p["ring"]["mass"]) * float(p["gravity"])
    transverse, along = (float(m["d"]["space"][key]) for key in ("transverse_inertia", "mass_along"))
    for _ in range(10):
        q = m["q"][:n].copy()
        pose = draw.uniform(-1.0, 1.0, 5) * (3e-6, 3e-6, 3e-6, 1e-4, 1e-4)
        q[ring.RX], q[ring.RY] = pose[:2]
        q[inner_ring.Z], q[inner_ring.RX], q[inner_ring.RY] = pose[2:]
        q[ring.RANGLE] = draw.uniform(0.0, 6.0)
        dq = rates(instance, q)
        turned = float(m["d"]["cage_ratio"]) * q[ring.RANGLE] + float(p["balls"]["first_angle"])
        load, _ = balls_on(PAIR.rows(), PAIR.angles() + turned, pose)
        found = np.array([mass * dq[ring.RVX], mass * dq[ring.RVY] + weight, along * dq[inner_ring.VZ]])
        assert found == pytest.approx(-load[:3], rel=1e-9, abs=1e-9 * 100.0)
        tilting = transverse * dq[[inner_ring.WX, inner_ring.WY]]
        assert tilting == pytest.approx(-load[3:], rel=1e-9, abs=1e-9)


def test_without_a_contact_angle_it_is_the_one_of_the_plane() -> None:
    """At ten states with balls pressed, faces far away: rates of the ring to 1e-9 of the largest."""
    flat, spatial = instance_of("simplified_caged"), instance_of("angular_simplified")
    spatial.record["p"]["shoulder"]["gap_minus"] = 1.0
    draw = np.random.default_rng(5)
    for instance in (flat, spatial):
        instance.start(0.0)
    sizes = [int(instance.record["n"]) for instance in (flat, spatial)]
    common = slice(seat.INSIDE, ring.NEXT)
    for _ in range(10):
        moved = draw.uniform(-1.0, 1.0, 6) * (2e-5, 2e-5, 0.1, 0.1, 3.0, 100.0)
        found = []
        for instance, size in zip((flat, spatial), sizes, strict=True):
            q = instance.record["q"][:size].copy()
            q[common] += moved
            found.append(rates(instance, q)[common])
        assert np.abs(found[0]).max() > 1e3
        assert found[1] == pytest.approx(found[0], rel=1e-9, abs=1e-9 * np.abs(found[0]).max())


class Landing(NamedTuple):
    """A case of an axial landing, and what another program of it found, in z alone and in space."""

    preload: float  # N
    gap: float  # m
    thrust: float  # N, on a lying shaft; 0: the shaft stands upright
    arrangement: str
    alone: tuple[float, float]  # N, largest on the face and on a ball
    in_space: tuple[float, float]

    @property
    def gravity(self) -> float:
        return 0.0 if self.thrust else 9.81

    @property
    def span(self) -> float:
        """Until the rotor is on its way back (s)."""
        pulled = self.gravity + self.thrust / 1.65
        return math.sqrt(2.0 * self.gap / pulled) + 1.5e-3

    def settings(self) -> dict[str, object]:
        return {
            **SETTINGS,
            "inclination": 0.0 if self.thrust else 0.5 * math.pi,
            "bearing.preload": self.preload,
            "bearing.arrangement": self.arrangement,
            "bearing.shoulder.gap_minus": self.gap,
            "rotor.axial_load": -self.thrust,
            "amb.shutdown_time": 1.0 if self.thrust else 0.0,
            "run.duration": self.span,
        }


LANDINGS = (
    Landing(0.0, 0.15e-3, 0.0, "back to back", (488.7, 64.15), (490.0, 64.3)),
    Landing(200.0, 0.15e-3, 0.0, "back to back", (592.1, 77.09), (593.0, 77.1)),
    Landing(100.0, 0.15e-3, 0.0, "face to face", (521.1, 68.22), (522.0, 68.2)),
    Landing(100.0, 0.15e-3, 200.0, "back to back", (2398.1, 285.71), (2404.0, 285.9)),
)


def in_one(case: Landing, sagged: bool) -> tuple[float, float, float]:
    """Peaks (N) of the face, and of the most loaded ball without and with damping, by motion along z.

    sagged: whether the housing starts where its weight holds it.
    """
    mass, stiffness, damping, gravity = 1.65, 2.5e8, 2500.0, case.gravity
    scene = PAIRED.set(case.settings())
    with opened(scene, in_process=True) as system:
        bearing, house = system.components["bearing"], system.components["housing"]
        system.initialise()
        space = bearing.instance.record["d"]["space"]  # type: ignore[attr-defined]
        law, inner = float(space["damping"]), float(space["mass_along"])
        pulled = float(space["weight_along"]) / inner
        housing = 1.0 / float(house.read(["seat.inv_m"])[0])
    pair = MountedRows(
        PAIR.balls,
        PAIR.contact_angle,
        arrangement=ARRANGEMENTS.words.index(case.arrangement),
        distance=PAIR.distance,
        preload=case.preload,
    )
    rows, peaks = pair.rows(), [0.0, 0.0, 0.0]

    def balls(z: float, rate: float) -> float:
        total = 0.0
        for row in rows:
            across, along = row.inner - row.outer, row.inner_at - row.outer_at + z
            length = math.hypot(across, along)
            depth = max(length - row.free, 0.0)
            sine, elastic = along / length, row.stiffness * depth**1.5
            force = max(elastic + law * depth * sine * rate, 0.0)
            peaks[1], peaks[2] = max(peaks[1], elastic), max(peaks[2], force)
            total -= 17 * force * sine
        return total

    def motion(_: float, y: np.ndarray) -> list[float]:
        zr, vr, zi, vi, zh, vh = y
        depth, rate = zi - zr - case.gap, vi - vr
        face = max(5e8 * depth * (1.0 + 5.0 * rate), 0.0) if depth > 0.0 else 0.0
        peaks[0] = max(peaks[0], face)
        on_ring = balls(zi - zh, vi - vh)
        return [
            *(vr, (face - case.thrust) / mass - gravity, vi, (on_ring - face) / inner + pulled),
            *(vh, (-on_ring - stiffness * zh - damping * vh) / housing - gravity),
        ]

    low = -housing * gravity / stiffness if sagged else 0.0
    start = [0.0, 0.0, low, 0.0, low, 0.0]
    solve_ivp(motion, (0.0, case.span), start, rtol=1e-8, atol=1e-12, max_step=5e-6)
    return peaks[0], peaks[1], peaks[2]


@pytest.mark.parametrize("case", LANDINGS[1:])
def test_a_landing_along_the_shaft(case: Landing) -> None:
    """Coupled at 50 us against one system, and that against another program of it.

    There the housing starts unsagged, and swings, which moves peaks by up to 1.6 %; here it hangs at rest.
    """
    swinging = in_one(case, sagged=False)[:2]
    assert swinging == pytest.approx(case.alone, rel=3e-3)
    assert swinging == pytest.approx(case.in_space, rel=5e-3)
    alone = in_one(case, sagged=True)
    run = touchdown.run(PAIRED.set(case.settings()), in_process=True)
    found = [
        float(np.asarray(run.data[name])[-1])
        for name in ("bearing.shoulder.peak_force", "bearing.balls.peak_force")
    ]
    assert found == pytest.approx((alone[0], alone[2]), rel=1e-3)
    assert run.summary["energy_residual_of_turnover"] < 1e-5


def with_bodies(case: Landing, **laws: float) -> tuple[float, float]:
    """Peaks (N) of the face and of the most loaded ball, every ball a body, from an unsagged housing."""
    bearing = instance_of("angular_cageless")
    given = PAIRS["angular_cageless"] | {
        "land": 0.0,
        "shoulder__gap_minus": case.gap,
        "preload": case.preload,
        "arrangement": ARRANGEMENTS.words.index(case.arrangement),
        "gravity": case.gravity,
        "inclination": 0.5 * math.pi if case.thrust == 0.0 else 0.0,
    }
    put(bearing, **given | laws)
    journal, housing = bearing.record["u"]["journal"], bearing.record["u"]["housing"]
    journal["omega"], journal["inv_I"], journal["inv_m_z"] = 942.478, 2000.0, 1.0 / 1.65
    journal["az_free"], housing["az_free"] = -case.gravity - case.thrust / 1.65, -case.gravity
    for end in ("", "_z"):
        for name, value in (("inv_m", 1.0), ("k_over_m", 2.5e8), ("c_over_m", 2500.0)):
            housing[f"{name}{end}"] = value / 5.02
    bearing.start(0.0)
    bearing.step(0.0, case.span)
    o = bearing.record["o"]
    return float(o["shoulder"]["peak_force"]), float(o["inner"]["peak_force"])


@pytest.mark.parametrize("case", LANDINGS)
def test_a_landing_beside_balls_as_bodies(case: Landing) -> None:
    """Face within 0.3 %, most loaded ball within 0.1 %, and 0.2 without preload: there balls of the
    unloaded row are free, and friction across the groove, which springs have not, holds those of the
    other one.
    """
    springs, bodies = in_one(case, sagged=False), with_bodies(case)
    assert springs[0] == pytest.approx(bodies[0], rel=6e-3)
    assert springs[2] == pytest.approx(bodies[1], rel=2e-3 if case.preload > 0.0 else 4e-3)
    if case.preload == 0.0:
        smooth = with_bodies(case, race_friction__static=0.0, race_friction__dynamic=0.0)
        assert springs[2] == pytest.approx(smooth[1], rel=1.2e-3)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"bearing.balls.rows": 1}, "arrangement needs two rows with a contact angle; set balls.rows = 2"),
        ({"bearing.arrangement": "single", "bearing.preload": 0.0}, "need an arrangement"),
        ({"bearing.balls.play": 1e-6}, "balls.play = 1e-06 m has no meaning with a contact angle"),
        ({"bearing.interference": 1e-6}, "both say how a pair is clamped"),
        ({"bearing.arrangement": "tandem"}, "preload = 100 N clamps two rows against each other"),
    ],
)
def test_rows_that_do_not_go_together_are_refused(settings: dict[str, object], message: str) -> None:
    scene = PAIRED.set({**SETTINGS, **settings})
    with pytest.raises(TouchdownError, match=message), opened(scene, in_process=True) as system:
        system.initialise()


TURNED = {"single": "single reversed", "tandem": "tandem reversed"}
TURNED |= {other: one for one, other in TURNED.items()}


def upright(model: str, rows: int, arrangement: str, towards: float, **changes: object) -> touchdown.Scene:
    """The disk over a pair, or over a row alone, falling towards +z or -z, just past its landing."""
    faces = {"minus": "0.15 mm", "plus": 0.0} if towards < 0.0 else {"minus": 0.0, "plus": "0.15 mm"}
    scene = touchdown.load("disk-upright-pair").swap(bearing=model)
    return scene.set(
        {
            "inclination": f"{-90.0 * towards:g} deg",
            "bearing.balls.rows": rows,
            "bearing.arrangement": arrangement,
            "bearing.preload": 100.0 if "to" in arrangement else 0.0,
            **{f"bearing.shoulder.gap_{side}": gap for side, gap in faces.items()},
            "run.duration": "9.5 ms",
            **changes,
        }
    )


@pytest.mark.parametrize(
    ("model", "rows", "arrangement", "carried"),
    [("angular_simplified", 1, "single", 1.0), ("angular_caged", 2, "tandem reversed", -1.0)],
)
def test_a_row_comes_off_to_its_open_side_only(
    model: str, rows: int, arrangement: str, carried: float
) -> None:
    """Weight pushes the shaft to either side: a row stops the run, and is warned of, on the open one."""
    for towards in (1.0, -1.0):
        result = touchdown.run(upright(model, rows, arrangement, towards), in_process=True)
        warned = [line for line in result.warnings if "carries a shaft pushed in" in line]
        if towards == carried:
            assert result.ended is Ended.COMPLETED
            assert not warned
            assert result.summary["seats"]["A"]["peak_face_force"] > 300.0
        else:
            assert result.ended is Ended.STOPPED
            assert "presses the inner ring off its row of balls" in result.summary["stopped_because"]
            assert f'set bearing.arrangement = "{TURNED[arrangement]}"' in warned[0]
