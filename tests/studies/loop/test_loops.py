"""Loops of scenes: against closed forms, against other equations, and against what the rotor does."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from levitation import (
    BIAS,
    FILTER,
    GAP,
    K_I,
    KD,
    KI,
    KP,
    MASS,
    PERIOD,
    POLE,
    K,
    Loop,
    by_one_controller,
    from_sample_to_sample,
)  # fmt: skip
from places import ROOT
from pythonfmu import FmuBuilder
from scipy.optimize import newton
from systems import history

import touchdown
from touchdown.command.cli import main
from touchdown.command.verbs.scenes import chosen_scene
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.master.scene.file import load_scene, read_names
from touchdown.master.scene.scene import Scene
from touchdown.studies.loop.linear_loops import (
    Loops,
    Sampled,
    StateSpace,
    loops_of,
    measured_laws,
)
from touchdown.studies.loop.loop_report import lines
from touchdown.studies.loop.over_speed import damping_ratio, limit_warnings, loops_in

DISK = "disk-caged-relevitated"


def sensitivity(loops: Loops, omega: float, speed: float) -> np.ndarray:
    """S at the sensors, all loops closed (axes, axes)."""
    return loops.closed(speed).balanced().sensitivity(np.array([omega]))[0]


def response(law: StateSpace, z: complex) -> np.ndarray:
    """C(z) (axes, axes)."""
    return law.C @ np.linalg.solve(z * np.eye(len(law.A)) - law.A, law.B) + law.D


def by_hand(omega: complex, kd: float = KD, period: float = PERIOD, **plants: float) -> complex:
    """S of the disk's axis, with C(z)."""
    ahead = from_sample_to_sample(period, **plants)
    z = np.exp(1j * omega * period)
    plant = np.linalg.solve(z * np.eye(4) - ahead[:4, :4], ahead[:4, 4])[3]
    law = KP + KI * period * z / (z - 1) + kd * FILTER * (z - 1) / ((1 + FILTER * period) * z - 1)
    return complex(1 / (1 + law * plant / z))


def pole_by_hand(near: complex, **changes: float) -> complex:
    """The pole (1/s) to which Newton's rule comes from `near`."""
    return complex(newton(lambda s: 1 / by_hand(-1j * s, **changes), near, tol=1e-10))


def test_the_disk_by_hand():
    """And the slowest poles, at which the rotor rings down in time (below)."""
    found = loops_in(load_scene(DISK), [0.0])
    loops, own = found.loops, found.own
    for hz in (20.0, 56.0, 300.0, 2000.0):
        omega = 2 * math.pi * hz
        s = sensitivity(loops, omega, loops.speed)
        assert np.diag(s) == pytest.approx([by_hand(omega)] * 2, rel=1e-9)
        assert abs(s[0, 1]) < 1e-9
    for pole in (pole_by_hand(-6.0), pole_by_hand(-110 + 310j)):
        assert np.abs(own.poles - pole).min() < 1e-6 * abs(pole)
    assert isinstance(loops, Sampled)
    (bearing,) = loops.bearings
    assert bearing.axes[0].current_factor == pytest.approx(K_I, rel=1e-12)
    assert bearing.load == pytest.approx(MASS * 9.81, rel=1e-9)
    gap = GAP + 0.3e-3 / math.sqrt(2) * math.cos(POLE)
    lifting = gap * math.sqrt(MASS * 9.81 / (math.sqrt(2) * K * math.cos(POLE)))
    assert bearing.axes[0].lifting_current(bearing.load, 0.3e-3, math.pi / 4) == pytest.approx(lifting)
    assert lifting == pytest.approx(2.499, abs=5e-4)


