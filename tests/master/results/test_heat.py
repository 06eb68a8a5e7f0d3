"""Heat, temperatures and gaps of bearings in a run's figures and in its report."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import touchdown
from touchdown.bearings import rating
from touchdown.master.common.errors import Ended
from touchdown.master.quantities import Group, Owner, enter, quantities
from touchdown.master.results import heat as results_heat
from touchdown.master.results import validity
from touchdown.master.results.final_state import Finished
from touchdown.master.results.heat import PARTS, runaway, seizure, warmed
from touchdown.master.results.recording import Recording
from touchdown.master.results.result import Result
from touchdown.master.results.summary import touchdown_seats
from touchdown.master.scene.requirements import Requirement
from touchdown.reports.chapters.bearings import run_up
from touchdown.reports.chapters.heat import heat
from touchdown.reports.chapters.summary import summary
from touchdown.reports.contents import CHAPTERS, section
from touchdown.reports.subject import Subject
from touchdown.validation.rings import seizing_scene

SPECIFIC = 460.0  # J/(kg K)


@pytest.fixture(scope="module")
def dropped() -> Result:
    """The first impacts of the disk."""
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "15 ms"})
    return touchdown.run(scene, in_process=True, pictures=False)


def said(result: Result) -> str:
    """The chapter on heat."""
    chapter = next(c for c in CHAPTERS if c.name == "heat")
    return section(chapter, Subject(result)).html


def number(result: Result, key: str) -> float:
    return result.summary["seats"]["A"][key]


def test_heat_by_part_is_all_heat(dropped: Result) -> None:
    parts = sum(number(dropped, f"bearing_heat_{part}") for part in PARTS)
    assert parts > 1e-3
    assert parts == pytest.approx(number(dropped, "bearing_heat"), rel=1e-12)
    assert number(dropped, "bearing_sliding_work") > 0.0


def test_without_conduction_a_ring_keeps_its_heat(dropped: Result) -> None:
    """By its mass and steel's specific heat; what flows off in milliseconds is little."""
    mass = dropped.ending.value("bearing.ring.mass")
    adiabatic = number(dropped, "temperature_rise_inner_adiabatic")
    assert adiabatic == pytest.approx(number(dropped, "bearing_heat_inner") / (mass * SPECIFIC), rel=1e-9)
    assert number(dropped, "temperature_rise_inner") == pytest.approx(adiabatic, rel=0.01)


def test_heat_stays_in_the_bearing_but_for_what_leaves(dropped: Result) -> None:
    """Of 15 ms next to nothing leaves: capacities times temperatures are the heat."""
    finished = Finished(dropped.scene, dropped.ending, dropped.recording)
    found = warmed(finished, touchdown_seats(finished.system)[0])
    assert found is not None
    housing = SPECIFIC / dropped.ending.value("bearing.housing.inv_m")
    kept = found.capacities @ found.warmth[-1, :4] + housing * found.warmth[-1, 4]
    assert kept == pytest.approx(number(dropped, "bearing_heat"), rel=2e-3)


def test_a_run_and_its_figures_know_the_same_surroundings() -> None:
    """A shaft of 80 K that leads well; a bearing's own temperatures are those a macro step before."""
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "12 ms", "bearing.thermal": 1})
    around = {"shaft_conductance": 200.0, "shaft_temperature": 80.0, "housing_temperature": 40.0}
    scene = scene.set({f"bearing.heat.{name}": value for name, value in around.items()})
    result = touchdown.run(scene, in_process=True, pictures=False)
    for part in PARTS:
        own = result.ending.value(f"bearing.temperature.{part}")
        assert own == pytest.approx(number(result, f"temperature_rise_{part}"), rel=0.01, abs=1e-6)
    assert 1.0 < result.ending.value("bearing.temperature.journal") < 80.0
    assert result.ending.value("bearing.temperature.housing") == pytest.approx(40.0, abs=0.01)


