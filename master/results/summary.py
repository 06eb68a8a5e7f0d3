"""The summary of a run: every quantity of `master.quantities` that there is."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress

import numpy as np

from ...modelkit.variables import Causality
from ..common.errors import Ended
from ..coupling.connections import Attachment, housing_port
from ..coupling.ledger.auditor import estimated_by_master
from ..coupling.simulation import Outcome, energy_scale
from ..quantities import Owner, Summary, enter, quantities
from ..scene.requirements import refuse_unknown
from ..scene.scene import Scene
from .capture import add_captures, coils
from .clamped_pairs import pair_quantities
from .final_state import Finished, ReadableSystem
from .first_impact import latest, over_at, values_at
from .heat import heat_quantities
from .hold_up import add_hold_ups
from .least_gaps import add_gaps
from .mount_loads import mount_quantities
from .ratings import rating_quantities
from .recording import NotRecordedError, Recording
from .required import add_requirements
from .settling import Outlook, course, proposed, settled_at
from .spectra import hann
from .stresses import add_stresses
from .validity import add_validity
from .whirl.contacts import Orbit
from .whirl.verdict import Episode, WhirlVerdict, classify, force_phase

MIN_PROMINENCE = 5.0  # a line over the median of its band
NEVER = -1.0  # s, of a bearing's events that have not happened
LAST_PART = 0.2  # of a run, for means
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


def refuse_unknown_seats(scene: Scene, system: ReadableSystem) -> None:
    """Raise TouchdownError where a scene requires something of a seat that its system has not."""
    seats = touchdown_seats(system)
    refuse_unknown(scene.requirements, Owner.SEAT, [seat_name(a, seats) for a in seats])


def summarise(scene: Scene, system: ReadableSystem, outcome: Outcome, recording: Recording) -> Summary:
    """All quantities of a run; None where something did not happen or was too short to tell."""
    summary: Summary = {}
    completed = outcome.ended is Ended.COMPLETED
    enter(summary, {"scene": scene.name, "completed": completed, "ended": outcome.ended.value})
    if not completed:
        enter(summary, {"stopped_because": outcome.reason})
    run, seats = Finished(scene, system, recording), touchdown_seats(system)
    overs = [over_at(system, a.bearing, outcome.zero, recording) for a in seats]
    courses: dict[str, Outlook] = {}  # by the bearing's name
    for a, over in zip(seats, overs, strict=True):
        name = seat_name(a, seats)
        landing = _reported(system, a, outcome) | _face_landing(system, a, outcome)
        landing |= values_at(over, system, a.bearing, recording)
        enter(summary, {"bearing": a.bearing} | landing, Owner.SEAT, name)
        with suppress(NotRecordedError):
            outlook = course_at(system, a, recording, outcome.zero)
            courses |= {} if outlook is None else {a.bearing: outlook}
            enter(summary, _motion(system, a, outcome, recording, outlook), Owner.SEAT, name)
        strength = _strength(run, a) | mount_quantities(system, a, outcome.zero) | ball_inertias(system, a)
        strength |= pair_quantities(run, a)
        enter(summary, strength, Owner.SEAT, name)
    enter(summary, _settling(scene, courses, seats, recording))
    with suppress(NotRecordedError):
        add_captures(summary, system, recording, outcome.zero, {seat_name(a, seats): a for a in seats})
    held = holding_seats(system)
    for a in held:
        with suppress(NotRecordedError):
            enter(summary, _held(a, recording), Owner.SEAT, seat_name(a, held))
    enter(summary, coils(system))
    add_hold_ups(summary, system, outcome.zero)
    for a in {a.body: a for a in reversed(seats)}.values():
        speed = system.value(a.motion("omega")) if a.motion("omega") in system else None
        enter(summary, {"speed_end": speed}, Owner.COMPONENT, a.body)
    if by_master := [a.bearing for a in seats if is_estimated(system, a)]:
        enter(summary, {"contact_estimated_by_master": ", ".join(by_master)})
    add_gaps(summary, scene, recording)
    add_requirements(summary, scene.requirements)
    add_stresses(summary, system, outcome, latest(overs), recording)
    add_validity(summary, run, {seat_name(a, seats): a for a in seats})
    enter(summary, dict(outcome.coupling))
    enter(summary, _computation(scene, system, outcome, recording))
    return summary


def _face_landing(system: ReadableSystem, a: Attachment, outcome: Outcome) -> dict[str, object]:
    """Of a bearing with faces for a shoulder to land on: when, how fast and how hard it did."""
    gaps = [f"{a.bearing}.shoulder.gap_{side}" for side in ("minus", "plus")]
    if not all(name in system and f"{a.bearing}.shoulder.first_time" in system for name in gaps):
        return {}
    if all(system.value(name) <= 0.0 for name in gaps):
        return {}
    time, speed, force = (
        system.value(f"{a.bearing}.shoulder.{name}") for name in ("first_time", "first_speed", "peak_force")
    )
    found = (time - outcome.zero, speed, force) if time != NEVER else (None, None, None)
    return dict(zip(("face_landing_time", "face_landing_speed", "peak_face_force"), found, strict=True))


def ball_inertias(system: ReadableSystem, a: Attachment) -> dict[str, float]:
    """Of balls with a contact angle, whose centrifugal force is left out: its mean over the mean load."""
    share, angle = f"{a.bearing}.along.centrifugal", f"{a.bearing}.balls.contact_angle"
    if share not in system or angle not in system or system.value(angle) == 0.0:
        return {}
    if system.value(f"{a.bearing}.balls.centrifugal") == 1.0:
        return {}
    return {"ball_centrifugal_share": system.value(share)}


def _reported(system: ReadableSystem, a: Attachment, outcome: Outcome) -> dict[str, object]:
    """What a bearing reports of itself; None of contact where it was not touched."""
    component = system.components[a.bearing]
    values: dict[str, object] = {}
    times = [t for t in ("contact.first_time", "shoulder.first_time") if t in component.variables]
    bore, *_ = found = component.read(times)
    touched = any(time != NEVER for time in found)
    for one in quantities():
        if not one.variable or one.variable not in component.variables:
            continue
        value = component.read([one.variable])[0]
        if not touched or (one.bore and bore == NEVER) or (one.event and value == NEVER):
            values[one.key] = None
        else:
            values[one.key] = value - outcome.zero if one.event else value
    return values


def _held(a: Attachment, recording: Recording) -> dict[str, object]:
    """Of a bearing that holds its journal: the largest force, and the farthest way from the middle."""
    force, way = (np.hypot(*pair) for pair in course_of_held(a, recording))
    return {
        "bearing": a.bearing,
        "largest_journal_force": float(np.max(force)),
        "largest_journal_distance": float(np.max(way)),
    }


def course_of_held(a: Attachment, recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    """Force on the journal (N) and its displacement (m), each (2, rows): across and up."""
    force = np.array([recording[a.load(f"f{axis}")] for axis in "xy"])
    return force, np.array([recording[a.motion(axis)] for axis in "xy"])


def _strength(run: Finished, a: Attachment) -> dict[str, object]:
    """Of a bearing and its housing: pressure, safety, fatigue, heat, stroke.

    None stands for what was not recorded: no requirement is met by another bearing alone.
    """
    values = rating_quantities(run, a)
    port, heat = housing_port(run.system, a.bearing), f"{a.bearing}.energy.dissipated"
    if heat in run.recording:
        values["bearing_heat"] = float(run.recording[heat][-1] - run.recording[heat][0])
    elif heat in run.system:
        values["bearing_heat"] = None
    values |= heat_quantities(run, a)
    if (seized := values.get("seized_time")) is not None:
        values["bearing_ends_by"] = f"a seizure, at {seized:.3g} s in this drop"
    if port and f"{port}.x" in run.recording and f"{port}.y" in run.recording:
        x, y = (run.recording[f"{port}.{axis}"] for axis in "xy")
        # from where it started: it may be out of line
        values["housing_stroke"] = float(np.hypot(x - x[0], y - y[0]).max())
    elif port and f"{port}.x" in run.system:
        values["housing_stroke"] = None
    return values


def _motion(
    system: ReadableSystem, a: Attachment, outcome: Outcome, recording: Recording, outlook: Outlook | None
) -> dict[str, object]:
    """Of a journal's orbit: how far it went, how it whirls, swings and settles."""
    x, y = (recording[a.motion(axis)] for axis in "xy")
    time, values = recording.time, dict[str, object]()
    first = system.value(f"{a.bearing}.contact.first_time") - outcome.zero
    touched = first != NEVER - outcome.zero
    if touched and f"{a.bearing}.balls.loaded" in recording:
        run = outcome.end - max(outcome.zero, outcome.start)
        last = time >= outcome.end - outcome.zero - LAST_PART * run
        if last.any():  # a full disk ends a recording before its run
            values["loaded_balls_mean"] = float(np.mean(recording[f"{a.bearing}.balls.loaded"][last]))
    values["largest_displacement"] = None
    after = time > 0.0
    if after.any():
        start = int(np.argmax(time >= -1e-12))
        values["largest_displacement"] = float(np.max(np.hypot(x[after] - x[start], y[after] - y[start])))
    values["pendulum_frequency"] = None
    if touched and outlook is not None and outlook.whirl.verdict is WhirlVerdict.PENDULUM:
        rows = time >= first + 0.2 * (outcome.end - outcome.zero - first)
        values["pendulum_frequency"] = dominant_frequency(time[rows], x[rows])
    settling = outlook and outlook.settling
    values |= {"settling_time": settling and settling.time, "settled": settling and settling.words}
    return values | _whirl(system, a, recording, outlook)


