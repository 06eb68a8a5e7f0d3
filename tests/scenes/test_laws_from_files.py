"""Controllers from files: runs and loops are those of the same laws written otherwise."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from levitation import FILTER, K_I, K_S, KD, KI, KP, LOW_PASS, MASS, PERIOD, Loop
from places import ROOT
from pythonfmu import FmuBuilder
from scipy.linalg import expm, solve_discrete_are
from systems import history

from touchdown.bearings.magnetic.law_file import ENDINGS
from touchdown.command.cli import main
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene, read_names
from touchdown.master.scene.scene import LAWS, Scene
from touchdown.studies.loop.linear_loops import Loops, Sampled, loops_of
from touchdown.studies.loop.over_speed import limit_warnings
from touchdown.studies.sweep.definition import define
from touchdown.studies.sweep.design import Design

DISK = "disk-caged-relevitated"
CENTRE = ["rotor.A.x", "rotor.A.y"]
SPEED = 9000 * math.pi / 30
LQG_SCRIPT = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Lqg(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.states = [[0.0] * 4, [0.0] * 4]
        for name in ("pos_a", "pos_b", "hold_a", "hold_b", "cur_a", "cur_b"):
            setattr(self, name, 0.0)
            into = name[:3] != "cur"
            causality = Fmi2Causality.input if into else Fmi2Causality.output
            self.register_variable(Real(name, causality=causality))

    def do_step(self, current_time, step_size):
        self.cur_a = self.hold_a + self.answer(self.states[0], self.pos_a)
        self.cur_b = self.hold_b + self.answer(self.states[1], self.pos_b)
        return True

    def answer(self, x, y):
        u = -sum(k * one for k, one in zip(K, x))
        x[:] = [sum(a * one for a, one in zip(row, x)) + l * y for row, l in zip(A, L)]
        return min(max(u, -4.0), 4.0)
"""


def pid(current: float = 1.0, **scales: float) -> dict[str, Any]:
    """`amb_controller`'s, the derivative of the position alone; states: sum, filtered slope, last position.

    current: A for one of what it gives.
    """
    kp, ki, kd = (k * scales.get(n, 1.0) / current for n, k in (("p", KP), ("i", KI), ("d", KD)))
    q = 1 / (1 + FILTER * PERIOD)
    slope = q * kd * FILTER
    return {
        "sample_time": "100 us",
        "A": [[1, 0, 0], [0, q, -slope], [0, 0, 0]],
        "B": [[ki * PERIOD, ki * PERIOD], [slope, 0], [1, 0]],
        "C": [[1, q, -slope]],
        "D": [[kp + ki * PERIOD + slope, kp + ki * PERIOD]],
    }


def lqg() -> dict[str, np.ndarray]:
    """Of the disk's axis: position, velocity, the acting current, the sensor's signal; A, L, K."""
    whole, b, c = np.zeros((4, 4)), np.eye(4)[:, 2:3], np.eye(4)[3:]
    whole[0, 1], whole[1, :3] = 1, (-K_S / MASS, 0, K_I / MASS)
    whole[3, 0], whole[3, 3] = LOW_PASS, -LOW_PASS
    a = expm(whole * PERIOD)
    a[2, 2] = 0.0  # a set point acts from the next sample on
    ricatti = solve_discrete_are(a, b, np.diag([1e10, 1e4, 0, 0]), np.eye(1) * 10)
    k = np.linalg.solve(10 + b.T @ ricatti @ b, b.T @ ricatti @ a)
    spread = solve_discrete_are(a.T, c.T, np.diag([1e-12, 1e-3, 1e-8, 1e-14]), np.eye(1) * 1e-14)
    gain = a @ spread @ c.T / (c @ spread @ c.T + 1e-14)
    return {"A": a - b @ k - gain @ c, "L": gain, "K": k}


def in_file(folder: Path, data: Mapping[str, Any], name: str = "law.json") -> str:
    """The path of a JSON file with `data`."""
    plain = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in data.items()}
    (folder / name).write_text(json.dumps(plain))
    return str(folder / name)


def apart(one: Scene, other: Scene, in_process: bool = True) -> float:
    """How far two scenes' rotors are from each other at most, m."""
    (_, a, _), (_, b, _) = history(one, CENTRE), history(other, CENTRE, in_process)
    assert max(np.abs(a[name]).max() for name in CENTRE) > 10e-6
    return float(max(np.abs(a[name] - b[name]).max() for name in CENTRE))


def closed(loops: Loops, hertz: float, speed: float = SPEED) -> np.ndarray:
    """S at the sensors, all loops closed (axes, axes)."""
    return loops.closed(speed).balanced().sensitivity(np.array([2 * math.pi * hertz]))[0]


