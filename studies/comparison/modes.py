"""The error that a number of modes of a flexible rotor costs, in the first impact of a drop.

Every number of modes runs without and with residual flexibility, with stresses by mode displacement and
by mode acceleration, against all modes of the finite elements at half the macro step. All modes at the
macro step of the others show what of an error is the coupling's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...master.common.errors import TouchdownError
from ...master.components.component import Component
from ...master.coupling.simulation import opened, refuse_endless
from ...master.scene.scene import Scene
from ...reports.figures.style import BLUE, GREY, ORANGE
from ..drop.first_impact import AVERAGING_TIME, Peaks, Stop, Trace, WatchedDrop, watched_drop
from ..findings import Column, Findings, Record, label_errors, number, panel_grid, paragraphs, table

MODES = (3, 5, 8, 12, 20)  # per plane, the two rigid ones included
STEP = 2e-6  # s; coupling errors stay a tenth of those of the modes
MAX_SPAN = 10e-3  # s after the first contact; later on, every difference is amplified
MAX_REFERENCE_RESIDUAL = 1e-2  # energy residual of a reference that can be trusted, over the energy scale
RIGID_MODES = 2
BASIS_PARAMETERS = ("modes", "residual", "stress.mode_acceleration")  # parameters of a flexible rotor


@dataclass(frozen=True)
class Stresses:
    """Largest along the rotor up to the end of the run."""

    bending: float  # Pa
    shear: float  # Pa


@dataclass(frozen=True)
class Row:
    """One basis."""

    modes: int  # per plane; 0: all of the finite elements'
    residual: bool
    macro_step: float  # s
    seats: Mapping[str, Peaks]
    orbit: float  # m, largest distance of a journal from the reference's
    displacement: Stresses  # from the modes alone
    acceleration: Stresses  # and what the loads add
    frequency: float | None  # Hz, highest of the basis; None: rigid, or the seats are not told all
    wall: float  # s per simulated s
    energy: float  # residual of the ledger, over the scene's energy scale


@dataclass(frozen=True)
class Comparison:
    """All rows; errors are against the first."""

    scene: Scene
    end: float  # s from the scene's zero
    impacts: Mapping[str, tuple[float, float]]  # s from zero: the reference's first impact at each seat
    reference: Row
    coupling: Row  # all modes, at the macro step of the others
    rows: Sequence[Row]

    @property
    def first(self) -> float:
        """The first contact (s from zero)."""
        return min(start for start, _ in self.impacts.values())

    @property
    def warnings(self) -> list[str]:
        """Warnings about doubtful errors."""
        if self.reference.energy <= MAX_REFERENCE_RESIDUAL:
            return []
        return [
            f"the energy residual of the reference is {self.reference.energy:.2g} of the energy lost by "
            "falling; a smaller --macro-step makes it a better one"
        ]


@dataclass(frozen=True)
class Run:
    """Results of one run."""

    drop: WatchedDrop
    stresses: Stresses
    frequency: float | None


def parse_modes(text: str) -> tuple[int, ...]:
    """Numbers of modes from "3,5,8", in order. Raises TouchdownError."""
    numbers: set[int] = set()
    for item in text.split(","):
        try:
            number = int(item)
        except ValueError:
            raise TouchdownError(
                f"--modes {text}: {item.strip() or 'nothing'!r} is not a whole number"
            ) from None
        if number < RIGID_MODES:
            raise TouchdownError(
                f"--modes {text}: {number} is less than {RIGID_MODES}, the rigid modes per plane; "
                "all modes are the reference, which always runs"
            )
        numbers.add(number)
    return tuple(sorted(numbers))


def refuse_varied(names: Iterable[str]) -> None:
    """Raise TouchdownError for settings that the comparison makes itself."""
    instead = {
        "modes": "use --modes",
        "residual": "both ways are run",
        "stress.mode_acceleration": "both ways are run",
        "run.macro_step": "use --macro-step",
        "run.duration": "use --duration",
    }
    for name in names:
        for key in (name, name.partition(".")[2]):
            if key in instead:
                raise TouchdownError(f"--set {name}: compare-modes sets it itself; {instead[key]}")


def compare_modes(
    scene: Scene,
    modes: Sequence[int] = MODES,
    macro_step: float = STEP,
    duration: float | None = None,
    done: Callable[[], object] = lambda: None,
) -> Comparison:
    """Run `scene` in process with each number of modes; done() after each of `runs(modes)` runs.

    Looks at `duration` (s) from the first contact of any seat; without one, until the first impact is
    over at every seat, or MAX_SPAN. Raises TouchdownError where the scene has no flexible rotor, a number
    of modes cannot be, nothing touches, or a run stops.
    """
    rotor = _rotor(scene)
    refuse_endless(duration or MAX_SPAN, macro_step)
    scene = scene.set({"run.macro_step": macro_step})
    _check_modes(_basis(scene, rotor, max(modes), 1, 1))
    whole = _basis(scene, rotor, 0, 0, 0)
    stop = Stop(MAX_SPAN if duration is None else duration, early=duration is None, every=2)
    exact = _run(whole.set({"run.macro_step": 0.5 * macro_step}), rotor, stop)
    impacts = exact.drop.impacts()
    done()
    judge = _Judge(exact.drop, impacts)
    reference = judge.row(0, False, 0.5 * macro_step, exact, exact)
    ended = {"run.duration": exact.drop.outcome.duration}
    again = _run(whole.set(ended), rotor)
    done()
    rows = []
    for count in modes:
        for residual in (0, 1):
            ways = []  # the stresses by mode displacement, then by mode acceleration
            for acceleration in (0, 1):
                basis = _basis(scene, rotor, count, residual, acceleration)
                ways.append(_run(basis.set(ended), rotor))
                done()
            rows.append(judge.row(count, bool(residual), macro_step, *ways))
    coupling = judge.row(0, False, macro_step, again, again)
    return Comparison(scene, exact.drop.end, impacts, reference, coupling, rows)


def runs(modes: Sequence[int]) -> int:
    """How many runs a comparison takes."""
    return 2 + 4 * len(modes)


def _rotor(scene: Scene) -> str:
    """The component that is a flexible rotor."""
    with opened(scene, in_process=True) as system:
        rotors = [
            name for name, c in system.components.items() if all(v in c.variables for v in BASIS_PARAMETERS)
        ]
    if not rotors:
        raise TouchdownError(
            f"scene {scene.name} has no flexible rotor with stresses: no component has the parameters "
            f"{', '.join(BASIS_PARAMETERS)}"
        )
    if len(rotors) > 1:
        raise TouchdownError(
            f"scene {scene.name} has several flexible rotors ({', '.join(rotors)}); compare-modes takes one"
        )
    return rotors[0]


def _basis(scene: Scene, rotor: str, modes: int, residual: int, acceleration: int) -> Scene:
    values = dict(zip(BASIS_PARAMETERS, (modes, residual, acceleration), strict=True))
    settings = {f"{rotor}.{name}": value for name, value in values.items()}
    return scene.set(settings | {f"{rotor}.stress.active": 1})


def _check_modes(scene: Scene) -> None:
    """Raise TouchdownError where the rotor has fewer modes, before anything runs for long."""
    with opened(scene, in_process=True) as system:
        system.initialise()


def _run(scene: Scene, rotor: str, stop: Stop | None = None) -> Run:
    try:
        with watched_drop(scene, stop, rotor) as drop:
            peaks = [drop.system.value(f"{rotor}.stress.peak_{kind}") for kind in ("bending", "shear")]
            frequency = _highest(drop, rotor)
    except TouchdownError as error:
        given = scene.components[rotor].set
        which = f"{given['modes']} modes" if given["modes"] else "all modes"
        raise TouchdownError(f"with {which}: {error}") from None
    return Run(drop, Stresses(*peaks), frequency)


def _highest(drop: WatchedDrop, rotor: str) -> float | None:
    """Highest frequency of the basis (Hz), from the modes that the seats are told of.

    None where there is none, or where modes may share the last place at a seat.
    """
    component, given = drop.system.components[rotor], drop.scene.components[rotor].set
    by_port = {a.body_port: _mode_stiffness(component, a.body_port) for a in drop.seats}
    elastic = int(str(given["modes"])) - RIGID_MODES + int(str(given["residual"])) * len(drop.seats)
    if given["modes"] == 0 or any(elastic > len(values) for values in by_port.values()):
        return None
    square = max((value for values in by_port.values() for value in values), default=0.0)
    return math.sqrt(square) / (2.0 * math.pi) if square > 0.0 else None


def _mode_stiffness(component: Component, port: str) -> list[float]:
    names = [v for v in component.variables if v.startswith(f"{port}.mode[") and v.endswith(".k_over_m")]
    return component.read(names)


@dataclass(frozen=True)
class _Judge:
    """The reference, and over what its first impacts are compared."""

    exact: WatchedDrop
    impacts: Mapping[str, tuple[float, float]]

    def row(self, modes: int, residual: bool, step: float, plain: Run, corrected: Run) -> Row:
        """`plain`, `corrected`: by mode displacement and by mode acceleration; one motion."""
        traces, outcome = plain.drop.traces, plain.drop.outcome
        peaks = {seat: traces[seat].peaks(end) for seat, (_, end) in self.impacts.items()}
        orbit = max(self._distance(seat, trace) for seat, trace in traces.items())
        wall = min(run.drop.outcome.wall_time / run.drop.outcome.simulated for run in (plain, corrected))
        stresses = (plain.stresses, corrected.stresses)
        return Row(modes, residual, step, peaks, orbit, *stresses, plain.frequency, wall, outcome.residual)

    def _distance(self, seat: str, trace: Trace) -> float:
        """Largest distance of the journal from the reference's (m), from the first contact of any seat."""
        exact = self.exact.traces[seat]
        first = min(start for start, _ in self.impacts.values())
        part = (trace.time >= first) & (trace.time <= self.exact.end + 1e-12)
        time = trace.time[part]
        dx = trace.x[part] - np.interp(time, exact.time, exact.x)
        dy = trace.y[part] - np.interp(time, exact.time, exact.y)
        return float(np.max(np.hypot(dx, dy)))


