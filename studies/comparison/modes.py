"""The error that a number of modes of a flexible rotor costs, in the first impact of a drop.

Every number of modes runs without and with residual flexibility, with stresses by mode displacement and
by mode acceleration, against all modes of the finite elements at half the macro step. All modes at the
macro step of the others show what of an error is the coupling's.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ...master.common.errors import TouchdownError
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.coupling.simulation import opened, refuse_endless
from ...master.coupling.system import System
from ...master.scene.scene import Scene
from ..drop.impact_watch import AVERAGING_TIME, Stop, Trace, WatchedDrop, watched_drop
from .engine import Comparison, Measure, Options, Row, relative

STEP = 2e-6  # s; coupling errors stay a tenth of those of the modes
MAX_SPAN = 10e-3  # s after the first contact; later on, every difference is amplified
MAX_REFERENCE_RESIDUAL = 1e-2  # energy residual of a reference that can be trusted, over the energy scale
RIGID_MODES = 2
BASIS_PARAMETERS = ("modes", "residual", "stress.mode_acceleration")  # parameters of a flexible rotor
STRESSES = ("bending", "shear")
STRESS_METHODS = {"displacement": "displ. %", "acceleration": "accel. %"}
PEAKS = {  # their heads, titles and units
    "force": ("journal", "journal_force", "N"),
    "contact": ("contact", "contact_force", "N"),
    "indentation": ("", "indentation", "m"),
}


@dataclass(frozen=True)
class _Run:
    """Results of one run; stresses (Pa) are the largest along the rotor up to its end."""

    drop: WatchedDrop
    stresses: Mapping[str, float]
    frequency: float | None  # Hz, highest of the basis; None: rigid, or the seats are not told all

    def row(self, name: str, group: str, step: float, *runs: _Run) -> Row:
        """Errors of others against it, by mode displacement and by mode acceleration: one motion."""
        plain, exact = runs[0].drop, self.drop
        values = {"energy": plain.outcome.residual}
        errors = {"orbit": max(self._distance(seat, trace) for seat, trace in plain.traces.items())}
        if runs[0].frequency is not None:
            values["frequency"] = runs[0].frequency
        for seat, (_, end) in exact.impacts().items():
            peaks, exact_peaks = plain.traces[seat].peaks(end), exact.traces[seat].peaks(end)
            for kind in PEAKS:
                value = values[f"{kind} {seat}"] = getattr(peaks, kind)
                errors[f"{kind} error {seat}"] = relative(value, getattr(exact_peaks, kind))
        for way, run in zip(STRESS_METHODS, runs, strict=True):
            for kind in STRESSES:
                value = values[f"{kind} {way}"] = run.stresses[kind]
                errors[f"{kind} error {way}"] = relative(value, self.stresses[kind])
        wall = min(run.drop.outcome.wall_time / run.drop.outcome.simulated for run in runs)
        return Row(name, step, errors, wall, group=group, values=values)

    def _distance(self, seat: str, trace: Trace) -> float:
        """Largest distance of the journal from its own (m), from the first contact of any seat."""
        part = (trace.time >= self.drop.first) & (trace.time <= self.drop.end + 1e-12)
        apart = np.array([trace.x[part], trace.y[part]]) - self.drop.traces[seat].at(trace.time[part])
        return float(np.max(np.hypot(*apart)))

    def quantities(self) -> dict[str, Measure]:
        """The errors, then the values that are only in the file."""
        columns, filed = {}, {}

        def add(kind: str, owner: str, title: str, unit: str, head: tuple[str, ...]) -> None:
            columns[f"{kind} error {owner}"] = Measure(
                f"{title}_error_relative_{owner}", head, 100.0, "+.2f"
            )
            filed[f"{kind} {owner}"] = Measure(f"{title}_{unit}_{owner}")

        for kind, (short, title, unit) in PEAKS.items():
            for seat in self.drop.impacts():
                add(kind, seat, title, unit, (f"{short} {seat}", "force %") if short else ())
        columns["orbit"] = Measure("orbit_error_m", ("orbit", "um"), 1e6, ".3g")
        for kind in STRESSES:
            for way, short in STRESS_METHODS.items():
                add(kind, way, f"peak_{kind}", "Pa", (kind, short))
        columns["frequency"] = Measure("highest_frequency_Hz", ("highest", "Hz"), 1.0, ".0f")
        filed["energy"] = Measure("energy_residual_relative")
        return columns | filed


def compare(scene: Scene, options: Options, progress: Progress = SILENT_PROGRESS) -> Comparison:
    """Run `scene` in process with each number of modes, at the one macro step of the options or STEP.

    Looks at the duration from the first contact of any seat; without one, until the first impact is over at
    every seat, or MAX_SPAN. Raises TouchdownError where the scene has no flexible rotor, a number of modes
    cannot be, nothing touches, or a run stops.
    """
    rotor = _rotor(scene)
    step, *others = options.macro_steps or (STEP,)
    if others:
        raise TouchdownError("modes are compared at one macro step; give one alone")
    refuse_endless(options.duration or MAX_SPAN, step)
    scene = scene.set({"run.macro_step": step})
    with opened(_basis(scene, rotor, max(options.modes), 1, 1), in_process=True) as system:
        system.initialise()  # raises where the rotor has fewer modes, before anything runs for long
    whole = _basis(scene, rotor, 0, 0, 0)
    progress.planned(2 + 4 * len(options.modes))

    def run(basis: Scene, stop: Stop | None = None) -> _Run:
        found = _run(basis, rotor, stop)
        progress.done()
        return found

    span = MAX_SPAN if options.duration is None else options.duration
    stop = Stop(span, early=options.duration is None, every=2)
    exact = run(whole.set({"run.macro_step": 0.5 * step}), stop)
    exact.drop.impacts()  # raises where nothing touches, before all others run
    ended = {"run.duration": exact.drop.outcome.duration}
    again = run(whole.set(ended))
    rows = []
    for count in options.modes:
        for residual, basis in enumerate(("modes alone", "with residual flexibility")):
            ways = [run(_basis(scene, rotor, count, residual, a).set(ended)) for a in (0, 1)]
            rows.append(exact.row(f"{count}{' residual' * residual}", basis, step, *ways))
    coupling = exact.row("all, coupling", "all modes", step, again, again)
    beside = [coupling, exact.row("all, reference", "reference", 0.5 * step, exact, exact)]
    quantities, residual = exact.quantities(), exact.drop.outcome.residual
    doubt = (
        f"the energy residual of the reference is {residual:.2g} of the energy lost by falling; a smaller "
        "macro step makes it a better one"
    )
    return Comparison(
        "modes",
        f"{scene.title}: against all modes of the finite elements",
        list(_about(scene, exact.drop, beside[1], step)),
        rows,
        quantities,
        beside,
        exact,
        floors={key: abs(error) for key, error in coupling.errors.items()},
        drawn=[key for key, quantity in quantities.items() if quantity.head and key in coupling.errors],
        warnings=[doubt] if residual > MAX_REFERENCE_RESIDUAL else [],
    )


def mode_counts(modes: Iterable[object], where: str) -> tuple[int, ...]:
    """Numbers of modes, in order. Raises TouchdownError, its text begun by `where`, for other text."""
    counts: set[int] = set()
    for item in map(str, modes):
        try:
            number = int(item)
        except ValueError:
            raise TouchdownError(f"{where}: {item.strip() or 'nothing'!r} is not a whole number") from None
        if number < RIGID_MODES:
            raise TouchdownError(
                f"{where}: {number} is less than {RIGID_MODES}, the rigid modes per plane; "
                "all modes are the reference, which always runs"
            )
        counts.add(number)
    return tuple(sorted(counts))


def flexible_rotors(system: System) -> list[str]:
    """The components that are flexible rotors."""
    return [n for n, c in system.components.items() if all(v in c.variables for v in BASIS_PARAMETERS)]


def _rotor(scene: Scene) -> str:
    """The component that is a flexible rotor."""
    with opened(scene, in_process=True) as system:
        rotors = flexible_rotors(system)
    if not rotors:
        raise TouchdownError(
            f"scene {scene.name} has no flexible rotor with stresses: no component has the parameters "
            f"{', '.join(BASIS_PARAMETERS)}"
        )
    if len(rotors) > 1:
        raise TouchdownError(
            f"scene {scene.name} has several flexible rotors ({', '.join(rotors)}); modes are those of one"
        )
    return rotors[0]


def _basis(scene: Scene, rotor: str, modes: int, residual: int, acceleration: int) -> Scene:
    values = dict(zip(BASIS_PARAMETERS, (modes, residual, acceleration), strict=True))
    settings = {f"{rotor}.{name}": value for name, value in values.items()}
    return scene.set(settings | {f"{rotor}.stress.active": 1})


def _run(scene: Scene, rotor: str, stop: Stop | None = None) -> _Run:
    try:
        with watched_drop(scene, stop, rotor) as drop:
            stresses = {kind: drop.system.value(f"{rotor}.stress.peak_{kind}") for kind in STRESSES}
            return _Run(drop, stresses, _highest(drop, rotor))
    except TouchdownError as error:
        modes = scene.components[rotor].set["modes"]
        raise TouchdownError(f"with {modes or 'all'} modes: {error}") from None


def _highest(drop: WatchedDrop, rotor: str) -> float | None:
    """Highest frequency of the basis (Hz), from the modes that the seats are told of.

    None where there is none, or where modes may share the last place at a seat.
    """
    component, settings = drop.system.components[rotor], drop.scene.components[rotor].set
    squares = []
    elastic = int(str(settings["modes"])) - RIGID_MODES + int(str(settings["residual"])) * len(drop.seats)
    for port in dict.fromkeys(a.body_port for a in drop.seats):
        prefix = f"{port}.mode["
        names = [v for v in component.variables if v.startswith(prefix) and v.endswith(".k_over_m")]
        if settings["modes"] == 0 or elastic > len(names):
            return None
        squares += component.read(names)
    square = max(squares, default=0.0)
    return math.sqrt(square) / (2.0 * math.pi) if square > 0.0 else None


def _about(scene: Scene, drop: WatchedDrop, exact: Row, step: float) -> Iterator[str]:
    value = exact.values
    yield scene.title
    yield (
        f"reference: all modes of the finite elements, macro step {1e6 * (exact.step or 0.0):g} us, "
        f"energy residual {value['energy']:.2g} of the energy lost by falling"
    )
    for seat, (start, end) in drop.impacts().items():
        yield (
            f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, journal force "
            f"{value[f'force {seat}']:.5g} N over {1e6 * AVERAGING_TIME:g} us, contact force "
            f"{value[f'contact {seat}']:.5g} N, indentation {1e6 * value[f'indentation {seat}']:.4g} um"
        )
    bending, shear = (1e-6 * value[f"{kind} displacement"] for kind in STRESSES)
    yield (
        f"  bending {bending:.5g} MPa, shear {shear:.5g} MPa, "
        f"up to {1e3 * (drop.end - drop.first):.3g} ms after the first contact"
    )
    yield f"errors against it, macro step {1e6 * step:g} us; stresses by mode displacement and acceleration"
