"""The figures of a run: flat, named with their units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from ...modelkit.variables import Causality
from ..common.errors import Ended
from ..coupling.connections import Attachment, housing_port
from ..coupling.ledger.auditor import estimated_by_master
from ..coupling.simulation import Outcome, energy_scale
from ..scene.scene import Scene
from .capture import capture_figures, coil_figures
from .final_state import Finished, ReadableSystem
from .first_impact import FIRST_IMPACT_PREFIX, Reported, latest, over_at, stresses_at, values_at
from .gaps import gap_figures
from .heat import SEIZED, heat_figures
from .mounts import mount_figures
from .ratings import rating_figures
from .recording import NotRecordedError, Recording
from .requirements import requirement_figures
from .settling import Course, course, proposed, settled_at
from .spectra import hann
from .stresses import stress_figures
from .whirl.contacts import Orbit
from .whirl.verdict import Episode, Verdict, classify, force_phase

MIN_PROMINENCE = 5.0  # a line over the median of its band
RPM = 60.0 / (2.0 * math.pi)


@dataclass(frozen=True)
class Figure(Reported):
    """One figure taken from a bearing's variable; `missing` marks "has not happened"."""

    from_zero: bool = False  # a time, counted from the scene's zero
    missing: float | None = None


FIGURES = (
    Figure("first_contact_time_s", "contact.first_time", from_zero=True, missing=-1.0),
    Figure("first_contact_speed_m_s", "contact.first_speed"),
    Figure("peak_contact_force_N", "contact.peak_force"),
    Figure("peak_indentation_rotor_ring_um", "contact.peak_indentation", 1e6),
    Figure("peak_indentation_rings_um", "balls.peak_indentation", 1e6),
    Figure("peak_indentation_ball_inner_um", "inner.peak_indentation", 1e6),
    Figure("peak_indentation_ball_outer_um", "outer.peak_indentation", 1e6),
    Figure("peak_indentation_ball_ball_um", "neighbours.peak_indentation", 1e6),
    Figure("peak_indentation_ball_cage_um", "pockets.peak_indentation", 1e6),
    Figure("peak_ball_force_N", "balls.peak_force"),
    Figure("first_impact_ball_force_N", "balls.first_impact_force"),
    Figure("peak_neighbour_force_N", "neighbours.peak_force"),
    Figure("peak_cage_force_N", "pockets.peak_force"),
    Figure("ring_sync_time_s", "ring.sync_time", from_zero=True, missing=-1.0),
    Figure("loaded_balls_end", "balls.loaded"),
)
FIRST_IMPACTS = tuple(  # what peaks were when it was over; of a ball's force the bearing tells by itself
    Figure(FIRST_IMPACT_PREFIX + figure.key.removeprefix("peak_"), figure.variable, figure.factor)
    for figure in FIGURES
    if figure.key.startswith("peak_") and figure.key != "peak_ball_force_N"
)
SPREAD = "spread"  # of figures over drops that start nanometres apart, where there are such
LAST_PART = 0.2  # of a run, for means
_DIVIDED = "macro_steps_divided_in_impacts"


ENERGIES = (
    ("energy.kinetic", 1.0),
    ("energy.potential", 1.0),
    ("energy.dissipated", 1.0),
    ("supplied", -1.0),
)


def touchdown_seats(system: ReadableSystem) -> list[Attachment]:
    """Attachments at which a journal can touch down, with the name of the bearing's report."""
    return [a for a in system.attachments if f"{a.bearing}.contact.first_time" in system and a.on_journal]


def holding_seats(system: ReadableSystem) -> list[Attachment]:
    """Where no bearing can be touched down in: attachments at which a journal is held all the time."""
    return [] if touchdown_seats(system) else [a for a in system.attachments if a.on_journal]


def is_estimated(system: ReadableSystem, a: Attachment) -> bool:
    """Whether it is the master that tells of contact in the bearing, which tells nothing of it."""
    return estimated_by_master(system.components[a.bearing].variables["contact.first_time"])