def course_at(system: ReadableSystem, a: Attachment, recording: Recording, zero: float) -> Outlook | None:
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


def awaited(scene: Scene, courses: Mapping[str, Outlook]) -> list[Outlook]:
    """Of the seats that have to settle: all but the bushings of gaps that stayed open; by bearing."""
    bushings = scene.bushings
    return [one for bearing, one in courses.items() if one.settling is not None or bearing not in bushings]


def _settling(
    scene: Scene, courses: Mapping[str, Outlook], seats: Sequence[Attachment], recording: Recording
) -> dict[str, object]:
    """When the run ends, when all seats have settled, and how long it should be for that."""
    values: dict[str, object] = {"end_time": float(recording.time[-1])}
    if seats:
        whole = len(courses) == len(seats)
        values["settling_time"] = settled_at(awaited(scene, courses)) if whole else None
    return values | {"proposed_duration": proposed(list(courses.values()))}


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


def _whirl(
    system: ReadableSystem, a: Attachment, recording: Recording, outlook: Outlook | None
) -> dict[str, object]:
    """The verdict in words, the decisive whirl, and all; without a clearance nothing can be told."""
    values: Sequence[object] = [None] * len(WHIRL)
    if outlook is None:
        return dict(zip(WHIRL, values, strict=True))
    whirl = outlook.whirl
    force = _largest_force(a, whirl.decisive, recording) if whirl.decisive else None
    phase = _force_phase(system, a, whirl.decisive, recording) if whirl.decisive else None
    episodes = [_episode(system, a, episode, recording) for episode in whirl.episodes]
    values = (
        *(outlook.words, outlook.trend, whirl.revolutions, whirl.radius, whirl.frequency),
        *(force, phase, whirl.marched, episodes),
    )
    return dict(zip(WHIRL, values, strict=True))