def test_a_bushing_has_heat_and_no_temperatures() -> None:
    scene = touchdown.load("disk-caged-simplified").swap(bearing="bushing").set({"run.duration": "12 ms"})
    result = touchdown.run(scene, in_process=True, pictures=False)
    assert number(result, "bearing_heat_inner") > 0.0
    assert not any("temperature" in path for path in result.flat)
    assert "<figure" not in said(result)
    assert "<p>Temperatures need a bearing with balls whose heat was recorded.</p>" in said(result)


TIME = np.linspace(0.0, 1.0, 401)


@pytest.mark.parametrize(
    ("rising", "begins"),
    [
        (np.exp(3.0 * TIME), np.log(7.0) / 3.0),  # where 2 um of preload are reached
        (20.0 * TIME, None),  # evenly, as by a drag that stays
        (20.0 * (1.0 - np.exp(-3.0 * TIME)), None),  # towards a steady state
        (20.0 * TIME + 40.0 * np.maximum(TIME - 0.5, 0.0), None),  # a whirl sets in, and stays
        (0.3 * np.exp(3.0 * TIME), None),  # too little to matter
    ],
)
def test_a_preload_that_grows_ever_faster_runs_away(rising: np.ndarray, begins: float | None) -> None:
    """Of 5 um of play, less what heat takes (um)."""
    found = runaway(TIME, 1e-6 * rising - 5e-6)
    assert found == (begins if begins is None else pytest.approx(begins, abs=TIME[1]))


@pytest.mark.parametrize("level", [9, 10, 11])
def test_a_preload_that_ends_just_below_a_level_is_judged(level: int) -> None:
    """By less than its logarithm shows; it begins to run away at 2 um, as without that level."""
    ends = np.nextafter(2e-6 * 1.25**level, 0.0)
    found = runaway(TIME, ends * np.exp(3.0 * (TIME - 1.0)))
    assert found == pytest.approx(1.0 - level * np.log(1.25) / 3.0, abs=TIME[1])


INERTIA = 2e-5  # kg m2
ROLLING = np.full(len(TIME), 2000.0)  # rad/s
ENOUGH = INERTIA * 2000.0**2  # J, twice what brings a ring from rest to that


def ramp(*points: tuple[float, float]) -> np.ndarray:
    """Over TIME, straight between (time, value)."""
    return np.interp(TIME, [time for time, _ in points], [value for _, value in points])


SPUN_UP = ((0.0, 0.0), (0.1, 1.0))  # and rolls from there on
SLIDES = ramp((0.0, 0.0), (0.1, 0.5), (0.4, 0.5), (1.0, 3.0))  # of ENOUGH: the journal, once it is let go
STOPS = ramp(*SPUN_UP, (0.4, 1.0), (0.6, 0.0))


@pytest.mark.parametrize(
    ("ring", "friction", "rolling"),
    [
        (ramp(*SPUN_UP), 0.5 * ramp(*SPUN_UP), ROLLING),  # rolls to the end
        (ramp((0.0, 0.0), (1.0, 0.98)), ramp((0.0, 0.0), (1.0, 5.0)), ROLLING),  # never did
        (STOPS, 0.5 * ramp(*SPUN_UP), ROLLING),  # coasts, as the rotor floats again
        # coasts in a long flight, and is spun up by the next impact, which does that work once more
        (ramp(*SPUN_UP, (0.2, 1.0), (0.7, 0.2), (0.8, 1.0)), ramp(*SPUN_UP, (0.7, 1.0), (0.8, 1.9)),
         ROLLING),
        (ramp(*SPUN_UP, (0.4, 1.0), (0.5, 0.7), (0.6, 1.0)), SLIDES, ROLLING),  # slips for a while
        (ramp(*SPUN_UP, (0.9, 0.0)), SLIDES, ROLLING * ramp((0.0, 1.0), (0.1, 1.0), (0.9, 0.0))),
    ],
    ids=["rolls", "never rolled", "floats", "bounces", "slips", "both come to rest"],
)  # fmt: skip
def test_a_ring_that_does_not_seize(ring: np.ndarray, friction: np.ndarray, rolling: np.ndarray) -> None:
    assert seizure(TIME, 2000.0 * ring, rolling, ENOUGH * friction, INERTIA) is None