def seat_name(a: Attachment, seats: list[Attachment]) -> str:
    """The body's port, such as A; with the body's name where two bodies have a port of that name."""
    alone = [s.body_port for s in seats].count(a.body_port) == 1
    return a.body_port if alone else f"{a.body}_{a.body_port}"


def summarise(
    scene: Scene, system: ReadableSystem, outcome: Outcome, recording: Recording
) -> dict[str, object]:
    """All figures of a run; None where something did not happen or was too short to tell."""
    figures: dict[str, object] = {
        "scene": scene.name,
        "completed": outcome.ended is Ended.COMPLETED,
        "ended": outcome.ended.value,
    }
    if outcome.ended is not Ended.COMPLETED:
        figures["stopped_because"] = outcome.reason
    seats = touchdown_seats(system)
    overs = [over_at(system, a.bearing, outcome.zero, recording) for a in seats]
    courses: dict[str, Course] = {}  # by the bearing's name
    for a, over in zip(seats, overs, strict=True):
        tail = f"_{a.bearing}" if len(seats) > 1 else ""
        own = _bearing_figures(system, a, outcome) | _face_figures(system, a, outcome)
        own |= values_at(over, system, a.bearing, FIRST_IMPACTS, recording)
        figures |= {f"{key}{tail}": value for key, value in own.items()}
        with suppress(NotRecordedError):
            here = course_at(system, a, recording, outcome.zero)
            courses |= {} if here is None else {a.bearing: here}
            orbit = _orbit_figures(system, a, outcome, recording)
            settled = here and here.settling
            orbit |= {"settling_time_s": settled and settled.time, "settled": settled and settled.words}
            if here is None or here.whirl.verdict is not Verdict.PENDULUM:
                orbit |= {"pendulum_frequency_Hz": None}
            figures |= {f"{key}{tail}": value for key, value in orbit.items()}
            figures |= _whirl_figures(system, a, seat_name(a, seats), recording, here)
    figures |= _course_figures(scene, courses, len(seats), recording)
    with suppress(NotRecordedError):
        named = {seat_name(a, seats): a for a in seats}
        figures |= capture_figures(system, recording, outcome.zero, named, figures)
    held = holding_seats(system)
    for a in held:
        tail = f"_{a.bearing}" if len(held) > 1 else ""
        with suppress(NotRecordedError):
            figures |= {f"{key}{tail}": value for key, value in _held_figures(a, recording).items()}
    figures |= coil_figures(system)
    for name in dict.fromkeys(a.body for a in seats):
        tail = f"_{name}" if len({a.body for a in seats}) > 1 else ""
        seat = next(a for a in seats if a.body == name)
        speed = seat.motion("omega")
        figures[f"rotor_speed_end_rpm{tail}"] = RPM * system.value(speed) if speed in system else None
    if by_master := [a.bearing for a in seats if is_estimated(system, a)]:
        figures["contact_estimated_by_master"] = ", ".join(by_master)
    figures |= gap_figures(scene, recording)
    for a in seats:
        tail = f"_{a.bearing}" if len(seats) > 1 else ""
        own = _strain_figures(Finished(scene, system, recording), a) | mount_figures(
            system, a, outcome.zero
        )
        own |= angular_figures(system, a)
        figures |= {f"{key}{tail}": value for key, value in own.items()}
    figures |= requirement_figures(scene.requirements, figures)
    figures |= stress_figures(system, outcome) | stresses_at(latest(overs), system, recording)
    figures |= outcome.coupling
    figures |= _run_figures(scene, system, outcome, recording)
    infinite = [key for key, v in figures.items() if isinstance(v, float) and not math.isfinite(v)]
    return figures | dict.fromkeys(infinite)  # which JSON has not


OF_THE_BORE = ("contact.first_speed", "balls.first_impact_force")  # of the journal's first impact alone
CENTRIFUGAL = "ball_centrifugal_share"  # a figure's name; behind it, of several bearings, which
FACES = (  # of a shoulder's landing along the shaft
    Figure("face_landing_time_s", "shoulder.first_time", from_zero=True),
    Figure("face_landing_speed_m_s", "shoulder.first_speed"),
    Figure("peak_face_force_N", "shoulder.peak_force"),
)


