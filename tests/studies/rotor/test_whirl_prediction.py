"""A whirl predicted: bearings on the rig, the answer for people, maps over mounts."""

from __future__ import annotations

import csv
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import touchdown
from touchdown.command.cli import main
from touchdown.studies.rotor import whirl_prediction
from touchdown.studies.rotor.supports import rotor_model
from touchdown.studies.rotor.whirl_prediction import (
    BACKWARD,
    FASTEST,
    FORWARD,
    HERTZ,
    LASTING,
    Machine,
    PredictedWhirl,
    lines,
    machine,
    over,
    with_mounts,
)

SCENE = "rotor1-18000-225um"
SLOW = {"housing_*.stiffness": 6e5, "housing_*.damping": 1e3}
WITHIN = {"housing_*.stiffness": 2e7, "housing_*.damping": 1e3, "housing_*.mass": 0.5}
BOUNCING = {"housing_*.stiffness": 6e5, "housing_*.damping": 10.0, "housing_*.mass": 0.5}
SPRINGS = {
    **dict.fromkeys(("housing_*.spring.xx", "housing_*.spring.yy"), 2e7),
    **dict.fromkeys(("housing_*.damper.xx", "housing_*.damper.yy"), 1e3),
    "housing_*.mass": 0.5,
}


@pytest.fixture(scope="module")
def known() -> Machine:
    """Rotor I at the speed that it has once a drop of this scene whirls steadily."""
    return machine(touchdown.load(SCENE), 12_000.0 * HERTZ / 60.0)


def test_it_is_where_drops_are(known: Machine) -> None:
    """Plateaus of drops: 644 to 647 Hz with 13.0 and 17.1 kN; with damped housings 500 Hz, 5.85, 7.71 kN.

    The first within 1 %, as far as drops repeat; asked are 10 % and 20 %, of which half is left for others.
    """
    damped = with_mounts(known, touchdown.load(SCENE).set({"housing_*.damping": 1e4}))
    for made, hertz, forces in ((known, 645.5, (13.1e3, 17.15e3)), (damped, 500.0, (5.85e3, 7.71e3))):
        found = made.predicted()
        assert found.settled is not None
        assert found.frequency == pytest.approx(hertz, rel=0.05)
        assert found.settled.force == pytest.approx(forces, rel=0.1)
        assert found.settled.omega < 0.0
        assert found.margin > 10.0
    assert "and lasts once it has begun" in next(lines(found))
    forward = known.predicted(FORWARD)
    assert forward.settled is None
    assert math.isnan(forward.frequency)
    assert list(lines(forward)) == ["forward whirl: none; the bearings' forces brake it"]


def test_the_bearing_on_its_rig(known: Machine) -> None:
    """Two alike are measured once; forces along the circle drive backwards and brake forwards."""
    first, second = known.journals
    assert first.measured is second.measured
    backward, forward = first.measured[BACKWARD], first.measured[FORWARD]
    assert np.all(np.imag(backward.force) > 0.0)
    assert np.all(np.imag(forward.force) < 0.0)
    assert np.all(np.diff(np.real(backward.force), axis=1) < 0.0)
    # between the points measured, and beyond them, as a power law
    omega = -float(backward.omega[0])
    assert backward(float(backward.depth[3]), omega) == pytest.approx(
        complex(backward.force[0, 3].real, -backward.force[0, 3].imag), rel=1e-9
    )
    assert backward(1e-3, omega).real < backward.force[0, -1].real
    # of balls between rigid rings without play, Stribeck's 4.37/Z of the load, and the ring's inertia
    share = backward.loaded(20e-6, omega) / abs(backward(20e-6, omega))
    assert share == pytest.approx(4.37 / 17.0, rel=0.02)
    assert first.limits.ball == pytest.approx(1695.0, rel=1e-3)


@pytest.mark.slow
def test_bearings_that_grow_are_pressed_as_deep(known: Machine) -> None:
    """Their bores grow by more than the shallowest circle is deep: they seemed not to push back."""
    grown = machine(touchdown.load(SCENE).set({"bearing_*.ring.growth": 1}), 12_000.0 * HERTZ / 60.0)
    assert grown.predicted().frequency == pytest.approx(known.predicted().frequency, rel=0.05)


def test_no_gravity_acts_across_an_upright_shaft(known: Machine) -> None:
    """The inclination is the scene's; nothing is there to end the whirl."""
    scene = touchdown.load(SCENE)
    model = rotor_model(scene.set({"inclination": "90 deg"}))
    assert model.gravity == 0.0
    leaning = rotor_model(scene.set({"inclination": "60 deg"}))
    assert leaning.gravity == pytest.approx(0.5 * 9.81, rel=1e-9)
    found = replace(known, model=model).predicted()
    assert found.settled is not None
    assert found.margin == math.inf
    said = list(lines(found))
    assert said[0].endswith("and lasts once it has begun")
    assert said[1] == "  no gravity acts across its shaft, to which it could fall back"


