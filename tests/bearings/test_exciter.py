"""A force on a rotor over time: momentum in closed form, and what levitated rotors answer."""

from __future__ import annotations

import cmath
import math

import levitation as lev
import numpy as np
import pytest
from systems import DISK, history

from touchdown.master.common.errors import TouchdownError
from touchdown.master.scene.run_spec import RunSpec, with_changes
from touchdown.master.scene.scene import ComponentSpec, Scene

BEGIN = 1.234e-3  # s, within a macro step
TABLE = {1: (0.0, 1.0), 2: (1.03e-3, -1.0), 3: (2.1e-3, 2.0)}
FREE = {"gravity": 0.0, "speed": 0.0}


def hit(course: dict[str, object], rotor: dict[str, object], duration: float, step: float = 5e-5) -> Scene:
    """A rigid rotor in space with an exciter at its touchdown bearing's seat."""
    components = {"rotor": ComponentSpec("rigid_rotor", rotor), "exciter": ComponentSpec("exciter", course)}
    run = with_changes(RunSpec(), {"duration": duration, "macro_step": step})
    return Scene("hit", "hit", components, attach=(("exciter.journal", "rotor.A"),), run=run)


@pytest.mark.parametrize(
    ("settings", "impulse"),
    [
        ({"course.form": "pulse", "course.width": 7.3e-4, "impulse_x": 0.5}, 0.5),
        ({"course.form": "pulse", "course.width": 7e-6, "impulse_x": 0.5}, 0.5),
        ({"course.form": "step", "force_x": 20.0}, 20.0 * (5e-3 - BEGIN)),
        (
            {"course.form": "lines", "force_x": 20.0, "course.lines.frequency": "100 Hz"},
            20.0 * math.sin(200.0 * math.pi * (5e-3 - BEGIN)) / (200.0 * math.pi),
        ),
        (
            {"course.form": "table", "force_x": 20.0, "course.points": 3}
            | {f"course.point[{k}].time": time for k, (time, _) in TABLE.items()}
            | {f"course.point[{k}].share": share for k, (_, share) in TABLE.items()},
            20.0 * 0.5 * (2.1e-3 - 1.03e-3),
        ),
    ],
)
def test_a_rotor_takes_the_impulse_to_rounding(settings: dict[str, object], impulse: float):
    scene = hit({"course.begin": BEGIN, **settings}, FREE, 5e-3)
    _, found, _ = history(scene, ["rotor.A.vx", "rotor.A.vy", "exciter.given_x"])
    assert DISK * found["rotor.A.vx"][-1] == pytest.approx(impulse, rel=1e-13)
    assert found["exciter.given_x"][-1] == pytest.approx(impulse, rel=1e-13)
    assert found["rotor.A.vy"][-1] == 0.0


def test_a_pulse_moves_the_rotor_as_from_its_middle():
    """J (t - begin - width/2)/m; to the tolerance of micro-steps."""
    course = {"course.begin": BEGIN, "course.width": 7.3e-4, "impulse_y": 0.5}
    _, found, _ = history(hit(course, FREE, 5e-3), ["rotor.A.y", "exciter.supplied"])
    assert found["exciter.supplied"][-1] == pytest.approx(0.5**2 / (2.0 * DISK), rel=1e-6)  # J^2/(2 m)
    way = 0.5 * (5e-3 - BEGIN - 0.5 * 7.3e-4) / DISK
    assert found["rotor.A.y"][-1] == pytest.approx(way, rel=1e-8)


def test_it_reacts_on_a_housing_that_it_stands_on():
    scene = hit({"course.width": 7.3e-4, "impulse_x": 0.5}, FREE, 2e-3)
    housing = ComponentSpec("housing", {"stiffness": 0.0, "damping": 0.0, "gravity": 0.0})
    attach = (*scene.attach, ("exciter.housing", "housing.seat"))
    both = Scene("hit", "hit", {**scene.components, "housing": housing}, attach=attach, run=scene.run)
    _, found, _ = history(both, ["rotor.A.vx", "housing.seat.vx"])
    assert 5.042 * found["housing.seat.vx"][-1] == pytest.approx(-0.5, rel=1e-6)
    assert DISK * found["rotor.A.vx"][-1] == pytest.approx(0.5, rel=1e-13)


def test_a_steady_sine_gives_the_compliance():
    """Of a mass on a spring and a damper, 1/(k - m omega^2 + i omega c), at twice its frequency or so."""
    omega, stiffness, damping = 2.0 * math.pi * 100.0, 2e5, 400.0
    course = {"course.form": "lines", "force_x": 2.0, "course.lines.frequency": omega}
    scene = hit(course, {"speed": 0.0}, 0.2, 2e-5)
    held = ComponentSpec("amb", {"stiffness": stiffness, "damping": damping, "shutdown_time": 1.0})
    attach = (*scene.attach, ("amb.journal", "rotor.amb"))
    levitated = Scene("hit", "hit", {**scene.components, "amb": held}, attach=attach, run=scene.run)
    times, found, _ = history(levitated, ["rotor.A.x"])
    turns = times > 0.15 + 1e-9
    answer = 2.0 * np.mean(found["rotor.A.x"][turns] * np.exp(-1j * omega * times[turns]))
    expected = 2.0 / complex(stiffness - DISK * omega**2, damping * omega)
    assert abs(answer - expected) < 1e-3 * abs(expected)
    assert abs(cmath.phase(expected)) > 1.0


def test_the_levitated_disk_answers_a_blow_as_the_linear_loop():
    """A blow of 2 us at a tick is a step of the velocity; positions at the ticks, of 13 nm.

    Both axes alike, as both have the same static load. The loop: `lev.from_sample_to_sample` and its PID.
    """
    impulse, ticks, first = 1e-5, 300, 10
    scene = lev.Loop().scene((first + ticks) * lev.PERIOD, lev.PERIOD / 4).swap(bearing="exciter")
    blow = {"course.begin": first * lev.PERIOD, "course.width": 2e-6, "impulse_y": impulse}
    scene = scene.set({f"bearing.{name}": value for name, value in blow.items()} | {"run.record_every": 1})
    _, found, _ = history(scene, ["rotor.A.y"])
    state, law, ahead = np.zeros(5), lev.Pid(0.0), lev.from_sample_to_sample(lev.PERIOD)
    state[1], asked, expected = impulse / lev.MASS / math.sqrt(2.0), 0.0, list[float]()
    for _ in range(ticks):
        state[4], asked = asked, law.answer(float(state[3]), 0.0)
        state = ahead @ state
        expected.append(state[0] * math.sqrt(2.0))
    seen = found["rotor.A.y"][3::4][first:]
    assert np.abs(expected).max() > 1e-8
    assert np.abs(seen - expected).max() < 2e-3 * np.abs(expected).max()


def test_points_that_are_not_in_order_are_refused():
    points = {"course.form": "table", "course.points": 2, "course.point[1].time": 1e-3}
    with pytest.raises(TouchdownError, match=r"course\.point\[2\]\.time = 0 s is not after"):
        history(hit({"force_x": 1.0, **points}, FREE, 5e-3), ["rotor.A.x"])