@pytest.mark.parametrize(
    ("changes", "alike"),
    [
        ({}, {}),
        ({"controller.gain.derivative": KD / 2}, {"kd": KD / 2}),
        ({"amb.sample_time": 2e-4, "run.macro_step": 1e-4}, {"period": 2e-4}),
        ({"amb.amplifier.bandwidth": 1000 * math.pi}, {"amplifier": 1000 * math.pi}),
        ({"amb.amplifier.bias": 0.4}, {"bias": 0.4}),  # one coil alone
        ({"rotor.mass": 4.0}, {"mass": 4.0}),
        ({"rotor.gravity": 0.0}, {"gravity": 0.0}),
    ],
)
def test_peaks_are_those_of_the_disk_by_hand(changes: dict[str, float], alike: dict[str, float]):
    """On lines 0.1 % apart, which miss a peak of this width by less than 1e-5."""
    found = loops_in(load_scene(DISK).set(changes), [0.0])
    omega = 2 * math.pi * np.geomspace(10.0, 1000.0, 4600)
    sizes = [abs(by_hand(w, **alike)) for w in omega]
    assert found.own.margins[0].peak == pytest.approx(max(sizes), rel=2e-5)
    assert found.own.margins[0].at == pytest.approx(omega[np.argmax(sizes)], rel=1e-3)


def ring(scene: Scene, until: float, gravity: float = 0.0, beside: float = 1e-6) -> np.ndarray:
    """x of the rotor at the ticks (m), let loose `beside` (m) the centre."""
    scene = scene.set({"rotor.x": beside, "rotor.gravity": gravity, "rotor.speed": 0.0})
    times, values, _ = history(scene.set({"run.duration": until}), ["rotor.A.x"])
    at = np.rint(np.arange(1, round(until / PERIOD)) * PERIOD / scene.run.macro_step).astype(int) - 1
    assert np.allclose(times[at] / PERIOD, np.rint(times[at] / PERIOD), atol=1e-6)
    return values["rotor.A.x"][at]


