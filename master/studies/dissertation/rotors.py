"""Flexible rotors' drops beside the source: verdicts of Fig 14, stresses of Table 4, run-down of Fig 15.

Whether a rotor whirls is decided by little: so verdicts are counted over phases of the unbalance, never
taken from one run, and what the source leaves open is varied and named.
"""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.progress import UNSEEN, Progress
from touchdown.master.results.run import run_scene
from touchdown.master.results.spectra import lines as tallest
from touchdown.master.results.spectra import on_grid, waterfall
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.fig_14 import DURATION, fig_14
from touchdown.master.studies.sweep.report import Member
from touchdown.master.studies.sweep.sweep import Execution, sweep
from touchdown.master.studies.verdict.study import Plan

SEATS = ("A", "B")
NO_LIMIT = {"run.stop_residual": 1000.0}  # of a whirl, which moves joules where falling gives less

CONSTANT = {  # sustained sliding friction of 0.27
    f"bearing_{seat}.friction.{key}": value
    for seat in SEATS
    for key, value in (("kind", 0), ("static", 0.27), ("dynamic", 0.27))
}
ONE_SIDE = {f"housing_{seat}.x0": "100 um" for seat in SEATS}
DRAG = {f"bearing_{seat}.rolling.resistance": 0.06 for seat in SEATS}

COLUMNS = ("kept_bending_y_MPa", "kept_bending_x_MPa", "kept_shear_y_MPa", "kept_shear_x_MPa")
HEADERS = ("sigma_Y", "sigma_X", "tau_Y", "tau_X")


@dataclass(frozen=True)
class Case:
    """A row of Table 4, or a variant of it."""

    case: str
    reading: str
    settings: Mapping[str, object] = field(default_factory=dict)


SOURCE_4 = {  # MPa, and the verdict
    "1": (8.76, 2.28, 0.59, 0.16, "no whirl"),
    "2": (7.68, 1.85, 0.55, 0.13, "no whirl"),
    "3a": (15.37, 9.83, 1.11, 0.84, "whirl"),
    "3b": (103.82, 24.42, 7.34, 1.68, "whirl"),
}
TABLE_4 = (
    Case("1", "as stated"),
    Case("2", "as stated"),
    Case("3a", "as stated"),
    Case("3a", "friction 0.27 constant", CONSTANT),
    Case("3a", "both offsets on one side", ONE_SIDE),
    Case("3a", "both", {**CONSTANT, **ONE_SIDE}),
    Case("3b", "as stated"),
    Case("3b", "both", {**CONSTANT, **ONE_SIDE}),
    Case("3b", "both, and ring drag 0.06", {**CONSTANT, **ONE_SIDE, **DRAG}),
)


def phases(members: int) -> dict[str, list[str]]:
    """The ensemble: unbalance phases around the circle."""
    return {"rotor.unbalance_angle": [f"{360.0 * i / members:g} deg" for i in range(members)]}


def verdicts(ensemble: Sequence[Member]) -> str:
    """How often which verdict came, of the seat that whirls more."""
    counts: Counter[str] = Counter()
    for member in ensemble:
        if member.failed:
            counts[f"failed: {member.failed}"] += 1
            continue
        worst = max(SEATS, key=lambda seat: _turns(member.summary, seat))
        counts[str(member.summary[f"whirl_{worst}"])] += 1
    return ", ".join(f"{count} x {words}" for words, count in counts.most_common())


def _turns(summary: Mapping[str, object], seat: str) -> float:
    turns = summary.get(f"whirl_{seat}_revolutions")
    return float(turns) if isinstance(turns, (int, float)) else 0.0


def spread(ensemble: Sequence[Member], key: str) -> str:
    """Median, smallest and largest of a figure."""
    values = [float(v) for m in ensemble if isinstance(v := m.summary.get(key), (int, float))]
    if not values:
        return "-"
    return f"{statistics.median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


