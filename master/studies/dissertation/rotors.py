"""Flexible rotors' drops beside the source: verdicts of Fig 14, stresses of Table 4, run-down of Fig 15.

Whether a rotor whirls is decided by little: so verdicts are counted over an ensemble of unbalance phases,
never taken from one run, and what the source leaves open is varied and named.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.run import run_scene
from touchdown.master.results.spectra import lines as tallest
from touchdown.master.results.spectra import on_grid, waterfall
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation import table_4
from touchdown.master.studies.dissertation.ensemble import NO_LIMIT, SEATS, numbers, phases, spread
from touchdown.master.studies.sweep.report import Member
from touchdown.master.studies.sweep.sweep import Execution, sweep

FIG_14 = {  # misalignment of each bearing [um]: the source's verdict
    0: "settles",
    75: "settles",
    150: "settles",
    225: "whirls",
}


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


def fig_14(members: int, folder: Path, jobs: int, done: Callable[[], object]) -> list[str]:
    """Verdicts of rotor I at both speeds for each misalignment."""
    lines = [
        f"{'rpm':>6} {'misalignment':>14}  {'source':<9} verdicts; revolutions at A, largest force at A [N]"
    ]
    for rpm in (9000, 18000):
        for offset, source in FIG_14.items():
            name = f"rotor1-{rpm}" + (f"-{offset}um" if offset else "")
            scene = load_scene(name).set({"run.duration": 0.5, **NO_LIMIT})
            ensemble = sweep(scene, phases(members), folder / name, jobs, Execution(in_process=True), done)
            drops = [member.summary for member in ensemble]
            turns, force = (
                spread(numbers(drops, key))
                for key in ("whirl_A_revolutions", "peak_contact_force_N_bearing_A")
            )
            lines.append(
                f"{rpm:>6} {f'+-{offset} um':>14}  {source:<9} {verdicts(ensemble)}; {turns}, {force}"
            )
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
    """How many drops `compare` runs, the run-down not counted."""
    return members * 2 * len(FIG_14) + table_4.runs(members)


def compare_rotors(
    members: int, folder: Path, long: bool = False, jobs: int = 2, done: Callable[[], object] = lambda: None
) -> str:
    """Run everything and write rotors.txt into `folder`; returns the text. `long`: the run-down too."""
    lines = [
        f"{members} unbalance phases per row: median (smallest to largest)",
        "",
        "Fig 14: rotor I on two cageless bearings, drops of 0.5 s",
        *fig_14(members, folder, jobs, done),
        "  +-150 um at 18000 rpm is near the edge; at 9000 rpm a whirl may die out (rolling resistance)",
        "",
        "Table 4: stresses of rotor II [MPa]",
        *table_4.table_4(members, folder, jobs, done),
    ]
    if long:
        lines += ["", "Fig 15: run-down of rotor I, its rolling resistance fitted to it", *run_down(folder)]
    text = "\n".join(lines) + "\n"
    (folder / "rotors.txt").write_text(text, encoding="utf-8")
    return text