WHIRL = (
    *("whirl", "whirl_trend", "whirl_revolutions", "whirl_radius", "whirl_frequency"),
    *("whirl_largest_force", "whirl_force_phase", "most_turns_one_way", "whirl_episodes"),
)


def _episode(
    system: ReadableSystem, a: Attachment, episode: Episode, recording: Recording
) -> dict[str, object]:
    """A whirl, in SI."""
    return {
        "direction": episode.direction.value,
        "start": episode.start,
        "end": episode.end,
        "revolutions": episode.revolutions,
        "frequency": episode.frequency,
        "radius": episode.radius,
        "largest_force": _largest_force(a, episode, recording),
        "force_phase": _force_phase(system, a, episode, recording),
        "goes_on": episode.goes_on,
    }


def _largest_force(a: Attachment, episode: Episode, recording: Recording) -> float | None:
    """Largest contact force in a whirl (N); None where the bearing does not report it.

    Between recorded values it may be larger: where the run's peak grew meanwhile, it is that.
    """
    force, peak = f"{a.bearing}.contact.force", f"{a.bearing}.contact.peak_force"
    if force not in recording or peak not in recording:
        return None
    part = (recording.time >= episode.start) & (recording.time <= episode.end)
    peaks = recording[peak][part]
    return float(peaks[-1] if peaks[-1] > peaks[0] else np.max(recording[force][part]))


