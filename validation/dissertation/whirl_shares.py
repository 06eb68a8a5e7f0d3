"""Flexible rotors' drops beside the dissertation: whirling shares of Fig 14, readings of Table 4.

Whether a rotor whirls is decided by little, the phase of its unbalance for one: so what is counted is the
part of all phases that whirls, over phases that resolve the windows.
"""

from __future__ import annotations

from ...studies.sweep.report import with_interval
from ...studies.sweep.tasks import Running
from ...studies.verdict.study import Circle, Plan, strays, study_verdict, whirling_share, windows
from ...studies.verdict.verdict_report import newtons, reach, whirls_in_words
from ..case import Found, Row
from .drop_cache import Drops
from .rotor1 import SOURCE, SPEEDS, counted_row, scene_of
from .stress_readings import stress_readings

MEMBERS = 8  # unbalance phases behind a median
PLAN = Plan(12.0, 4.0)  # deg


def rotors(drops: Drops) -> Found:
    """Shares and windows of phases that whirl for each speed and misalignment; stresses of rotor II."""
    members = drops.members or MEMBERS
    rows: list[Row] = []
    for speed in SPEEDS:
        for offset, source in SOURCE.items():
            folder, running = drops.folder / f"{speed}-{offset}", Running(drops.jobs, in_process=True)
            study = study_verdict(scene_of(speed, offset), PLAN, folder, running, drops.progress)
            if study.interrupted:
                raise KeyboardInterrupt
            (circle,) = study.circles
            what = f"{speed} rpm, bearings off by -+{offset} um"
            count, every = sum(map(bool, circle.verdicts.values())), len(circle.verdicts)
            title = f"{what}: phases that whirl; largest force; windows"
            rows.append(counted_row(title, source, count, every, _found(circle)))
            rows += [
                Row(f"{what}, {phase:g} deg", "", None, "failed", why=why)
                for phase, why in circle.failed.items()
            ]
    notes = (
        f"Fig 14: phases {PLAN.spacing:g} deg apart, {PLAN.resolution:g} where neighbours differ",
        "at 9000 rpm a whirl may die out (rolling resistance)",
        f"Table 4: {members} unbalance phases per row, median (smallest to largest)",
    )
    lines = ["", "Table 4: stresses of rotor II [MPa]", *stress_readings(drops, members)]
    return Found(rows, None, notes, lines)


def _found(circle: Circle) -> str:
    """How much whirls, how hard, where and how."""
    verdicts = circle.verdicts
    if not verdicts:
        return "no run gave a verdict"
    force = circle.largest_force()
    parts = [with_interval(whirling_share(verdicts)), "-" if force is None else newtons(force)]
    parts += [f"{reach(window)}: {whirls_in_words(verdicts, window)}" for window in windows(verdicts)]
    if alone := strays(verdicts):
        parts.append(f"{len(alone)} strays")
    return "; ".join(parts)