@pytest.mark.parametrize(
    ("loop", "duration"),
    [(Loop(eccentricity=10e-6), 0.03), (Loop(eccentricity=2e-6, off=2e-3, on=22e-3), 0.06)],
    ids=["levitated", "levitated again"],
)
def test_the_pid_as_a_file_gives_the_same_run(loop: Loop, duration: float, tmp_path: Path):
    scene = loop.scene(duration, 30e-6)
    assert apart(scene, scene.swap(controller=in_file(tmp_path, pid()))) < 1e-12


def test_also_as_an_fmu_and_as_forces(tmp_path: Path):
    """Of the scene's folder; the actuator takes either set point."""
    scene = Loop(eccentricity=10e-6).scene(10e-3, 50e-6)
    forces = in_file(tmp_path, pid(1 / K_I) | {"gives": "force"})
    swapped = scene.swap(controller=forces)
    assert apart(scene, swapped.set({"amb.command": "force"}), in_process=False) < 1e-12
    for command in ("current", "force"):
        loops = loops_of(swapped.set({"amb.command": command}))
        assert closed(loops, 56.0) == pytest.approx(closed(loops_of(scene), 56.0), rel=1e-9, abs=1e-9)


@pytest.mark.native
def test_also_as_a_native_fmu_which_holds_what_it_starts_with(tmp_path: Path):
    scene = Loop(eccentricity=10e-6).scene(10e-3, 50e-6)
    for data in (json.loads((ROOT / "examples" / "pid_law.json").read_text()), pid()):
        law = scene.swap(controller=in_file(tmp_path, data))
        assert apart(law, law.set({"controller.native": True}), in_process=False) == 0.0
    law = scene.swap(controller=str(ROOT / "examples" / "pid_law.json")).set({"controller.native": True})
    with pytest.raises(
        TouchdownError, match=r"no constants for sample_time = 0\.0001, method = 1, exact_at"
    ):
        history(law.set({"controller.method": "matched"}), CENTRE, in_process=False)


def test_an_lqg_as_a_file_gives_the_run_of_the_same_in_an_fmu_of_others(tmp_path: Path):
    law = lqg()
    arrays = {name: np.ravel(m).tolist() if name != "A" else m.tolist() for name, m in law.items()}
    script = LQG_SCRIPT + "".join(f"\n\n{name} = {value!r}" for name, value in arrays.items())
    (tmp_path / "lqg.py").write_text(script + "\n")
    FmuBuilder.build_FMU(tmp_path / "lqg.py", dest=tmp_path)
    scene = Loop(eccentricity=10e-6).scene(20e-3, 50e-6)
    names = read_names(ROOT / "examples" / "pid_controller.toml")
    theirs = scene.swap(controller=str(tmp_path / "Lqg.fmu")).with_names("controller", names)
    data = {"A": law["A"], "B": -law["L"], "C": -law["K"], "sample_time": PERIOD}
    ours = scene.swap(controller=in_file(tmp_path, data))
    assert apart(theirs.set({"controller.sampled": "100 us"}), ours) < 1e-12
    assert limit_warnings(ours) == []  # stable, by itself and with the rotor


def test_laws_are_settings_too(tmp_path: Path):
    """From the scene's folder, for sweeps; which files they are of belongs to the sweep."""
    scene = replace(Loop().scene(1e-3, 50e-6), folder=tmp_path)
    paths = [in_file(tmp_path, pid(), "a.json"), in_file(tmp_path, pid(d=1.5), "b.json")]
    assert scene.set({"controller.law": "b.json"}).components == scene.swap(controller=paths[1]).components
    design = Design(("controller.law",), (("a.json",), ("b.json",)), "two laws")
    found = define(scene, design, in_process=True)
    assert [str(value) for (value,) in found.values] == ["a.json", "b.json"]
    (tmp_path / "b.json").write_text(json.dumps(pid(d=2.0)))
    again = define(scene, design, in_process=True)
    assert {k for k, v in again.made_of.items() if v != found.made_of[k]} == {"b.json"}
    assert LAWS == ENDINGS


def test_margins_of_the_pid_as_a_file(tmp_path: Path):
    known, found = (
        loops_of(load_scene(DISK)),
        loops_of(load_scene(DISK).swap(controller=in_file(tmp_path, pid()))),
    )
    for hertz in (1.0, 56.0, 4500.0):
        assert closed(found, hertz) == pytest.approx(closed(known, hertz), rel=1e-9, abs=1e-9)
    slow = known.closed(0.0).poles
    assert np.sort_complex(found.closed(0.0).poles) == pytest.approx(np.sort_complex(slow), rel=1e-6)


