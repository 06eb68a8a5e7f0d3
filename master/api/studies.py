"""Many runs: a sweep over settings, a comparison of schemes."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path

from tqdm.auto import tqdm

from touchdown.master.api import scenes
from touchdown.master.api.scenes import as_scene
from touchdown.master.common.units import to_si
from touchdown.master.scene.scene import Scene
from touchdown.master.scene.schemes import SCHEMES, scheme
from touchdown.master.studies.drop.levitation import shortened
from touchdown.master.studies.schemes import compare as schemes_study
from touchdown.master.studies.schemes.compare import STEPS, Asked, Comparison, pieces
from touchdown.master.studies.sweep import sweep as sweep_study
from touchdown.master.studies.sweep.report import Member
from touchdown.master.studies.sweep.sweep import Execution


def sweep(
    scene: scenes.Path | Scene,
    variations: Mapping[str, Sequence[object]],
    folder: scenes.Path | None = None,
    *,
    jobs: int = 2,
    in_process: bool = False,
    progress: bool = False,
) -> list[Member]:
    """Run a scene with every combination of the values that `variations` has for each setting.

    Each member has its `settings`, its `summary`, and in `failed` why it stopped, or nothing. `folder` gets
    sweep.csv and the summary of each member; without one nothing is left on disk. `jobs` run at a time, in
    processes of their own: a script needs `if __name__ == "__main__":` around it. Raises TouchdownError
    where a setting cannot be.

    >>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "8 ms"})
    >>> members = touchdown.sweep(scene, {"bearing.clearance": ["0.2 mm", "0.25 mm"]}, in_process=True)
    >>> [round(1e3 * member.summary["first_contact_time_s"], 1) for member in members]  # ms
    [6.5, 7.2]
    """
    total = sweep_study.size(variations)
    kept = tempfile.TemporaryDirectory(prefix="touchdown_") if folder is None else nullcontext(folder)
    with kept as where, tqdm(total=total, desc="runs", disable=not progress, leave=False) as bar:
        return sweep_study.sweep(
            as_scene(scene), variations, Path(where), jobs, Execution(in_process), bar.update
        )


def compare(
    scene: scenes.Path | Scene,
    schemes: Iterable[str] = (),
    macro_steps: Iterable[float | str] = STEPS,
    *,
    duration: float | str | None = None,
    in_process: bool = False,
    progress: bool = False,
) -> Comparison:
    """Speed against error: coupling schemes (none named: all) at macro steps (s) on one drop.

    Errors are those of the first impacts, or of `duration` (s) from the first contact, against two
    monolithic solutions; `rows` has them in SI, with the wall time, `recommended()` is the cheapest that is
    good enough. Raises TouchdownError where nothing touches.

    >>> comparison = touchdown.compare("disk-caged-simplified", ["hold"], ["100 us"], in_process=True)
    >>> 1e-6 < comparison.rows[0].errors["position"] < 1e-5  # m
    True
    """
    asked = Asked(
        schemes=tuple(scheme(name).name for name in schemes) or tuple(SCHEMES),
        steps=tuple(to_si(step, "s", "macro_steps") for step in macro_steps),
        duration=None if duration is None else to_si(duration, "s", "duration"),
        in_process=in_process,
    )
    chosen = shortened(as_scene(scene))
    with tqdm(total=pieces(chosen, asked), disable=not progress, leave=False) as bar:

        def begin(what: str) -> None:
            bar.set_description(what)
            bar.update()

        return schemes_study.compare_schemes(chosen, asked, begin)
