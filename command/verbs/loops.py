"""The verb for control loops: loop."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...master.common.errors import FAILED
from ...master.common.units import to_si
from .arguments import add_output, add_scene, chosen_scene
from .verb import Verb

LOOP_EXAMPLES = (
    "touchdown loop disk-caged-relevitated",
    'touchdown loop rotor1-relevitated --speeds "0 rpm, 9000 rpm, 18000 rpm" -o runs/loop',
    "touchdown loop disk-caged-relevitated --set controller.gain.derivative=8",
)


def _declare_loop(verb: argparse.ArgumentParser) -> None:
    add_scene(verb)
    add_output(verb, "runs/loop-SCENE")
    verb.add_argument(
        "--speeds",
        metavar="LIST",
        help='speeds of the rotor, such as "0 rpm, 9000 rpm" (default: up to 1.5 times the scene\'s)',
    )


def _execute_loop(options: argparse.Namespace) -> int:
    from ...studies.loop.report import report

    scene = chosen_scene(options)
    folder = options.output or Path("runs") / f"loop-{scene.name}"
    text, stable = report(scene, folder, _speeds(options.speeds))
    print(f"{text}\n\npicture in {folder}")
    return 0 if stable else FAILED


def _speeds(text: str | None) -> list[float]:
    """rad/s, with commas between them; none where not given. Raises TouchdownError."""
    from ...studies.sweep.design import listed

    if text is None:
        return []
    return [to_si(item, "rad/s", "--speeds") for item in listed(text, f"--speeds {text}")]


LOOP = Verb(
    "loop",
    "compute sensitivity, delay margin and poles of a scene's magnetic bearings",
    LOOP_EXAMPLES,
    _declare_loop,
    _execute_loop,
)