@pytest.mark.parametrize(("sign", "every"), [(1.0, 1), (-1.0, 20)])
def test_a_ring_that_seizes(sign: float, every: int) -> None:
    """It falls evenly from 0.4 to 0.6 s, also seen in every twentieth row and turning the other way."""
    kept = slice(None, None, every)
    found = seizure(
        TIME[kept], sign * 2000.0 * STOPS[kept], sign * ROLLING[kept], ENOUGH * SLIDES[kept], INERTIA
    )
    assert found is not None
    assert found.stopped is not None
    row = every * TIME[1]
    assert found.time == pytest.approx(0.42, abs=row)
    assert found.stopped == pytest.approx(0.6, abs=row)
    assert found.sliding == pytest.approx(0.58, abs=row)
    assert found.fastest == pytest.approx(2000.0)


def test_a_ring_that_slips_again_and_goes_on_turning() -> None:
    """Down to a third of its speed: it seizes, and does not stand still."""
    slipping = ramp(*SPUN_UP, (0.4, 1.0), (0.6, 1.0 / 3.0))
    found = seizure(TIME, 2000.0 * slipping, ROLLING, ENOUGH * SLIDES, INERTIA)
    assert found is not None
    assert found.stopped is None
    assert found.share == pytest.approx(1.0 / 3.0)


def test_heat_that_closes_the_play_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """Bearings without play in a whirl that grows: half a micrometre of preload, ever faster."""
    monkeypatch.setattr(results_heat, "NOTED_PRELOAD", 1e-7)
    scene = touchdown.load("rotor1-18000-225um").set({"run.duration": "0.12 s", "bearing_*.thermal": 1})
    scene = scene.set({"run.macro_step": 4e-5})
    result = touchdown.run(scene, in_process=True, pictures=False)
    lines = [text for text in result.warnings if "heat closes its play ever faster" in text]
    assert [line.partition(":")[0] for line in lines] == ["bearing_A", "bearing_B"]
    (first, _) = (text for text in summary(Subject(result))["warnings"] if "heat closes" in text)
    assert first == f"At A {lines[0].partition(': ')[2]}.".replace(" um", "\N{NO-BREAK SPACE}µm")


@pytest.fixture(scope="module")
def seized() -> Result:
    """`touchdown validate ring-seizure`, with a limit of its temperature."""
    scene = replace(seizing_scene(), requirements=(Requirement("temperature", 50.0),))
    return touchdown.run(scene, in_process=True, pictures=False)


def test_a_seizure_is_in_the_figures(seized: Result) -> None:
    """In their order; as recorded, the ring keeps to the rotor before, and stands while the rotor turns."""
    synchronous, runs_away, time, stopped = (
        number(seized, f"{key}_time") for key in ("ring_sync", "runaway", "seized", "ring_stop")
    )
    assert 0.0 < synchronous < runs_away < time < stopped < seized.summary["end_time"]
    when, ring = seized.recording.time, seized.recording["bearing.ring.omega"]
    rolling = seized.recording["rotor.A.omega"] * 9.7 / 10.0
    assert np.all(ring[(when > 1.5 * synchronous) & (when < time)] > 0.89 * rolling[0])
    assert np.all(ring[when > stopped] < 0.02 * rolling[-1])
    assert seized.summary["seats"]["A"]["bearing_ends_by"].startswith("a seizure")
    hottest = max(number(seized, f"temperature_rise_{part}") for part in PARTS)
    assert number(seized, "largest_temperature_rise") == hottest > 50.0
    assert seized.summary["requirements_met"] is False