def _face_figures(system: ReadableSystem, a: Attachment, outcome: Outcome) -> dict[str, object]:
    """Of a bearing with faces for a shoulder to land on: when, how fast and how hard it did."""
    values = {key: f"{a.bearing}.shoulder.{key}" for key in ("gap_minus", "gap_plus", "first_time")}
    if any(name not in system for name in values.values()):
        return {}
    if system.value(values["gap_minus"]) <= 0.0 and system.value(values["gap_plus"]) <= 0.0:
        return {}
    landed = system.value(values["first_time"]) != -1.0
    found: dict[str, object] = {}
    for figure in FACES:
        value = system.value(f"{a.bearing}.{figure.variable}")
        found[figure.key] = value - (outcome.zero if figure.from_zero else 0.0) if landed else None
    return found


def angular_figures(system: ReadableSystem, a: Attachment) -> dict[str, object]:
    """Of balls with a contact angle, whose centrifugal force is left out: its mean over the mean load."""
    share, angle = f"{a.bearing}.along.centrifugal", f"{a.bearing}.balls.contact_angle"
    if share not in system or angle not in system or system.value(angle) == 0.0:
        return {}
    return {CENTRIFUGAL: system.value(share)}


def _bearing_figures(system: ReadableSystem, a: Attachment, outcome: Outcome) -> dict[str, object]:
    component = system.components[a.bearing]
    figures: dict[str, object] = {}
    landed = "shoulder.first_time"
    times = ["contact.first_time", *([landed] if landed in component.variables else [])]
    bore, *_ = found = component.read(times)
    touched = any(time != -1.0 for time in found)
    for figure in FIGURES:
        if figure.variable not in component.variables:
            continue
        value = component.read([figure.variable])[0]
        of_bore = figure.variable in OF_THE_BORE and bore == -1.0
        if not touched or of_bore or (figure.missing is not None and value == figure.missing):
            figures[figure.key] = None
        elif isinstance(value, int):
            figures[figure.key] = value
        else:
            figures[figure.key] = figure.factor * (value - (outcome.zero if figure.from_zero else 0.0))
    return figures


def _held_figures(a: Attachment, recording: Recording) -> dict[str, object]:
    """Of a bearing that holds its journal: the largest force, and the farthest way from the middle."""
    force, way = (np.hypot(*pair) for pair in course_of_held(a, recording))
    return {
        "largest_journal_force_N": float(np.max(force)),
        "largest_displacement_um": 1e6 * float(np.max(way)),
    }