def percent(value: float, exact: float) -> float:
    """Relative error; not a number where there is nothing to relate to."""
    return 100.0 * (value / exact - 1.0) if exact != 0.0 else math.nan


def stress_error(comparison: Comparison, row: Row, kind: str, way: str) -> float:
    """Error (%) of the peak of `kind`, one of STRESSES, found in one of STRESS_METHODS."""
    return percent(getattr(getattr(row, way), kind), getattr(comparison.reference.displacement, kind))


MIN_DRAWN_ERROR = 1e-4  # %, um; what an error of nothing is drawn as
BASES = ((False, BLUE, "modes alone"), (True, ORANGE, "with residual flexibility"))
STRESSES = ("bending", "shear")
STRESS_METHODS = {"displacement": "--", "acceleration": "-"}  # how they are drawn


def findings(comparison: Comparison) -> Findings:
    """The reference's figures, and a table of errors against it."""
    return Findings(
        paragraphs(_reference_lines(comparison), _table(comparison)),
        tables={"modes.csv": _records(comparison)},
        pictures={"modes.png": lambda: errors_over_modes(comparison)},
    )


@dataclass(frozen=True)
class Line:
    """One kind of error: its name, how it is drawn, and its value for a row."""

    label: str
    style: str
    error: Callable[[Row], float]


