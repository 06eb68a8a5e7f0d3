"""What must hold for every bearing: energy, momentum, frame, sides."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bearing_states import state_in_contact
from systems import CLEARANCE, LANDING, history, rotor_on

from touchdown.bearings import seat
from touchdown.bearings.rolling import ring

ROLLING = ["simplified_caged", "simplified_cageless", "angular_simplified"]
BEARINGS = ["bushing", "landing_sleeve", *ROLLING]
BENT = [(bearing, -1) for bearing in ROLLING]  # with rings that bend
HEATS = [f"bearing.heat.{part}" for part in ("journal", "inner", "balls", "outer")]


def accurate(bearing: str) -> dict[str, object]:
    """Adaptive steps at a tight tolerance."""
    steps = {"micro_step": 0.0} if bearing == "simplified_cageless" else {}
    return {"interface.tolerance": 1e-9, **steps}


def landing(bearing: str, angle: float = 0.0, **rotor: float) -> list[tuple[str, float]]:
    """The rotor at landing speed, without gravity, toward `angle` from straight down."""
    at, way = CLEARANCE - 1e-6, LANDING
    direction = angle - math.pi / 2
    return list(
        {
            "x": at * math.cos(direction), "y": at * math.sin(direction),
            "vx": way * math.cos(direction), "vy": way * math.sin(direction), "gravity": 0.0, **rotor,
        }.items()
    )  # fmt: skip


@pytest.mark.parametrize(("bearing", "harmonics"), [*((name, 0) for name in BEARINGS), *BENT])
def test_no_energy_is_made(bearing: str, harmonics: int) -> None:
    """All energies stated by rotor, bearing and housing add up through an impact."""
    ring_settings = {"ring.harmonics": harmonics} if harmonics else {}
    scene = rotor_on(
        bearing, dict(landing(bearing)), {**accurate(bearing), **ring_settings}, {"gravity": 0.0},
        duration=2e-3, macro_step=2e-5,
    )  # fmt: skip
    names = [
        f"{c}.energy.{k}"
        for c in ("rotor", "bearing", "housing")
        for k in ("kinetic", "potential", "dissipated")
    ]
    sliding = "bearing.contact.sliding_work"
    _, found, _ = history(scene, [*names, *HEATS, sliding, "bearing.contact.peak_force"])
    assert found["bearing.contact.peak_force"][-1] > 200.0
    total = sum(found[name] for name in names)
    lost = found["bearing.energy.dissipated"][-1]
    assert lost > 1e-3
    assert np.all(np.diff(found["bearing.energy.dissipated"]) >= -1e-9)
    gained = np.max(np.abs(total - total[0]))
    assert gained < 1e-6 * lost + 1e-7
    parts = sum(found[part] for part in HEATS)
    assert parts == pytest.approx(found["bearing.energy.dissipated"], rel=1e-12)  # rounding of 1e4 sums
    assert np.all(np.diff(found[sliding]) >= 0.0)
    assert found[sliding][-1] > 0.0


@pytest.mark.parametrize(("bearing", "harmonics"), [*((name, 0) for name in BEARINGS), *BENT])
def test_turning_the_frame_changes_nothing(bearing: str, harmonics: int) -> None:
    """The same impact turned by an angle that the balls' arrangement allows for.

    Adaptive steps weigh their errors along x and y, so another frame takes other steps; at their tolerance
    that comes to 1e-11 m, of an indentation of 30 um.
    """
    count = {"simplified_cageless": 17, "simplified_caged": 9, "angular_simplified": 9}.get(bearing, 5)
    angle = 2.0 * 2.0 * math.pi / count
    ends = []
    for turn in (0.0, angle):
        settings = {"gravity": 0.0} if bearing in ROLLING else {}
        settings |= {"ring.harmonics": harmonics} if harmonics else {}
        scene = rotor_on(
            bearing, dict(landing(bearing, turn)), {**accurate(bearing), **settings},
            duration=1e-3, macro_step=2e-5,
        )  # fmt: skip
        _, found, _ = history(
            scene, ["rotor.A.x", "rotor.A.y", "rotor.A.omega", "bearing.contact.peak_force"]
        )
        assert found["bearing.contact.peak_force"][-1] > 200.0
        x, y = found["rotor.A.x"][-1], found["rotor.A.y"][-1]
        c, s = math.cos(-turn), math.sin(-turn)
        ends.append((c * x - s * y, s * x + c * y, found["rotor.A.omega"][-1]))
    assert ends[1][:2] == pytest.approx(ends[0][:2], abs=1e-10)
    assert ends[1][2] == pytest.approx(ends[0][2], rel=1e-9)


@pytest.mark.parametrize("bearing", BEARINGS)
@pytest.mark.parametrize("seed", range(2))
def test_linear_momentum_closes(bearing: str, seed: int) -> None:
    """Forces on journal and housing, and what accelerates the ring, add up to nothing."""
    instance = state_in_contact(bearing, seed)
    dq = np.zeros(int(instance.record["n"]))
    instance.model.instant(0.0, instance.record["q"][: len(dq)].copy(), dq, instance.words)
    out = instance.record["o"]
    total = np.array([out["journal"][k] + out["housing"][k] for k in ("fx", "fy")])
    if bearing in ROLLING:
        mass = float(instance.record["p"]["ring"]["mass"])
        total += mass * dq[[ring.RVX, ring.RVY]]
    assert abs(out["journal"]["fx"]) + abs(out["journal"]["fy"]) > 1.0
    assert total == pytest.approx([0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("seed", range(2))
def test_angular_momentum_closes_in_the_cageless_bearing(seed: int) -> None:
    """About the housing: journal, ring and balls give and take what the outer race brings in."""
    instance = state_in_contact("simplified_cageless", seed)
    m, n = instance.record, int(instance.record["n"])
    q, dq = m["q"][:n].copy(), np.zeros(n)
    instance.model.instant(0.0, q, dq, instance.words)
    out, p, d = m["o"]["journal"], m["p"], m["d"]
    balls = ring.NEXT + np.arange(17)
    orbit, spin = dq[balls + 17], dq[balls + 34]
    mass, radius, rb, inertia = (float(d[k]) for k in ("mass", "pitch_radius", "ball_radius", "inertia"))
    ring_part = float(p["ring"]["inertia"]) * dq[ring.RW] + float(p["ring"]["mass"]) * (
        q[ring.RX] * dq[ring.RVY] - q[ring.RY] * dq[ring.RVX]
    )
    journal_part = out["mz"] + q[seat.JX] * out["fy"] - q[seat.JY] * out["fx"]
    ball_part = np.sum(mass * radius**2 * orbit + inertia * spin)
    outer = outer_race_moment(m, q, rb, radius)
    assert abs(journal_part) > 1e-3
    assert journal_part + ring_part + ball_part - outer == pytest.approx(0.0, abs=1e-8)


def outer_race_moment(m: np.void, q: np.ndarray, rb: float, rm: float) -> float:
    """Moment of the outer race's friction on the balls about the bearing (N m)."""
    from touchdown.bearings.contact.friction import coefficient
    from touchdown.bearings.contact.laws import power

    play, stiffness = float(m["p"]["balls"]["play"]), float(m["d"]["race"]["stiffness"])
    mass, moment = float(m["d"]["mass"]), 0.0
    for b in range(17):
        angle, orbit, spin = q[ring.NEXT + b : ring.NEXT + 51 : 17]
        depth = (
            (q[ring.RX] - q[seat.HX]) * math.cos(angle) + (q[ring.RY] - q[seat.HY]) * math.sin(angle) - play
        )
        pressed = (stiffness * power(depth, 1.5) if depth > 0.0 else 0.0) + rm * mass * orbit**2
        moment += coefficient(-(rm * orbit + rb * spin), m["d"]["race_friction"]) * pressed * (rm + rb)
    return moment
