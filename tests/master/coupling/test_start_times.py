"""Runs that start at another time than 0: what FMUs are told, what is recorded, and what stays the same."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pythonfmu import FmuBuilder
from systems import dropped, history, rotor_on

import touchdown
from touchdown.master.common.errors import TouchdownError
from touchdown.master.coupling.loop.span import brief, span
from touchdown.master.coupling.simulation import opened, simulate
from touchdown.master.results.recording import Recording
from touchdown.master.results.run import run_scene
from touchdown.master.scene.file import load_scene, parse_scene, read_resolved
from touchdown.master.scene.scene import Scene
from touchdown.reports.figures.style import beginning
from touchdown.reports.subject import Subject
from touchdown.reports.sweeps import report_on_sweep
from touchdown.studies.comparison import models, schemes
from touchdown.studies.comparison.engine import Options
from touchdown.studies.drop.impact_watch import MIN_SPAN, shortened
from touchdown.studies.drop.measured_drop import land, plan
from touchdown.studies.drop.monolithic import Monolith
from touchdown.studies.drop.reference import REFINED, refine

START, STEP = 10.0, 1e-3  # s
ROUGHLY = 1e-6  # of a drop's figures, which follow the last bits of its times
CLOCKED = '''
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Clocked(Fmi2Slave):
    """Tells the times that it is told."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.start = self.begin = self.end = -1.0
        for name in ("start", "begin", "end"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def setup_experiment(self, start_time, stop_time, tolerance):
        self.start = start_time

    def do_step(self, current_time, step_size):
        self.begin, self.end = current_time, current_time + step_size
        return True
'''


@pytest.fixture(scope="module")
def clocked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clocked")
    (folder / "clocked.py").write_text(CLOCKED)
    FmuBuilder.build_FMU(folder / "clocked.py", dest=folder)
    return folder / "Clocked.fmu"


def clock_of(fmu: Path, **run: object) -> Scene:
    """The FMU and nothing else, from START on."""
    given = {"start_time": START, "duration": 5 * STEP, "macro_step": STEP, "record_every": 1, **run}
    return parse_scene({"components": {"clock": {"fmu": str(fmu)}}, "run": given}, "clock", fmu.parent)


def disk(start: float = 0.0, **settings: object) -> Scene:
    """The disk from 1 ms before its shutdown until after the first impact."""
    scene = load_scene("disk-caged-simplified").set({"amb.shutdown_time": start + 1e-3})
    return scene.set({"run.duration": 9e-3, "run.start_time": start, **settings})


def test_components_are_told_the_time(clocked: Path, tmp_path: Path) -> None:
    """The start, each step's beginning; the recording has the time of the simulation's clock."""
    scene = clock_of(clocked)
    told: list[tuple[float, float]] = []
    with opened(scene) as system:
        outcome = simulate(
            scene, system, tmp_path / "result.h5", lambda time, share: told.append((time, share))
        )
    assert (outcome.start, outcome.steps, outcome.simulated) == (START, 5, pytest.approx(5 * STEP))
    assert told == [(pytest.approx(5 * STEP), 0.0)]  # of run.duration
    recording = Recording(tmp_path / "result.h5")
    expected = START + STEP * np.arange(6)
    assert np.array_equal(recording.time, expected)
    assert (recording["clock.start"] == START).all()
    assert np.array_equal(recording["clock.begin"][1:], expected[:-1])
    assert recording["clock.end"][1:] == pytest.approx(expected[1:], rel=1e-15)


def test_a_later_drop_has_the_same_figures(tmp_path: Path) -> None:
    """All times count from the shutdown; and the scene that a run leaves starts there again."""
    figures = [
        run_scene(disk(start), tmp_path / f"{start:g}", in_process=True).flat for start in (0.0, START)
    ]
    of_seat = ("first_contact_time", "first_contact_speed", "peak_contact_force", "loaded_balls_mean",
               "largest_displacement")  # fmt: skip
    for key in ("simulated_time", "macro_steps", *(f"seats.A.{key}" for key in of_seat)):
        assert figures[1][key] == pytest.approx(figures[0][key], rel=ROUGHLY), key
    assert read_resolved(tmp_path / "10" / "scene.json").run.start_time == START


def test_a_shutdown_before_the_start_is_over() -> None:
    """The rotor drops from the start; what is left of the duration is run."""
    scene = disk(1e-3, **{"amb.shutdown_time": 0.5e-3})
    _, values, outcome = history(scene, ["amb.active", "rotor.A.y"])
    assert (outcome.start, outcome.zero, outcome.end) == (1e-3, 0.5e-3, pytest.approx(9.5e-3))
    assert not values["amb.active"].any()
    assert values["rotor.A.y"][-1] < -2e-4


@pytest.mark.parametrize(
    ("settings", "line"),
    [
        ({"run.start_time": -1.0}, r"run\.start_time = -1\.0 must be at least 0 s"),
        ({"run.start_time": "soon"}, r"run\.start_time = 'soon'"),
        ({"run.start_time": 1.0},
         r"run\.start_time = 1 s is not before the run's end at t = 0\.01 s: run\.duration = 0\.009 s "
         r"counts from the scene's zero at t = 0\.001 s; set that later"),
        ({"run.start_time": 1e10, "amb.shutdown_time": 1e10},
         r"run\.start_time = 1e\+10 s is too late: beside it macro steps of 0\.0001 s are lost"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_one_line(settings: dict[str, object], line: str) -> None:
    with pytest.raises(TouchdownError, match=line) as refused:
        history(disk().set(settings), ["rotor.A.y"])
    assert "\n" not in str(refused.value)


def test_parts_of_steps_are_told_apart() -> None:
    """Where two bearings can hit a rotor; with one, or with nothing to be divided, later starts will do."""
    late = 2.0**26  # s, of which the next is 15 ns away
    held = {f"amb_{end}.shutdown_time": late for end in "AB"}
    with pytest.raises(TouchdownError, match=r"parts of macro steps, of run\.impact_step = 1e-06 s are"):
        history(dropped().set({"run.start_time": late, **held}), ["rotor.A.y"])
    run = disk(late, **{"run.macro_step": 2e-5}).run
    assert span(run, late).length == pytest.approx(run.duration)
    assert span(replace(run, impact_step=0.0), late, impacts=True).start == late


# -- what is drawn and compared ----------------------------------------------------------------------------


def test_pictures_begin_with_the_run() -> None:
    """Where that is later than 0, as in a scene that names no zero; else at 0."""
    assert beginning(np.array([10.0, 11.0])) == 10.0
    assert beginning(np.array([-1.0, 1.0])) == 0.0
    assert beginning(np.array([-1.0, -0.5])) == -1.0


def test_pictures_of_a_scene_without_a_zero(tmp_path: Path) -> None:
    scene = rotor_on("bushing", {"y": -0.25e-3}, duration=5e-3, start_time=START)
    result = touchdown.run(scene, tmp_path / "out", in_process=True, pictures=True)
    assert result.pictures
    assert result.plot.forces()[0].get_xlim()[0] >= START
    assert result.summary["seats"]["A"]["first_contact_time"] == pytest.approx(START, abs=5e-3)
    told = Subject(result)
    assert told.length == pytest.approx(5e-3)
    assert told.fall is not None
    assert 0.0 <= told.fall <= 5e-3


def test_sweeps_of_a_scene_without_a_zero_say_how_long_contacts_are(tmp_path: Path) -> None:
    """Each of its own start, before which there is nothing."""
    scene = rotor_on("bushing", {"y": -0.25e-3}, duration=5e-3)
    starts = {"run.start_time": [START, 2.0 * START]}
    sweep = touchdown.sweep(scene, starts, tmp_path / "sweep", jobs=1, in_process=True)
    (first, second) = (m.summary["seats"]["A"]["first_contact_time"] for m in sweep)
    assert second == pytest.approx(START + first)
    left = 1e3 * (START + 5e-3 - first)
    said = report_on_sweep(sweep).headline.replace("\N{NO-BREAK SPACE}", " ")
    assert f"followed for 5 ms from the shutdown on, {left:.3g} ms of it after the first contact:" in said


def test_references_begin_where_the_run_does() -> None:
    """The equations in one, and the refinement, at instants of the macro steps' own clock."""
    start = 0.25
    scene = disk(start)
    landing = land(scene, None)
    looks = plan(landing, (1e-4,))
    at = (looks.times + landing.zero - start) / 1e-4
    assert at == pytest.approx(np.round(at), abs=1e-6)
    assert (landing.start, math.isclose(landing.duration, landing.end)) == (start, True)
    ours = Monolith(scene).solve(looks.times[:20], ["rotor.A.y"], 1e-6, "DOP853").series["rotor.A.y"]
    finely = refine(scene, landing.seats, looks.times[:20], REFINED[1]).motion[:, 0, 1]
    assert ours[-1] < -1e-6
    assert ours == pytest.approx(finely, abs=1e-9)


def test_what_is_timed_is_warmed_up_from_the_start_on() -> None:
    """Where the zero lies before it, too: two macro steps from there would have been over."""
    scene = disk(1e-3, **{"amb.shutdown_time": 0.5e-3})
    with opened(scene, True) as system:
        assert simulate(brief(scene, system, 2), system).steps == 2
    asked = Options(("interface",), (1e-4,), duration=1e-3, repeat=1, in_process=True)
    found = models.compare(scene, asked, chosen=[])
    assert found.reference.first == pytest.approx(8.4e-3, abs=0.1e-3)  # it is held until the start
    assert schemes.compare(scene, asked).rows[0].wall is not None


def test_levitation_is_cut_short_from_the_start_on() -> None:
    scene = shortened(disk(START, **{"amb.shutdown_time": START + 1.0}))
    assert scene.components["amb"].set["shutdown_time"] == pytest.approx(START + MIN_SPAN)
