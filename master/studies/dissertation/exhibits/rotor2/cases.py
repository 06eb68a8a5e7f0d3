"""The cases of section 4.2, each as the source reads it."""

from __future__ import annotations

from touchdown.master.scene.file import load_scene
from touchdown.master.scene.scene import Scene
from touchdown.master.studies.dissertation.readings import ASSUMPTIONS, READINGS, SOURCE

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