def test_figures_of_later_times_are_marked(seized: Result, dropped: Result) -> None:
    """In the summary, in tables, and in the headlines; preload makes the largest ball load later yet."""
    assert seized.summary["valid_until"] == number(seized, "seized_time")
    assert seized.summary["invalid_because"] == "the bearing at A seizes"
    late = seized.summary["invalid_figures"]
    assert {"seats.A.ring_stop_time", "seats.A.peak_ball_force"} <= {*late}
    known = "peak_contact_force", "seized_time", "first_contact_time", "bearing_ends_by", "bearing"
    assert not {f"seats.A.{key}" for key in known} & {*late}
    whole = "seats.A.largest_temperature_rise", "seats.A.whirl", "components.rotor.speed_end"
    assert {*whole, "requirements.temperature.margin", "requirements_met"} <= {*late}
    until = seized.summary["valid_until"]
    said = f"Figures are valid until {until:.4g} s after the shutdown; those of later times are marked."
    assert said in repr(seized)
    assert seized.headline.startswith("FAILS: the bearing at A seizes; largest temperature rise, ")
    assert said in seized.headline
    (line,) = (text for text in repr(seized).splitlines() if "ring stands still" in text)
    assert line.endswith(" (not valid)")
    (seat,) = Subject(seized).seats
    assert Subject(seized).cells(seat, ["ring_stop_time", "ring_sync_time"])[0].endswith(" (not valid)")
    assert dropped.summary["valid_until"] is None
    assert "invalid_figures" not in dropped.summary
    assert "valid" not in dropped.headline


def test_dented_races_end_what_is_valid(monkeypatch: pytest.MonkeyPatch, dropped: Result) -> None:
    """By a limit that the first impact exceeds: from there on, so that only later peaks are marked."""
    finished = Finished(dropped.scene, dropped.ending, dropped.recording)
    seats = {"A": touchdown_seats(finished.system)[0]}
    time, peak = dropped.recording.time, dropped.recording["bearing.balls.peak_force"]
    pressure = number(dropped, "largest_ball_pressure")
    monkeypatch.setattr(rating, "PRESSURE_LIMIT", 0.8 * pressure)
    summary = {"seats": {"A": dict(dropped.summary["seats"]["A"])}}
    validity.add_validity(summary, finished, seats)
    assert summary["valid_until"] == time[np.argmax(peak > 0.8**3 * peak[-1])] > 0.0
    assert "balls dent the races of the bearing at A" in summary["invalid_because"]
    assert {"seats.A.peak_ball_force", "seats.A.largest_ball_pressure"} <= {*summary["invalid_figures"]}
    monkeypatch.setattr(rating, "PRESSURE_LIMIT", 1.01 * pressure)
    validity.add_validity(summary, finished, seats)
    assert summary["valid_until"] is None