def course_of_held(a: Attachment, recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    """Force on the journal (N) and its displacement (m), each (2, rows): across and up."""
    force = np.array([recording[a.load(f"f{axis}")] for axis in "xy"])
    return force, np.array([recording[a.motion(axis)] for axis in "xy"])


def _strain_figures(run: Finished, a: Attachment) -> dict[str, object]:
    """Figures of a bearing and its housing: pressure, safety, fatigue, heat, stroke.

    What there is, but was not recorded, is None, so that no requirement is met by another bearing alone.
    """
    figures = rating_figures(run, a)
    port, heat = housing_port(run.system, a.bearing), f"{a.bearing}.energy.dissipated"
    if heat in run.recording:
        figures["bearing_heat_J"] = float(run.recording[heat][-1] - run.recording[heat][0])
    elif heat in run.system:
        figures["bearing_heat_J"] = None
    figures |= heat_figures(run, a)
    if (seized := figures.get(SEIZED)) is not None:
        figures["bearing_ends_by"] = f"a seizure, at {seized:.3g} s in this drop"
    if port and f"{port}.x" in run.recording and f"{port}.y" in run.recording:
        x, y = (
            run.recording[f"{port}.{axis}"] for axis in "xy"
        )  # from where it started: it may be out of line
        figures["housing_stroke_um"] = 1e6 * float(np.hypot(x - x[0], y - y[0]).max())
    elif port and f"{port}.x" in run.system:
        figures["housing_stroke_um"] = None
    return figures


def _orbit_figures(
    system: ReadableSystem, a: Attachment, outcome: Outcome, recording: Recording
) -> dict[str, object]:
    x = recording[a.motion("x")]
    y = recording[a.motion("y")]
    time = recording.time
    fall = None
    after = time > 0.0
    if after.any():
        start = int(np.argmax(time >= -1e-12))
        fall = 1e6 * float(np.max(np.hypot(x[after] - x[start], y[after] - y[start])))
    frequency = None
    touched = system.value(f"{a.bearing}.contact.first_time")
    if touched != -1.0:
        first = touched - outcome.zero
        settled = time >= first + 0.2 * (outcome.end - outcome.zero - first)
        frequency = dominant_frequency(time[settled], x[settled])
    loaded = None
    if touched != -1.0 and f"{a.bearing}.balls.loaded" in recording:
        run = outcome.end - max(outcome.zero, outcome.start)
        last = time >= outcome.end - outcome.zero - LAST_PART * run
        if last.any():  # a full disk ends a recording before its run
            loaded = float(np.mean(recording[f"{a.bearing}.balls.loaded"][last]))
    figures: dict[str, object] = {"largest_displacement_um": fall, "pendulum_frequency_Hz": frequency}
    return figures if loaded is None else {"loaded_balls_mean": loaded} | figures


def course_at(system: ReadableSystem, a: Attachment, recording: Recording, zero: float) -> Course | None:
    """The verdict at a seat with its time, and how it goes on; None where there can be none.

    zero: the scene's, s on the simulation's clock.
    """
    name = f"{a.bearing}.clearance"
    clearance = system.value(name) if name in system else 0.0
    if clearance <= 0.0:  # not stated, or heard to push from the start
        return None
    path = relative_orbit(system, a, recording)
    force = _force_on_journal(a, path, recording)
    whirl = classify(recording.time, *path, clearance, _spin(a, recording), force)
    touched = system.value(f"{a.bearing}.contact.first_time")
    first = None if touched == -1.0 else touched - zero
    return course(Orbit(recording.time, *path, clearance), force, whirl, first)


def awaited(scene: Scene, courses: Mapping[str, Course]) -> list[Course]:
    """Of the seats that have to settle: all but the bushings of gaps that stayed open; by bearing."""
    gaps = {gap.key for gap in scene.gaps if gap.acts}
    return [one for bearing, one in courses.items() if one.settling is not None or bearing not in gaps]


def _course_figures(
    scene: Scene, courses: Mapping[str, Course], seats: int, recording: Recording
) -> dict[str, object]:
    """When the run ends, when all seats have settled, and how long it should be for that."""
    whole = len(courses) == seats
    figures: dict[str, object] = {"end_time_s": float(recording.time[-1])}
    if seats > 1:
        figures["settling_time_s"] = settled_at(awaited(scene, courses)) if whole else None
    return figures | {"proposed_duration_s": proposed(list(courses.values()))}


def relative_orbit(
    system: ReadableSystem, a: Attachment, recording: Recording
) -> tuple[np.ndarray, np.ndarray]:
    """Journal's position relative to the housing's, the bearing's centre (m)."""
    port = housing_port(system, a.bearing)
    x, y = (recording[a.motion(axis)] - (recording[f"{port}.{axis}"] if port else 0.0) for axis in "xy")
    return x, y


def _spin(a: Attachment, recording: Recording) -> float:
    """Of the journal (rad/s), in the middle of what it is over the run."""
    return float(np.median(recording[a.motion("omega")]))


def _whole_force(a: Attachment, recording: Recording) -> tuple[np.ndarray, np.ndarray] | None:
    """The bearing's force on the journal (N), x and y; None where it was not recorded."""
    x, y = (a.load(f"f{axis}") for axis in "xy")
    return (recording[x], recording[y]) if x in recording and y in recording else None


def _force_on_journal(
    a: Attachment, orbit: tuple[np.ndarray, np.ndarray], recording: Recording
) -> tuple[np.ndarray, np.ndarray] | None:
    """The bearing's force on the journal (N), x and y, or its normal part alone; None where unknown."""
    normal = f"{a.bearing}.contact.force"
    whole = _whole_force(a, recording)
    if whole is not None:
        along = f"{a.bearing}.journal.fz"
        if along not in recording or not np.any(recording[along]):
            return whole
        # friction of the faces presses nothing into the bore
        touches = recording[normal] > 0.0 if normal in recording else np.ones(len(whole[0]), dtype=bool)
        return whole[0] * touches, whole[1] * touches
    if normal not in recording:
        return None
    angle = np.arctan2(orbit[1], orbit[0])
    return -recording[normal] * np.cos(angle), -recording[normal] * np.sin(angle)


def _whirl_figures(
    system: ReadableSystem, a: Attachment, seat: str, recording: Recording, here: Course | None
) -> dict[str, object]:
    """The verdict in words, the decisive whirl, and all; without a clearance nothing can be told."""
    key = f"whirl_{seat}"
    tails = (
        *("", "_trend", "_revolutions", "_radius_um", "_frequency_Hz", "_largest_force_N"),
        *("_force_phase_deg", "_most_turns_one_way", "_episodes"),
    )
    if here is None:
        return {f"{key}{tail}": None for tail in tails}
    whirl = here.whirl
    radius = None if whirl.radius is None else 1e6 * whirl.radius
    force = _largest_force(a, whirl.decisive, recording) if whirl.decisive else None
    phase = _force_phase(system, a, whirl.decisive, recording) if whirl.decisive else None
    episodes = [_episode_figures(system, a, episode, recording) for episode in whirl.episodes]
    values = (
        *(here.words, here.trend, whirl.revolutions, radius, whirl.frequency, force),
        *(phase, whirl.marched, episodes),
    )
    return {f"{key}{tail}": value for tail, value in zip(tails, values, strict=True)}


def _episode_figures(
    system: ReadableSystem, a: Attachment, episode: Episode, recording: Recording
) -> dict[str, object]:
    return {
        "direction": episode.direction.value,
        "from_s": episode.start,
        "to_s": episode.end,
        "revolutions": episode.revolutions,
        "frequency_Hz": episode.frequency,
        "radius_um": 1e6 * episode.radius,
        "largest_force_N": _largest_force(a, episode, recording),
        "force_phase_deg": _force_phase(system, a, episode, recording),
        "goes_on": episode.goes_on,
    }


def _largest_force(a: Attachment, episode: Episode, recording: Recording) -> float | None:
    """Largest contact force in a whirl (N); None where the bearing does not report it.

    Between recorded values it may be larger: where the run's peak grew meanwhile, it is that.
    """
    now, peak = f"{a.bearing}.contact.force", f"{a.bearing}.contact.peak_force"
    if now not in recording or peak not in recording:
        return None
    part = (recording.time >= episode.start) & (recording.time <= episode.end)
    peaks = recording[peak][part]
    return float(peaks[-1] if peaks[-1] > peaks[0] else np.max(recording[now][part]))


def _force_phase(
    system: ReadableSystem, a: Attachment, episode: Episode, recording: Recording
) -> float | None:
    """By how much (degrees) the force drives a whirl; None where it was not recorded with its friction."""
    force = _whole_force(a, recording)
    if force is None:
        return None
    clearance = system.value(f"{a.bearing}.clearance")
    orbit = Orbit(recording.time, *relative_orbit(system, a, recording), clearance)
    phase = force_phase(orbit, force, episode, _spin(a, recording))
    return None if phase is None else math.degrees(phase)


def dominant_frequency(
    time: np.ndarray, values: np.ndarray, low: float = 8.0, high: float = 100.0
) -> float | None:
    """Frequency of the largest line between `low` and `high` (Hz).

    None for less than four of its periods, or where no line stands out.
    Hann window, zero-padded, the maximum refined by a parabola through the logarithm of three lines.
    """
    if len(time) < 64:
        return None
    step = (time[-1] - time[0]) / (len(time) - 1)
    centred = values - np.mean(values)
    if not np.any(centred):
        return None
    count = 8 * len(centred)
    spectrum = np.abs(np.fft.rfft(centred * hann(len(centred)), count))
    frequency = np.fft.rfftfreq(count, step)
    band = np.flatnonzero((frequency >= low) & (frequency <= high))
    if len(band) < 3:
        return None
    peak = int(band[np.argmax(spectrum[band])])
    alone = spectrum[peak] > MIN_PROMINENCE * np.median(spectrum[band])
    if peak in (band[0], band[-1]) or not alone or frequency[peak] * (time[-1] - time[0]) < 4.0:
        return None
    a, b, c = np.log(spectrum[peak - 1 : peak + 2] + 1e-300)
    return float(frequency[peak] + 0.5 * (a - c) / (a - 2.0 * b + c) * frequency[1])


def energy_total(system: ReadableSystem, recording: Recording) -> np.ndarray | None:
    """Sum of all energies minus what was supplied (J); None where a component does not state its own."""
    attached = {name for a in system.attachments for name in (a.bearing, a.body)}
    stated = ("energy.kinetic", "supplied")
    if not all(any(s in system.components[n].variables for s in stated) for n in attached):
        return None
    parts = []
    for name, component in system.components.items():
        for variable, sign in ENERGIES:
            if variable in component.variables:
                if f"{name}.{variable}" not in recording:
                    return None
                parts.append(sign * recording[f"{name}.{variable}"])
    return np.sum(parts, axis=0) if parts else None


def _not_recorded(scene: Scene, system: ReadableSystem, recording: Recording) -> str | None:
    """Locals that are recorded on request only, counted; elements of arrays are always so."""
    if scene.run.record:
        return None
    recorded = {name for name, _ in recording.columns()}
    counts = {
        name: sum(
            v.causality is Causality.LOCAL and "[" not in v.name and f"{name}.{v.name}" not in recorded
            for v in component.variables.values()
        )
        for name, component in system.components.items()
    }
    left = [f"{count} of {name}" for name, count in counts.items() if count]
    return f"local variables, {', '.join(left)}; see run.record_also" if left else None


def _run_figures(
    scene: Scene, system: ReadableSystem, outcome: Outcome, recording: Recording
) -> dict[str, object]:
    known = all(name in system for name in scene.energy_scale)
    scale = energy_scale(scene, system) if known else 0.0
    total = energy_total(system, recording)
    balance = None
    if total is not None and scale > 0.0:
        balance = float(np.max(np.abs(total - total[0])) / scale)
    simulated = outcome.simulated
    return {
        "energy_residual_relative": outcome.residual if scale > 0.0 else None,
        "energy_residual_of_turnover": outcome.share,
        "energy_residual_worst_connection": outcome.worst,
        "energy_made_relative": outcome.made / scale if scale > 0.0 else None,
        "energy_made_of_turnover": outcome.made / outcome.turnover if outcome.turnover > 0.0 else None,
        "energy_made_J": outcome.made,
        "energy_turnover_J": outcome.turnover,
        "energy_made_inside_of_turnover": outcome.inside,
        "energy_made_inside_worst_bearing": outcome.worst_inside or None,
        "energy_made_in_system_of_turnover": outcome.in_system,
        "not_audited": "; ".join(outcome.unaudited) or None,
        "not_recorded": _not_recorded(scene, system, recording),
        "energy_balance_relative": balance,
        "energy_scale_J": scale if scale > 0.0 else None,
        "wall_time_s": outcome.wall_time,
        "start_up_s": outcome.start_up,
        "simulated_time_s": simulated,
        "wall_time_per_simulated_s": outcome.wall_time / simulated if simulated > 0.0 else None,
        "scheme": scene.run.scheme.name,
        "exchange": outcome.exchange,
        "macro_step_s": scene.run.macro_step,
        "macro_steps": outcome.steps,
        **({_DIVIDED: outcome.divided_in_impacts} if outcome.divided_in_impacts else {}),
        **{f"time_at_{1e6 * step:g}_us_s": time for step, time in sorted(outcome.shorter_steps.items())},
    }