def errors_over_modes(comparison: Comparison) -> Figure:
    """Four panels: forces, orbit, bending and shear stress; grey: all modes, the coupling's error."""
    span, step = 1e3 * (comparison.end - comparison.first), 1e6 * comparison.coupling.macro_step
    title = (
        f"{comparison.scene.title}: errors against all modes of the finite elements\n"
        f"from the first contact to {span:.3g} ms after it, macro step {step:g} µs"
    )
    figure, panels = panel_grid(4, 6.0, 4.5, title)
    forces = [
        Line("journal, averaged", "-", lambda row: _worst(comparison, row, "force")),
        Line("contact, momentary", "--", lambda row: _worst(comparison, row, "contact")),
    ]
    _panel(panels[0], comparison, forces, "peak force of the first impact, worst seat", "error [%]")
    orbit = [Line("", "-", lambda row: 1e6 * row.orbit)]
    _panel(panels[1], comparison, orbit, "journal from the reference's, worst seat", "distance [µm]")
    for axes, kind in zip(panels[2:], STRESSES, strict=True):
        stresses = [
            Line(f"mode {way}", style, lambda row, k=kind, w=way: abs(stress_error(comparison, row, k, w)))
            for way, style in STRESS_METHODS.items()
        ]
        _panel(axes, comparison, stresses, f"peak {kind} stress", "error [%]")
    return figure


def _worst(comparison: Comparison, row: Row, name: str) -> float:
    exact = comparison.reference.seats
    return max(
        abs(percent(getattr(row.seats[s], name), getattr(exact[s], name))) for s in comparison.impacts
    )


def _panel(axes: Axes, comparison: Comparison, lines: Sequence[Line], title: str, label: str) -> None:
    for residual, colour, basis in BASES:
        rows = [row for row in comparison.rows if row.residual == residual]
        for line in lines:
            values = [max(line.error(row), MIN_DRAWN_ERROR) for row in rows]
            name = f"{line.label}, {basis}" if line.label else basis
            axes.plot([row.modes for row in rows], values, f"o{line.style}", color=colour, ms=4, label=name)
    for line in lines:
        name = "all modes at this macro step" if line is lines[0] else None
        floor = max(line.error(comparison.coupling), MIN_DRAWN_ERROR)
        axes.axhline(floor, color=GREY, ls=line.style, lw=0.8, label=name)
    label_errors(axes, "modes per plane, the two rigid ones included", label)
    axes.set_xticks(sorted({row.modes for row in comparison.rows}))
    axes.set_title(title)
    axes.legend(fontsize=8)