@pytest.mark.parametrize(
    ("spin", "rpm"), [(None, [6000.0, 15_000.0]), (900.0, [900.0 * 30.0 / math.pi] * 2)]
)
def test_speeds_that_are_varied_are_those_of_the_scene(
    known: Machine, monkeypatch: pytest.MonkeyPatch, spin: float | None, rpm: list[float]
) -> None:
    """A speed that is asked for overrides them. Bearings stay as measured, to do without their rig."""
    spins: list[float] = []

    def measured(scene: touchdown.Scene, spin: float | None = None) -> Machine:
        made = replace(known, spin=math.copysign(spin or rotor_model(scene).speed, known.spin))
        spins.append(abs(made.spin) * 30.0 / math.pi)
        return made

    monkeypatch.setattr(whirl_prediction, "machine", measured)
    points = [{"rotor.speed": speed} for speed in ("6000 rpm", "15000 rpm")]
    found = over(known, touchdown.load(SCENE), points, spin=spin)
    assert spins == pytest.approx(rpm, rel=1e-9)
    assert (found[0].frequency == found[1].frequency) == (spin is not None)


def test_a_path_of_circles_that_is_lost_is_no_whirl_beyond_it(known: Machine) -> None:
    """Both are driven all the way; of the one that ends early nothing is known."""
    found = known.predicted()
    slowest = replace(found.way[0], drive=0.5)
    for hertz, told in (
        (400.0, "no circle was found beyond 400 Hz; the whirl is not known"),
        (FASTEST, "it would be driven beyond 3000 Hz"),
    ):
        way = (slowest, replace(slowest, omega=-HERTZ * hertz))
        assert PredictedWhirl(known, BACKWARD, way, None).why_none == told


def test_predictions_beyond_the_model_name_its_limits(known: Machine) -> None:
    """A mount without damping under rotor I would have 0.9 kHz, 2 to 3 MN and strokes of 20 to 30 mm.

    On soft mounts the whirl is slow, so gentle that journals are pressed in less than on the rig, and it
    ends: the margin is W^2 c over ten times gravity.
    """
    assert not with_mounts(known, touchdown.load(SCENE).set(WITHIN)).predicted().beyond
    found = with_mounts(known, touchdown.load(SCENE).set({"housing_*.damping": 10.0})).predicted()
    said = "\n".join(lines(found))
    limits = said.partition("beyond the limits of the model, so that its figures are not reliable:")[2]
    assert re.search(r"90\d.\d Hz; bearings are measured up to 700 Hz", limits)
    assert re.search(r"bearing_A pressed in by 3,\d{3} um; measured up to 150 um", limits)
    assert re.search(r"bearing_B loaded by 2,\d\d\d,\d{3} N; its C0 is 5,763 N", limits)
    assert re.search(r"mount of bearing_A moved by 2\d,\d{3} um; the clearance is 300 um", limits)
    slow = with_mounts(known, touchdown.load(SCENE).set(SLOW)).predicted()
    assert slow.settled is not None
    clearance = known.journals[0].clearance
    assert slow.margin == pytest.approx(slow.settled.omega**2 * clearance / (LASTING * 9.81), rel=1e-3)
    shallow = replace(slow, settled=replace(slow.settled, depth=np.array([0.5e-6, 2e-6])))
    told = list(lines(shallow))
    assert "too slow to last against gravity" in told[0]
    assert told[-2:] == [
        f"    {slow.frequency:.4g} Hz; bearings are measured from 150 Hz on",
        "    bearing_A pressed in by 0.5 um; measured from 1 um on",
    ]


def test_a_mount_unlike_in_its_directions_makes_no_circle(known: Machine) -> None:
    """Stiffness of k and r k along x and y: ratio r, whichever is the stiffer, and r = 1.2 is the most."""
    scene = touchdown.load(SCENE).swap(housing_A="mount", housing_B="mount").set(SPRINGS)
    for ratio, refused in ((1.15, False), (1.25, True), (0.5, True)):
        there = scene.set({"housing_A.spring.yy": 2e7 * ratio})
        found = with_mounts(known, there).predicted()
        assert (found.settled is None) == refused
        assert math.isnan(found.frequency) == refused
        unlike = max(ratio, 1.0 / ratio)
        assert ("not predicted; the mount of bearing_A, with its mass" in next(lines(found))) == refused
        mount = with_mounts(known, there).journals[0]
        assert mount.unlike(1e-3, 1e-6) == pytest.approx(unlike, rel=1e-6)


def test_a_carrier_makes_its_mount_more_unlike(known: Machine) -> None:
    """By k - m W^2: 10 kg at 150 Hz take 8.9e6 from 2e7 and 2.4e7 N/m, and 1.2 is 1.36."""
    scene = touchdown.load(SCENE).swap(housing_A="mount", housing_B="mount").set(SPRINGS)
    settings = {f"housing_*.damper.{axis}": 0.0 for axis in ("xx", "yy")}
    settings |= {"housing_*.mass": 10.0, "housing_*.outer_ring": 0.0, "housing_A.spring.yy": 2.4e7}
    made = with_mounts(known, scene.set(settings))
    omega = HERTZ * 150.0
    inertia = 10.0 * omega**2
    mount = made.journals[0]
    assert mount.unlike(0.0, 1e-6) == pytest.approx(1.2, rel=1e-9)
    expected = (2.4e7 - inertia) / (2e7 - inertia)
    assert expected == pytest.approx(1.36, rel=2e-3)
    assert mount.unlike(-omega, 1e-6) == pytest.approx(expected, rel=1e-9)
    # between both resonances it resists one way and helps the other: no circle at all
    assert mount.unlike(math.sqrt(2.2e6), 1e-6) == math.inf
    circle = replace(known.predicted().way[0], omega=omega)
    assert "bearing_A, with its mass at 150 Hz, is 1.36 times" in made._ellipse(circle)
    other = replace(made, journals=made.journals[1:])
    assert other._ellipse(replace(circle, stroke=circle.stroke[1:])) == ""