def table_4(members: int, folder: Path, jobs: int, done: Callable[[], object]) -> list[str]:
    """Stresses of rotor II when the vertical bending stress at node 4 peaks, and verdicts."""
    lines = []
    seen = ""
    for number, row in enumerate(TABLE_4, start=1):
        if row.case != seen:
            *values, verdict = SOURCE_4[row.case]
            numbers = "".join(f"{value:>26.4g}" for value in values)
            lines.append(f"{'case ' + row.case + ', source':<32}{numbers}   {verdict}")
            seen = row.case
        scene = load_scene(f"rotor2-case{row.case}").set({**row.settings, **NO_LIMIT})
        name = f"table4-{number}-case{row.case}"
        ensemble = sweep(scene, phases(members), folder / name, jobs, Execution(in_process=True), done)
        numbers = "".join(f"{spread(ensemble, key):>26}" for key in COLUMNS)
        lines.append(f"  {row.reading:<30}{numbers}   {verdicts(ensemble)}")
    return lines


def run_down(folder: Path) -> list[str]:
    """Rotor I over 16 s, and the tallest lines of its velocity at A in the first and the last 2 s."""
    result = run_scene(load_scene("rotor1-waterfall"), folder / "rotor1-waterfall")
    if result.ended is not Ended.COMPLETED:
        raise TouchdownError(f"rotor1-waterfall stopped: {result.stopped_because}")
    lines = [f"9000 to {result.summary['rotor_speed_end_rpm']:.0f} rpm in 16 s (source: 7780)"]
    recording = result.recording
    rows = on_grid(recording.time) & (recording.time >= -1e-9)
    spectrum = waterfall(recording.time[rows], recording["rotor.A.vx"][rows])
    for part, name in ((0, "first"), (-1, "last")):
        low, high = (
            ", ".join(f"{line:.1f}" for line, _ in tallest(spectrum[0], spectrum[2][part], *band))
            for band in ((20.0, 50.0, 3), (1300.0, 2000.0, 1))
        )
        lines.append(f"{name} 2 s: lines at {low} and {high} Hz (source: about 30, 40 and 1600)")
    return [*lines, f"spectra in {result.folder / 'waterfall-bearing_A.png'}"]


def runs(members: int) -> int:
    """How many drops Table 4 runs."""
    return members * len(TABLE_4)


def compare_rotors(
    members: int,
    plan: Plan,
    folder: Path,
    long: bool = False,
    jobs: int = 2,
    progress: Progress = UNSEEN,
) -> str:
    """Run everything and write rotors.txt into `folder`; returns the text.

    Fig 14 is counted over the phases that `plan` resolves, Table 4 over `members` of them. `long`: the
    run-down too. Ctrl-C in Fig 14 raises KeyboardInterrupt.
    """
    progress.planned(runs(members))
    lines = [
        f"Fig 14: rotor I on two cageless bearings, drops of {DURATION:g} s; phases of the unbalance",
        f"  {plan.spacing:g} deg apart, {plan.resolution:g} deg where neighbours' verdicts differ",
        *fig_14(plan, folder, jobs, progress),
        "  at 9000 rpm a whirl may die out (rolling resistance)",
        "",
        f"{members} unbalance phases per row: median (smallest to largest)",
        "",
        "Table 4: rotor II, largest along the rotor when the bending stress at node 4 peaks [MPa]",
        f"{'':<32}" + "".join(f"{header:>26}" for header in HEADERS),
        *table_4(members, folder, jobs, progress.done),
        "  cases 1 and 2 hinge on the rotor's geometry (a surrogate) and the contact's stiffness;",
        "  case 3 on friction that goes on sliding, on both bearings standing off to one side, and, for",
        "  the whirl to grow, on a drag on the inner ring",
    ]
    if long:
        lines += ["", "Fig 15: run-down of rotor I, its rolling resistance fitted to it", *run_down(folder)]
    text = "\n".join(lines) + "\n"
    (folder / "rotors.txt").write_text(text, encoding="utf-8")
    return text
