"""Flexible rotors' drops beside the source: verdicts of Fig 14, stresses of Table 4, run-down of Fig 15.

Whether a rotor whirls is decided by little: so verdicts are counted over phases of the unbalance, never
taken from one run, and what the source leaves open is varied and named.
"""

from __future__ import annotations

from pathlib import Path

from ...master.common.errors import Ended, TouchdownError
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.results.run import run_scene
from ...master.results.spectra import lines as tallest
from ...master.results.spectra import on_grid, waterfall
from ...master.scene.file import load_scene
from ...modelkit.kernel.writing import write
from ...reports.figures.plot import draw_all
from ..verdict.study import Plan
from . import stress_readings
from .whirling_drops import DURATION, whirling_drops


def run_down(folder: Path) -> list[str]:
    """Rotor I over 16 s, and the tallest lines of its velocity at A in the first and the last 2 s."""
    result = run_scene(load_scene("rotor1-waterfall"), folder / "rotor1-waterfall", draw=draw_all)
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


def compare_rotors(
    members: int,
    plan: Plan,
    folder: Path,
    long: bool = False,
    jobs: int = 2,
    progress: Progress = SILENT_PROGRESS,
) -> str:
    """Run everything and write rotors.txt into `folder`; returns the text.

    Fig 14 is counted over the phases that `plan` resolves, Table 4 over `members` of them. `long`: the
    run-down too. Ctrl-C in Fig 14 raises KeyboardInterrupt.
    """
    progress.planned(stress_readings.runs(members))
    lines = [
        f"Fig 14: rotor I on two cageless bearings, drops of {DURATION:g} s; phases of the unbalance",
        f"  {plan.spacing:g} deg apart, {plan.resolution:g} deg where neighbours' verdicts differ",
        *whirling_drops(plan, folder, jobs, progress),
        "  at 9000 rpm a whirl may die out (rolling resistance)",
        "",
        f"{members} unbalance phases per row: median (smallest to largest)",
        "",
        "Table 4: stresses of rotor II [MPa]",
        *stress_readings.stress_readings(members, folder, jobs, progress.done),
    ]
    if long:
        lines += ["", "Fig 15: run-down of rotor I, its rolling resistance fitted to it", *run_down(folder)]
    text = "\n".join(lines) + "\n"
    write(folder / "rotors.txt", text)
    return text