def test_a_figure_is_of_later_times_unless_known(dropped: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    """All quantities there are, with times after the end of what is valid, and no variable recorded."""
    finished = Finished(dropped.scene, dropped.ending, dropped.recording)
    monkeypatch.setattr(Recording, "__contains__", lambda recording, name: False)
    summary: dict[str, object] = {}
    names = {Owner.SEAT: "A", Owner.COMPONENT: "rotor", Owner.GAP: "seal", Owner.REQUIREMENT: "least_gap"}
    for one in quantities():
        name = names.get(one.owner, "")
        enter(summary, {one.key: "seal" if one.key == "least_gap_at" else 2.0}, one.owner, name)
    late = {*validity._later(summary, finished, {"A": touchdown_seats(finished.system)[0]}, 1.0)}
    facts = {Group.DROP, Group.NUMERICS}
    expected = {one.key for one in quantities() if one.group in facts} - {"speed_end"}
    items = [(path.rpartition(".")[2]) for path in late]
    assert {one.key for one in quantities()} - {*items} == expected | {"capture_command_time"}
    early = {*validity._later(summary, finished, {"A": touchdown_seats(finished.system)[0]}, 3.0)}
    told = {"first_contact_speed", "peak_bending_stress_node", "kept_shear_x", "least", "least_rotor_speed"}
    assert told <= {path.rpartition(".")[2] for path in late - early}
    assert "requirements.least_gap.margin" in late - early
    assert "requirements_met" in late - early


def test_play_and_clearance_are_used_up(dropped: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    """By spin as by heat; no play with a contact angle, nor where there was none at the start."""
    finished = Finished(dropped.scene, dropped.ending, dropped.recording)
    (seat,) = touchdown_seats(finished.system)
    time, read, first = dropped.recording.time, Recording.__getitem__, [3e-6]

    def closing(recording: Recording, name: str) -> np.ndarray:
        return np.linspace(first[0], -1e-6, len(time)) if ".gaps." in name else read(recording, name)

    monkeypatch.setattr(Recording, "__getitem__", closing)
    events = results_heat.heat_events(finished, seat, None)
    assert events.used_up == events.shut == time[time >= time[0] + 0.75 * (time[-1] - time[0])][0]
    with monkeypatch.context() as patched:
        patched.setattr(results_heat, "ANGLE", "clearance")  # as any angle, it is not 0
        assert results_heat.heat_events(finished, seat, None)[2:] == (None, 0.0, events.shut)
    first[0] = 0.0
    assert results_heat.heat_events(finished, seat, None)[2:] == (None, 0.0, None)


def test_the_heat_of_damping_seizes_no_ring(seized: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bore is as hot as before, but the journal hardly slides in it."""
    finished = Finished(seized.scene, seized.ending, seized.recording)
    (seat,) = touchdown_seats(finished.system)
    assert results_heat.heat_events(finished, seat, None).seizure is not None
    read = Recording.__getitem__

    def sparing(recording: Recording, name: str) -> np.ndarray:
        return read(recording, name) * (1e-4 if name.endswith(results_heat.WORK) else 1.0)

    monkeypatch.setattr(Recording, "__getitem__", sparing)
    assert results_heat.heat_events(finished, seat, None).seizure is None


def test_a_seizure_is_said_first(seized: Result) -> None:
    """In the warnings, in the headline before the verdict, beside the run-up, and in the chart."""
    (warning,) = (text for text in seized.warnings if "seizes at" in text)
    assert "no figure of later times is valid" in warning
    subject = Subject(seized)
    assert seized.headline.index("Figures are valid until") < seized.headline.index("No whirl")
    assert "until it seizes at" in run_up(subject)["rows"][0][1]
    chart = heat(subject)["temperatures"].chart
    assert [what for _, what in chart.events] == ["A runs away", "A seizes"]
    assert [t for t, _ in chart.events] == [number(seized, key) for key in ("runaway_time", "seized_time")]


def test_a_stopped_run_fails_by_what_came_before_where_its_ledger_closes(seized: Result) -> None:
    stopped = replace(seized, ended=Ended.STOPPED, stopped_because="A is too hot; cool it")
    assert stopped.headline.startswith("FAILS: the bearing at A seizes; ")
    assert stopped.headline.endswith(" The run stopped before its end: A is too hot.")
    wrong = replace(stopped, summary={**stopped.summary, "energy_made_of_turnover": 0.1})
    assert wrong.headline == "The run stopped before its end: A is too hot."


def test_the_ring_of_a_rotor_at_rest_rocks_and_does_not_seize() -> None:
    scene = touchdown.load("disk-caged-simplified").set({"rotor.speed": 0.0, "run.duration": "60 ms"})
    dropped = touchdown.run(scene, in_process=True)
    assert dropped.summary["seats"]["A"]["seized_time"] is None
    assert dropped.headline.startswith("No whirl")


def test_a_run_without_a_seizure_says_nothing(dropped: Result) -> None:
    keys = ("seized_time", "ring_stop_time", "runaway_time", "play_used_up_time")
    assert [dropped.summary["seats"]["A"][key] for key in keys] == [None] * 4
    assert not dropped.warnings
    assert "seizes" not in dropped.headline