def _reference_lines(comparison: Comparison) -> Iterator[str]:
    exact = comparison.reference
    yield comparison.scene.title
    yield (
        f"reference: all modes of the finite elements, macro step {1e6 * exact.macro_step:g} us, "
        f"energy residual {exact.energy:.2g} of the energy lost by falling"
    )
    for seat, (start, end) in comparison.impacts.items():
        peaks = exact.seats[seat]
        yield (
            f"  {seat}: first impact {1e3 * start:.4g} to {1e3 * end:.4g} ms, journal force "
            f"{peaks.force:.5g} N over {1e6 * AVERAGING_TIME:g} us, contact force {peaks.contact:.5g} N, "
            f"indentation {1e6 * peaks.indentation:.4g} um"
        )
    stresses = exact.displacement
    yield (
        f"  bending {1e-6 * stresses.bending:.5g} MPa, shear {1e-6 * stresses.shear:.5g} MPa, "
        f"up to {1e3 * (comparison.end - comparison.first):.3g} ms after the first contact"
    )


def _table(comparison: Comparison) -> list[str]:
    exact, coupling = comparison.reference, comparison.coupling
    columns = [
        Column[Row](
            (f"{title} {seat}", "force %"),
            lambda row, s=seat, f=figure: format(
                percent(getattr(row.seats[s], f), getattr(exact.seats[s], f)), "+.2f"
            ),
        )
        for title, figure in (("journal", "force"), ("contact", "contact"))
        for seat in comparison.impacts
    ]
    columns.append(Column(("orbit", "um"), lambda row: f"{1e6 * row.orbit:.3g}"))
    columns += [
        Column[Row](
            (kind, f"{short} %"),
            lambda row, k=kind, w=way: format(stress_error(comparison, row, k, w), "+.2f"),
        )
        for kind in STRESSES
        for way, short in zip(STRESS_METHODS, ("displ.", "accel."), strict=True)
    ]
    columns.append(Column(("highest", "Hz"), lambda row: number(row.frequency, ".0f")))
    columns.append(Column(("wall/", "simulated"), lambda row: f"{row.wall:.3g}"))
    label = Column[Row](
        ("", "modes"),
        lambda row: f"{row.modes or 'all':>5}{_basis_label(row, row is coupling):<11}",
    )
    step = 1e6 * coupling.macro_step
    return [
        f"errors against it, macro step {step:g} us; stresses by mode displacement and acceleration",
        *table(label, columns, [*comparison.rows, coupling]),
    ]


def _basis_label(row: Row, coupling: bool) -> str:
    return "  coupling" if coupling else "  residual" if row.residual else ""


def _records(comparison: Comparison) -> Iterator[Record]:
    """All figures and errors of all rows, in full precision."""
    yield _record(comparison, "reference", comparison.reference)
    yield _record(comparison, "coupling", comparison.coupling)
    for row in comparison.rows:
        yield _record(comparison, "modes", row)


def _record(comparison: Comparison, role: str, row: Row) -> Record:
    cells: dict[str, object] = {
        "run": role,
        "modes": row.modes or "all",
        "residual": int(row.residual),
        "macro_step_s": row.macro_step,
    }
    for seat in comparison.impacts:
        now, exact = row.seats[seat], comparison.reference.seats[seat]
        for name, unit, factor in (("force", "N", 1.0), ("contact", "N", 1.0), ("indentation", "um", 1e6)):
            title = {"force": "journal_force", "contact": "contact_force"}.get(name, name)
            value, right = getattr(now, name), getattr(exact, name)
            cells[f"{title}_{unit}_{seat}"] = factor * value
            cells[f"{title}_error_percent_{seat}"] = percent(value, right)
    cells["orbit_error_um"] = 1e6 * row.orbit
    for kind in STRESSES:
        for way in STRESS_METHODS:
            cells[f"peak_{kind}_MPa_{way}"] = 1e-6 * getattr(getattr(row, way), kind)
            cells[f"peak_{kind}_error_percent_{way}"] = stress_error(comparison, row, kind, way)
    cells["highest_frequency_Hz"] = row.frequency
    cells["wall_time_per_simulated_s"] = row.wall
    cells["energy_residual_relative"] = row.energy
    return cells
