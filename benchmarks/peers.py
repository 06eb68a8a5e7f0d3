"""What other co-simulation tools cost on the same FMUs, and how far off they are.

The drops of tests/master/interop/peers at a macro step of 5 us: by this project's master with its default
scheme, and by libcosim, ecos, fmpy's SSP runner and cofmupy, which step all FMUs in parallel with loads
predicted one step ahead (scheme jacobi-lead). Cost is what is spent beyond the kernels, per FMU that is
stepped and macro step: processor time of all threads, and time on the wall. Errors are those against the
same drop at a macro step of 1 us. Each runs FMUs in Python and native ones. The tools are installed from
PyPI; ecos needs Debian's libtbb12.

    python benchmarks/peers.py [--repeat 7] [--falls disk,"rotor I"]
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time as clock
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

sys.path.extend(
    str(Path(__file__).resolve().parents[1] / part)
    for part in ("tests/support", "tests/master/interop/peers")
)

from drops import FALLS, Fall
from environments import REQUIREMENTS, Found, UnavailableError, run, title

from touchdown.master.components.in_process import InProcessComponent
from touchdown.master.coupling.observer import EveryStep, RunState
from touchdown.master.coupling.simulation import open_system, simulate
from touchdown.master.scene.scene import Scene

WARM_UP = 200  # macro steps before the clock starts
LEAD = "jacobi-lead"
OWN = "touchdown-cosim"
SLOW = ("fmpy", "cofmupy")  # run once


@dataclass
class Kernels:
    """What the compiled kernels take."""

    time: float  # us per macro step, of all components together
    stepped: float  # components per macro step


def kernels(scene: Scene, repeat: int, retire: bool) -> Kernels:
    """Of the scene's own motion; each call counts with its shortest time, as all runs are equal.

    Without `retire` components that have nothing left to do go on being stepped, as other tools do.
    """
    runs = []
    for _ in range(repeat):
        system = open_system(scene, in_process=True)
        if not retire:
            system.retire = lambda names: None  # type: ignore[method-assign]
        spent: list[float] = []
        for component in system.components.values():
            assert isinstance(component, InProcessComponent)
            instance = component.instance

            def step(time: float, size: float, instance=instance, spent=spent) -> None:
                began = clock.perf_counter()
                instance.advance(instance.words, instance.work, time, size)
                spent.append(clock.perf_counter() - began)

            component.step = step  # type: ignore[method-assign]
        steps = simulate(scene, system).steps
        runs.append(spent)
    return Kernels(1e6 * float(np.min(runs, axis=0).sum()) / steps, len(runs[0]) / steps)


def ours(fall: Fall, native: bool) -> Found:
    """The project's master through FMUs."""
    system = open_system(fall.scene.set({f"{name}.native": native for name in fall.scene.components}))
    marks: list[tuple[float, float]] = []

    def watch(_: RunState) -> None:
        nonlocal done
        done += 1
        if done == WARM_UP:
            marks.append((clock.perf_counter(), clock.process_time()))

    done = 0
    try:
        simulate(fall.scene, system, observers=[EveryStep(watch)])
        marks.append((clock.perf_counter(), clock.process_time()))
        wall, processor = (1e6 * (b - a) / (done - WARM_UP) for a, b in zip(*marks, strict=True))
        return Found({name: system.value(name) for name in fall.wanted}, wall, processor)
    finally:
        system.close()


def _package(fall: Fall, folder: Path, native: bool) -> Path:
    """The fall's package for other tools, with native FMUs or with ones in Python."""
    inside = folder / ("native" if native else "python")
    inside.mkdir(exist_ok=True)
    return fall.package(LEAD, inside, native)


def report(fall: Fall, repeat: int, folder: Path) -> None:
    """Print the fall's table."""
    exact, _ = Fall(fall.scene.set({"run.macro_step": 1e-6}), fall.journals, fall.bearings).ours()
    packages = {native: _package(fall, folder, native) for native in (False, True)}
    own = kernels(fall.scene, repeat, retire=True)
    parallel = kernels(fall.with_scheme(LEAD), repeat, retire=False)
    found: dict[str, list[Found]] = {}
    for k, native in product(range(repeat), packages):
        kind = ", native" if native else ""
        found.setdefault(f"{OWN}{kind}", []).append(ours(fall, native))
        for peer in REQUIREMENTS:
            if k > 0 and peer in SLOW:
                continue
            try:
                told = run(peer, packages[native], fall.wanted)
                found.setdefault(f"{title(peer)}{kind}", []).append(told)
            except UnavailableError as reason:
                print(f"{title(peer)} left out: {reason}")
    print(f"\n{fall.scene.name}, {len(fall.scene.components)} FMUs, median of {repeat} runs; kernels take")
    print(f"{own.time:.2f} us per macro step, {parallel.time:.2f} us with loads predicted")
    print(f"{'':<26}{'cost beyond the kernels':^30}{'error':^36}")
    print(f"{'tool':<26}{'processor':>16}{'wall':>14}{'journal':>13}{'peak force':>12}{'impact':>11}")
    for tool, runs in found.items():
        if not runs:
            continue
        base = own if tool.startswith(OWN) else parallel
        beyond = [
            (statistics.median(values) - base.time) / base.stepped
            for values in ([r.processor for r in runs], [r.wall for r in runs])
        ]
        error = fall.error(runs[0].values, exact)
        print(
            f"{tool:<26}{beyond[0]:>13.1f} us{beyond[1]:>11.1f} us{error.journal:>10.2g} um"
            f"{100 * error.peak:>10.2g} %{error.impact:>8.2g} us"
        )


def main() -> None:
    """Print one table for each drop."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=7)
    parser.add_argument("--falls", default=",".join(FALLS), help=f"of {', '.join(FALLS)}")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name in options.falls.split(","):
            report(FALLS[name](), options.repeat, Path(folder))


if __name__ == "__main__":
    main()