def test_bounces_press_harder_than_the_circle(known: Machine) -> None:
    """On soft mounts a slow whirl is broken up into bounces, which press several times as hard."""
    scene = touchdown.load(SCENE).set(BOUNCING)
    found = with_mounts(known, scene).predicted()
    assert found.settled is not None
    said = list(lines(found))
    assert "which breaks it up into bounces" in said[0]
    assert "how long they go on is not predicted" in said[2]
    summary = touchdown.run(
        scene.set({"run.duration": 0.15, "run.stop_residual": 1e9}), in_process=True
    ).summary
    drop = max(summary["seats"][end]["peak_contact_force"] for end in "AB")
    assert drop > 2.0 * found.settled.force.max()


@pytest.mark.parametrize("carried", [0.5, math.inf])
def test_an_impact_is_that_of_two_masses(known: Machine, carried: float) -> None:
    """On F = K d^n they stop at E = K d^(n + 1)/(n + 1) = v^2/(2 (1/m + 1/M)), v^2 = (W (c + s))^2 + 4 g c.

    1/m is that of the rigid rotor at the journal, 1/mass + z^2/It.
    """
    stiffness, power, hertz, stroke = 5e9, 1.5, 100.0, 80e-6
    depth = whirl_prediction.DEPTHS
    pressed = np.tile(-stiffness * depth**power + 0.0j, (2, 1))
    law = whirl_prediction.Measured(
        HERTZ * np.array([150.0, 700.0]), depth, pressed, np.zeros((2, len(depth)))
    )
    settled, shaft = known.predicted().settled, known.model.shaft
    assert settled is not None
    for journal in known.journals:
        alone = replace(journal, carried=carried, measured={BACKWARD: law, FORWARD: law})
        circle = replace(settled, omega=-HERTZ * hertz, stroke=np.array([stroke]))
        found = PredictedWhirl(replace(known, journals=(alone,)), BACKWARD, (), circle)
        lever = shaft.positions()[journal.node - 1] - shaft.centre_of_mass
        gain = 1.0 / shaft.mass + lever**2 / shaft.diametral_inertia + 1.0 / carried
        c = journal.clearance
        energy = 0.5 * ((HERTZ * hertz * (c + stroke)) ** 2 + 4.0 * known.model.gravity * c) / gain
        indentation = ((power + 1.0) * energy / stiffness) ** (1.0 / (power + 1.0))
        assert depth[0] < indentation < depth[-1]
        assert found.impact == pytest.approx(stiffness * indentation**power, rel=2e-3)


@pytest.mark.slow
def test_a_map_by_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two settings make a table and a picture."""
    asked = ["whirl", SCENE, "-o", str(tmp_path), "--quiet"]
    asked += ["--vary", "housing_*.stiffness=2:200:3:log MN/m"]
    asked += ["--vary", "housing_*.damping=300,3000 N.s/m"]
    assert main(asked) == 0
    said = capsys.readouterr().out
    assert "backward whirl: 64" in said
    drag = re.search(
        r"with twice the drag of the balls \(rolling.resistance, assumed\): ([\d.]+) times the", said
    )
    assert drag is not None
    assert 1.2 < float(drag[1]) < 2.0
    some = re.search(r"\(balls.damping_ratio = 0.02; there is none\): ([\d.]+) times the force", said)
    assert some is not None
    assert 0.9 < float(some[1]) < 1.0
    with (tmp_path / "whirl.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["housing_*.stiffness"] for row in rows[::2]] == ["2 MN/m", "20 MN/m", "200 MN/m"]
    hertz = [float(row["frequency_Hz"]) for row in rows]
    assert hertz[0] < hertz[2] < hertz[4]
    assert (tmp_path / "whirl.png").stat().st_size > 10_000


def test_bearings_on_one_foundation() -> None:
    """Without modes each stands on its mount; with them the whirl is slower, and drops find it there."""
    scene = touchdown.load("rotor1-foundation")
    found = machine(scene, 12_000.0 * HERTZ / 60.0)
    apart = with_mounts(found, scene.set({"foundation.modes": 0})).predicted()
    assert apart.frequency == pytest.approx(645.5, rel=0.05)  # as in the housings that its mounts are
    whole = found.predicted()
    assert whole.settled is not None
    assert whole.frequency < 0.5 * apart.frequency
    assert np.all(whole.settled.stroke > 0.0)