def _force_phase(
    system: ReadableSystem, a: Attachment, episode: Episode, recording: Recording
) -> float | None:
    """By how much (rad) the force drives a whirl; None where it was not recorded with its friction."""
    force = _whole_force(a, recording)
    if force is None:
        return None
    clearance = system.value(f"{a.bearing}.clearance")
    orbit = Orbit(recording.time, *relative_orbit(system, a, recording), clearance)
    return force_phase(orbit, force, episode, _spin(a, recording))


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


def _computation(
    scene: Scene, system: ReadableSystem, outcome: Outcome, recording: Recording
) -> dict[str, object]:
    """Energies, steps and costs."""
    known = all(name in system for name in scene.energy_scale)
    scale = energy_scale(scene, system) if known else 0.0
    total = energy_total(system, recording)
    balance = None
    if total is not None and scale > 0.0:
        balance = float(np.max(np.abs(total - total[0])) / scale)
    simulated = outcome.simulated
    values: dict[str, object] = {
        "energy_residual_relative": outcome.residual if scale > 0.0 else None,
        "energy_residual_of_turnover": outcome.share,
        "energy_residual_worst_connection": outcome.worst,
        "energy_made_relative": outcome.made / scale if scale > 0.0 else None,
        "energy_made_of_turnover": outcome.made / outcome.turnover if outcome.turnover > 0.0 else None,
        "energy_made": outcome.made,
        "energy_turnover": outcome.turnover,
        "energy_made_inside_of_turnover": outcome.inside,
        "energy_made_inside_worst_bearing": outcome.worst_inside or None,
        "energy_made_in_system_of_turnover": outcome.in_system,
        "not_audited": "; ".join(outcome.unaudited) or None,
        "not_recorded": _not_recorded(scene, system, recording),
        "energy_balance_relative": balance,
        "energy_scale": scale if scale > 0.0 else None,
        "wall_time": outcome.wall_time,
        "start_up_time": outcome.start_up,
        "simulated_time": simulated,
        "wall_time_per_simulated_second": outcome.wall_time / simulated if simulated > 0.0 else None,
        "scheme": scene.run.scheme.name,
        "exchange": outcome.exchange,
        "macro_step": scene.run.macro_step,
        "macro_steps": outcome.steps,
    }
    if outcome.divided_in_impacts:
        values["macro_steps_divided_in_impacts"] = outcome.divided_in_impacts
    if outcome.shorter_steps:
        values["time_in_shorter_steps"] = sum(outcome.shorter_steps.values())
        values["shortest_macro_step"] = min(
            *outcome.shorter_steps, outcome.coupling.get("shortest_macro_step", math.inf)
        )
    return values