def test_a_law_of_two_bearings_at_two_speeds(tmp_path: Path):
    """Of rotor I: C(z) in the middle is that of gains in the middle; it hears the rotor's speed."""
    scene = load_scene("rotor1-relevitated").set({"run.duration": "0.1 ms"})
    laws = [loops_of(scene.set({"controller_*.gain.derivative": kd})) for kd in (KD, 1.5 * KD)]
    matrices: dict[str, Any] = {}
    for name in "ABCD":
        ones = [getattr(one.laws.state_space, name) for one in laws if isinstance(one, Sampled)]
        matrices[name] = np.array(ones)
    path = in_file(tmp_path, matrices | {"speeds": [0, "18000 rpm"], "sample_time": PERIOD})
    parts = {k: v for k, v in scene.components.items() if k != "controller_B"}
    control = (("controller_A", "amb_A"), ("controller_A", "amb_B"))
    both = Scene(**{**vars(scene), "components": parts, "control": control}).swap(controller_A=path)
    found = loops_of(both)
    middle = loops_of(scene.set({"controller_*.gain.derivative": 1.25 * KD}))
    assert np.abs(closed(found, 200.0) - closed(laws[0], 200.0)).max() > 0.01
    for speed, expected in ((0.0, laws[0]), (SPEED, middle), (3 * SPEED, laws[1])):
        for hertz in (20.0, 200.0):
            wanted = closed(expected, hertz, speed)
            assert closed(found, hertz, speed) == pytest.approx(wanted, rel=1e-8, abs=1e-8)
    other_way = r"speeds from 0 to 1884\.96 rad/s, and the rotor's is -\d+\.\d+ rad/s; give the file speeds"
    with pytest.raises(TouchdownError, match=rf"^a controller by a file: its law is for {other_way}"):
        found.closed(-SPEED)
    for refused in (loops_of, lambda scene: history(scene, CENTRE)):
        with pytest.raises(TouchdownError, match=rf"controller_A: .*{other_way}"):
            refused(both.set({"rotor.speed": "-9000 rpm"}))
    scheduled = in_file(tmp_path, {"D": [[[1e4]], [[2e4]]], "speeds": [0, 1], "Ts": PERIOD})
    with pytest.raises(TouchdownError, match="controller_A has a law at several speeds; give all"):
        loops_of(scene.swap(controller_A=scheduled))
    with opened(both, in_process=True, listening=False) as system:
        system.initialise()
        assert system.value("controller_A.speed") == pytest.approx(SPEED)
        assert system.value("controller_A.axis[3].current_factor") > 1.0


def test_the_command_says_how_far_tustin_is_off(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    """A law in continuous time, of a scene whose file lies beside it; the PID of the same gains."""
    law = json.loads((ROOT / "examples" / "pid_law.json").read_text())
    assert law["sos"] == [[KP + KD * FILTER, KP * FILTER + KI, KI * FILTER, 1, FILTER, 0]]
    in_file(tmp_path, law, "own.json")
    scene = f'extends = "{DISK}"\n[components.controller]\nfmu = "own.json"\n'
    (tmp_path / "mine.toml").write_text(scene)
    words = ["amb-margins", str(tmp_path / "mine.toml"), "--speeds", "0 rpm", "-o", str(tmp_path / "loop")]
    assert main(words) == 0
    said = "C(z) is up to 5.4 % off C(s), at 2000 Hz, of frequencies up to 2000 Hz"
    assert said in capsys.readouterr().out
    assert main([*words, "--set", "controller.method=matched"]) == 0
    assert "C(z) is up to 5.8 % off C(s)" in capsys.readouterr().out
    assert limit_warnings(load_scene(str(tmp_path / "mine.toml"))) == [f"controller: {said}"]


def test_a_law_that_is_unstable_by_itself_is_run_and_told_of(tmp_path: Path):
    law = {name: np.array(value) for name, value in pid().items() if name in "ABCD"}
    law["A"] = np.block([[law["A"], np.zeros((3, 1))], [np.zeros((1, 3)), np.array([[1.1]])]])
    law["B"], law["C"] = np.vstack((law["B"], np.zeros(2))), np.hstack((law["C"], np.zeros((1, 1))))
    scene = Loop().scene(1e-3, 50e-6).swap(controller=in_file(tmp_path, law | {"sample_time": PERIOD}))
    assert "controller: its law is unstable by itself" in limit_warnings(scene)
    history(scene, CENTRE)


def test_another_sample_time_than_the_bearing_s_is_refused(tmp_path: Path):
    scene = Loop().scene(1e-3, 20e-6).set({"amb.sample_time": "80 us"})
    with pytest.raises(TouchdownError, match=r"0\.0001 s, and the magnetic bearing one of 8e-05 s"):
        history(scene.swap(controller=in_file(tmp_path, pid())), CENTRE)


def test_a_bearing_that_takes_no_samples_is_sampled_by_the_law_s_own_clock(tmp_path: Path):
    """At the ends of macro steps; a sample later, it acts as by an actuator's ticks of that time."""
    ticked = Loop(eccentricity=10e-6).scene(10e-3, 50e-6)
    own = ticked.swap(controller=in_file(tmp_path, pid())).set({"amb.sample_time": 0.0})
    _, found, _ = history(own, ["controller.samples"])
    assert found["controller.samples"][-1] == 100
    assert apart(ticked, own.set({"controller.delay": 1})) < 1e-12
    assert apart(ticked, own) > 0.5e-6
