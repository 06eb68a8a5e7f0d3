"""The cases of section 4.2, each as the source reads it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from touchdown.master.results.result import Result
from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.dissertation.exhibits.exhibit import Row
from touchdown.master.studies.dissertation.exhibits.whirls import SETTLES, WHIRLS, verdict_row
from touchdown.master.studies.dissertation.readings import ASSUMPTIONS, READINGS, SOURCE

ASSUMED = "offsets, and in case 3b a drag, are assumed so that it does"
AS_PRINTED = "with the offsets, the friction and no drag as printed nothing whirls"
BELOW = " (below)"  # what `touchdown compare-rotors` prints there
CASES = tuple(SOURCE)  # "1", "2", "3a", "3b"
WHIRLING = {case: not SOURCE[case][-1].startswith("no") for case in CASES}


def as_read(case: str) -> Scene:
    """A case as the source reads it: what that assumes is in `notes`."""
    return load_scene(f"rotor2-case{case}").set(READINGS[case][0].settings)


def as_printed(case: str) -> Scene:
    """A case as the source states it, with what it leaves open as the scene has it."""
    return load_scene(f"rotor2-case{case}")


def notes() -> list[str]:
    """What the source's reading assumes, and why."""
    told = [f"{' '.join(a.about.split())}; because: {a.because.removesuffix(BELOW)}" for a in ASSUMPTIONS]
    return ["the rotor is a surrogate: the lengths and diameters of Fig 18 cannot be read", *told]


def reading_row(case: str, runs: Sequence[Result]) -> Row:
    """Whether a case whirls as the source reads it, over phases; with what was assumed so that it does."""
    row = verdict_row(f"case {case}, as the source reads: whirl", _source(case), runs)
    return replace(row, why=ASSUMED) if WHIRLING[case] else row


def printed_row(case: str, runs: Sequence[Result]) -> Row:
    """Whether it whirls as printed."""
    return verdict_row(f"case {case}, as printed: whirl", _source(case), runs, why=AS_PRINTED)


def _source(case: str) -> str:
    return WHIRLS if WHIRLING[case] else SETTLES