def nearest_root(x: np.ndarray, pole: complex, order: int) -> float:
    """Of a matrix pencil on samples x, how near its roots come to a pole (1/s), over the pole's size."""
    rows = np.array([x[i : i + len(x) // 3] for i in range(len(x) - len(x) // 3)])
    v = np.linalg.svd(rows, full_matrices=False)[2][:order]
    roots = np.log(np.linalg.eigvals(v[:, 1:] @ np.linalg.pinv(v[:, :-1])).astype(complex)) / PERIOD
    return float(np.abs(roots - pole).min() / abs(pole))


@pytest.mark.parametrize(
    ("mass", "bias", "gravity", "near"),
    [(MASS, BIAS, 0.0, -110 + 320j), (4.0, 2.0, 9.81, -50 + 210j), (1.65, 0.4, 9.81, -50 + 210j)],
)
def test_a_rotor_rings_at_the_poles_of_its_operating_point(
    mass: float, bias: float, gravity: float, near: complex
):
    """About the centre without load the second would be 206.2 rad/s; the last has one coil switched off."""
    pole = pole_by_hand(near, mass=mass, bias=bias, gravity=gravity)
    scene = Loop().scene(60e-3, 20e-6).set({"rotor.mass": mass, "amb.amplifier.bias": bias})
    there = loops_of(scene.set({"rotor.gravity": gravity})).closed(0.0)
    assert np.abs(there.poles - pole).min() < 1e-6 * abs(pole)
    x = ring(scene, 60e-3, gravity, beside=1e-8 if gravity else 1e-6)[30:430]
    assert nearest_root(x, pole, 4) < (1e-4 if gravity else 1e-5)


def test_a_rotor_rings_at_the_poles_with_eddy_currents():
    """At 120 Hz they are as strong as the gaps: -27 1/s, without them -110 1/s."""
    scene = Loop().scene(60e-3, 20e-6).set({"amb.magnet.eddy_bandwidth": 240 * math.pi})
    poles = loops_of(scene.set({"rotor.gravity": 0.0})).closed(0.0).poles
    rings = poles[(poles.imag > 100.0) & (poles.imag < 1000.0)]
    assert rings[0].real == pytest.approx(-27.08, abs=0.01)
    assert nearest_root(ring(scene, 60e-3)[30:430], complex(rings[0]), 8) < 1e-5


def test_a_run_starts_with_the_weight_held():
    """With less bias than holding current, too; what coupling leaves is below a nanometre."""
    scene = Loop().scene(20e-3, 20e-6).set({"amb.amplifier.bias": 0.4, "rotor.speed": 0.0})
    assert np.abs(history(scene, ["rotor.A.y"])[1]["rotor.A.y"]).max() < 1e-9


def test_a_delay_too_many_makes_the_loop_unstable_and_the_rotor_grow_at_its_pole():
    """A third of the damping, an amplifier of 60 Hz, one more sample: it grows as the pole says."""
    slow = {"controller.gain.derivative": KD / 3, "amb.amplifier.bandwidth": 120 * math.pi}
    scene = Loop().scene(60e-3, 20e-6).set({"controller.delay": 1, "rotor.gravity": 0.0, **slow})
    loops = loops_of(scene)
    poles = loops.closed(0.0).poles
    grows = poles[np.argmax(poles.real + (poles.imag < 0.0) * -1e-9)]
    assert grows.real > 20.0
    assert nearest_root(ring(scene, 60e-3)[100:500], grows, 6) < 1e-4


def notch(hertz: float, zeros: float, poles: float) -> dict[str, float]:
    """A second-order section by the bilinear rule, exact at `hertz`, with two damping ratios."""
    w = math.tan(math.pi * hertz * PERIOD)
    (b0, b1, b2), (a0, a1, a2) = (
        (1 + 2 * d * w + w * w, 2 * (w * w - 1), 1 - 2 * d * w + w * w) for d in (zeros, poles)
    )
    return {"b0": b0 / a0, "b1": b1 / a0, "b2": b2 / a0, "a1": a1 / a0, "a2": a2 / a0}


@pytest.mark.parametrize(("notched", "rate"), [(False, 12.872), (True, -4.0306)])
def test_a_bending_mode_grows_at_its_pole_and_a_notch_saves_it(notched: bool, rate: float):
    """Rotor I with a damping ratio of 5e-4 and twice the derivative gain, standing, without weight."""
    scene = load_scene("rotor1-relevitated")
    scene = scene.set({"rotor.damping_ratio": 5e-4, "rotor.speed": 0.0, "rotor.gravity": 0.0})
    scene = scene.set({"rotor.x": 1e-6, "run.duration": 85e-3, "run.macro_step": 20e-6})
    for name in ("controller_A", "controller_B"):
        scene = scene.set({f"{name}.gain.derivative": 2 * KD, f"{name}.event[1].kind": "none"})
        for channel in (1, 2) if notched else ():
            section = f"{name}.channel[{channel}].section[1]"
            scene = scene.set({f"{section}.{k}": v for k, v in notch(1600.0, 0.05, 0.7).items()})
    poles = loops_of(scene).closed(0.0).poles
    bends = poles[np.argmax(np.where(poles.imag > 100.0, poles.real, -math.inf))]
    assert bends.real == pytest.approx(rate, rel=1e-3)
    assert bends.imag == pytest.approx(2 * math.pi * 1600.0, rel=1e-3)
    x = history(scene, ["rotor.A.x"])[1]["rotor.A.x"][4::5]  # at the ticks
    found = nearest_root(x[200:800], bends, 12) * abs(bends)
    assert found < 1e-2 * abs(rate)


def test_translation_and_tilt_with_equal_gains_are_the_same_loops():
    two, one = loops_of(load_scene("rotor1-relevitated")), loops_of(by_one_controller())
    for hz in (30.0, 200.0, 1500.0):
        found, expected = (sensitivity(x, 2 * math.pi * hz, x.speed) for x in (one, two))
        assert found == pytest.approx(expected, abs=1e-9)


@pytest.fixture
def told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Iterator[Callable[..., tuple[int, str]]]:
    """Status and text of `touchdown amb-margins` with the disk and these words; it draws a picture."""

    def run(*words: str) -> tuple[int, str]:
        return main(["amb-margins", DISK, *words, "-o", str(tmp_path)]), capsys.readouterr().out

    yield run
    assert (tmp_path / "amb-margins.png").stat().st_size > 10_000


def test_the_command(told: Callable[..., tuple[int, str]]):
    status, said = told("--speeds", "0 rpm, 9000 rpm")
    assert status == 0
    assert "k_i 25.8 N/A, k_s -83.36 kN/m, slew 615.9 kN/s; 2.499 A in its coils lift 16.19 N" in said
    rows = [" ".join(line.split()) for line in said.splitlines()]
    assert "amb.axis[1] 2.4853 7.91 A 56.09 57.2 1.129" in rows
    assert "amb.axis[1] 2 0.4436 0 2.444 6 0.5118 1.2" in rows


def test_speeds_without_a_unit_are_said_to_be_in_rad_per_second(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    """But for 0; numbers in Python are in SI."""
    said = "speed 900 has no unit: it is taken for rad/s, 8594 rpm"
    with pytest.warns(UserWarning, match=said) as noted:
        touchdown.amb_margins(DISK, speeds=["0", "900", "9000 rpm", 5.0])
    assert len(noted) == 1
    assert main(["amb-margins", DISK, "--speeds", "900", "-o", str(tmp_path)]) == 0
    assert said in capsys.readouterr().err


def test_an_unstable_loop_has_no_zone_and_no_margin(told: Callable[..., tuple[int, str]]):
    """A derivative gain of the wrong sign; the verdict comes first, and in the exit status."""
    status, text = told(
        *("--set", "controller.gain.derivative=-15.5", "--set", "rotor.eccentricity=1 um"),
        *("--speeds", "9000 rpm"),
    )
    assert status == FAILED
    said, pole = text.splitlines(), pole_by_hand(126 + 270j, kd=-15.5)
    verdict = f"a pole at {pole.real:+.4g} 1/s, {pole.imag / (2 * math.pi):.4g} Hz"
    assert "orbits by the unbalance" not in text
    assert said[0].startswith(f"unstable at 9000 rpm: {verdict}")
    rows = [line.split() for line in said if line.startswith("  amb.axis") and len(line.split()) == 2]
    assert rows == [["amb.axis[1]", "unstable"], ["amb.axis[2]", "unstable"]]
    assert any(line.split()[:2] == ["9000", "unstable"] for line in said)
    budget = next(k for k, line in enumerate(said) if "without unbalance" in line)
    assert said[budget + 2].split()[3] == "-"
    assert limit_warnings(load_scene(DISK).set({"controller.gain.derivative": -15.5})) == said[:1]


def test_magnets_that_cannot_hold_the_rotor_have_no_zone(told: Callable[..., tuple[int, str]]):
    status, said = told("--set", "amb.magnet.flux_limit=0.35", "--speeds", "9000 rpm")
    assert status == FAILED
    weak = "amb: its magnets give 9.568 N at most at the centre, and its static load is 11.45 N"
    assert said.startswith(weak)
    assert "k_i 0.2562 N/A" in said


def test_limits_are_said_where_they_act():
    """Before a run, with the current that the unbalance takes; of shipped scenes nothing is to be said."""
    scene = load_scene(DISK)
    assert limit_warnings(scene) == []
    assert limit_warnings(load_scene("rotor1-relevitated")) == []
    (line,) = limit_warnings(scene.set({"amb.amplifier.current_limit": 2.5, "rotor.eccentricity": 5e-6}))
    assert line.startswith("amb.axis[1], amb.axis[2]: a coil is to carry 2.56 A")
    result = touchdown.run(scene.set({"amb.amplifier.bias": 0.4, "run.duration": 1e-3}), in_process=True)
    assert any("switches one coil off; k_i is 12.15 N/A" in warning for warning in result.warnings)


def test_unbalance_swings_currents_and_fluxes_as_in_a_run():
    """5 um at 9000 rpm, settled: amplitudes of a set point and of a coil's flux linkage."""
    scene = Loop(eccentricity=5e-6).scene(0.2, 20e-6).set({"rotor.gravity": 0.0})
    loops = loops_of(scene)
    assert isinstance(loops, Sampled)
    assert loops.bearings[0].load == loops.bearings[0].axes[0].hold == 0.0
    swing, (flux, *_) = loops.unbalance(loops.speed).of(0)
    names = ["controller.axis[1].set", "amb.axis[1].current_plus", "rotor.A.x", "rotor.A.y"]
    values = {name: column[-2000:] for name, column in history(scene, names)[1].items()}
    assert values["controller.axis[1].set"].max() == pytest.approx(swing, rel=0.01)  # of 67 samples a turn
    along = (values["rotor.A.x"] + values["rotor.A.y"]) / math.sqrt(2)
    fluxes = 2 * K * values["amb.axis[1].current_plus"] / (GAP - math.cos(POLE) * along)
    assert 0.5 * np.ptp(fluxes) == pytest.approx(flux, rel=0.01)


def test_bending_modes_have_poles_of_their_own():
    """Rotor I: three in each plane below 5 kHz, apart by the gyroscopic coupling, damped a little."""
    own = loops_in(load_scene("rotor1-relevitated"), []).own
    free = np.array([mode.free.imag for mode in own.bending]) / (2 * math.pi)
    assert free == pytest.approx([1574, 1626, 2694, 2773, 3918, 3996], abs=1.0)
    assert len({mode.pole for mode in own.bending}) == 6
    for mode in own.bending:
        assert abs(mode.pole - mode.free) < 0.005 * abs(mode.free)
    assert damping_ratio(own.poles[0]) == min(damping_ratio(mode.pole) for mode in own.bending)


def test_modes_above_half_the_sampling_frequency_are_not_shown_as_slow_ones():
    """Rotor I bends at 7863, 7933, 12535 and 12611 Hz; samples every 100 us show that from 2067 Hz to 2611.

    All poles are there, and judged; shown are the six modes below 5 kHz and what is well damped.
    """
    found = loops_in(load_scene("rotor1-relevitated"), [0.0])
    own, rate = found.own, 1.0 / PERIOD
    free = found.loops.rotor.bending(own.speed, math.inf) / (2.0 * math.pi)
    fast = free[free.imag > 0.5 * rate]
    looks = np.abs(fast.imag - rate * np.round(fast.imag / rate))
    assert sorted(looks) == pytest.approx([2067, 2137, 2535, 2611], abs=1.0)

    def light(poles: np.ndarray) -> list[float]:
        return sorted(p.imag / (2.0 * math.pi) for p in poles if 0.0 < damping_ratio(p) < 0.05)

    bending = [mode.pole.imag / (2.0 * math.pi) for mode in own.bending]
    assert light(own.shown) == pytest.approx(bending)
    assert light(own.poles) == pytest.approx(sorted([*bending, *looks]), abs=0.1)
    assert "half the sampling frequency, 5000 Hz, are not shown" in "\n".join(lines(found))


def test_names_of_a_file_go_to_all_components_that_match(tmp_path: Path):
    names = tmp_path / "names.toml"
    names.write_text('"axis[1].sensed" = "pos_a"\n')
    scene = chosen_scene(
        "rotor1-relevitated", swap=["controller_*=mine.fmu"], names=[f"controller_*={names}"]
    )
    assert scene
    for name in ("controller_A", "controller_B"):
        assert scene.components[name].names == {"axis[1].sensed": "pos_a"}
    assert not scene.components["amb_A"].names


def test_scenes_without_a_known_loop_are_refused():
    scene = load_scene(DISK)
    with pytest.raises(TouchdownError, match="must sample after the same time; sample_time is 0 s"):
        loops_of(scene.set({"amb.sample_time": 0.0}))
    with pytest.raises(TouchdownError, match="has no magnetic bearing"):
        loops_of(replace(scene, control=()))
    refused = r"command = force, but controller gives axis\[1\]\.set, a current; set amb.command = current"
    with pytest.raises(TouchdownError, match=refused):
        loops_of(scene.set({"amb.command": "force"}))
    with pytest.raises(TouchdownError, match="and it controls one bearing; its loop is not known"):
        loops_of(scene.set({"controller.structure": 1}))
    with pytest.raises(TouchdownError, match=r"by clocks of their own \(controller every 0\.0001 s\)"):
        loops_of(scene.set({"controller.clock": "own", "amb.sample_time": 2e-4}))
    with pytest.raises(TouchdownError, match="tilt under its magnetic bearing, at amb_position"):
        loops_of(scene.set({"rotor.transverse_inertia": 1e-3, "rotor.amb_position": 0.05}))


def test_a_controller_of_others_is_measured(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """The example of a user's own controller has the law of the project's, found from its answers alone."""
    FmuBuilder.build_FMU(ROOT / "examples" / "pid_controller.py", dest=tmp_path)
    fmu, names = tmp_path / "PidController.fmu", ROOT / "examples" / "pid_controller.toml"
    words = ["amb-margins", DISK, "--swap", f"controller={fmu}", "--names", f"controller={names}"]
    words += ["--set", "controller.sampled=1e-4"]
    assert main([*words, "--speeds", "9000 rpm", "-o", str(tmp_path / "loop")]) == 0
    assert "C(z) measured, 4 states, which miss the lines by" in capsys.readouterr().out
    scene = load_scene(DISK)
    swapped = scene.swap(controller=str(fmu)).with_names("controller", read_names(names))
    found, known = loops_of(swapped.set({"controller.sampled": "100 us"})), loops_of(scene)
    for hertz in (1.0, 20.0, 55.6, 400.0, 4500.0):
        omega = 2.0 * math.pi * hertz
        assert sensitivity(found, omega, 0.0) == pytest.approx(
            sensitivity(known, omega, 0.0), rel=1e-9, abs=1e-9
        )
    slow, near = (
        poles[poles.real > -1000.0] for poles in (known.closed(0.0).poles, found.closed(0.0).poles)
    )
    assert len(slow) == len(near) == 6
    apart = np.abs(slow[:, None] - near) / np.abs(slow)[:, None]
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-6


def test_a_measured_law_is_that_of_the_equations():
    """Translation and tilt of rotor I with gains of their own, a notch, and a sample more of delay."""
    both = by_one_controller().set({"controller_A.delay": 1})
    notch = {"b0": 0.9, "b1": -1.5, "b2": 0.85, "a1": -1.4, "a2": 0.7}
    for channel in (3, 4):
        own = f"controller_A.channel[{channel}]"
        both = both.set({f"{own}.derivative": 1.7})
        both = both.set({f"{own}.section[1].{name}": value for name, value in notch.items()})
    loops = loops_of(both)
    assert isinstance(loops, Sampled)
    measured = measured_laws(both, loops.bearings, loops.period)
    for hertz in (1.0, 37.0, 555.0, 4900.0):
        z = complex(np.exp(2j * math.pi * hertz * loops.period))
        expected = response(loops.laws.state_space, z) / z ** (loops.laws.delay - 1)
        assert np.abs(expected[0, 2]) > 0.01 * np.abs(expected).max()  # both ends answer to one
        assert np.abs(response(measured.state_space, z) - expected).max() < 1e-8 * np.abs(expected).max()
