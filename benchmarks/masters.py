"""Co-simulation masters on the same FMUs: error, energy, longest stable step, number of doSteps.

    python benchmarks/masters.py [--problems car,bounce] [--tools libcosim,ecos] [--quick] [-o runs/masters]

Four systems: two masses on springs that are shot at each other, a quarter car that meets a step of the road, a
ball on an undamped one-sided spring (FMUs in C, compiled for it), and a shipped scene, the disk that falls onto
a touchdown bearing. Every scheme of this project, and libcosim with fixed steps and with its energy-based
step control, ecos, fmpy's SSP runner and cofmupy, which are installed from PyPI into environments of their own; ecos
needs Debian's libtbb12. One table for each system, and one picture. The step control has the parameters of
libcosimpy's own test of a quarter car, but may take steps from 1 us to the longest that the others are asked
for; its tolerances, absolute and relative, are what is varied.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TextIO

sys.path.extend(
    str(Path(__file__).resolve().parents[1] / part)
    for part in (
        "benchmarks",
        "tests/support",
        "tests/master/coupling/bonds",
        "tests/master/interop/peers",
    )
)

import bodies
from cosimulated import comparison
from cosimulated.comparison import Result
from cosimulated.masters.others import Controlled, Other
from cosimulated.masters.own import Own
from cosimulated.picture import draw
from cosimulated.problems.bounce import Bounce
from cosimulated.problems.car import Car
from cosimulated.problems.drop import Drop
from cosimulated.problems.oscillator import Oscillator
from cosimulated.runs import Master, Problem

PROBLEMS: Mapping[str, Callable[[Path], Problem]] = {
    "oscillator": Oscillator,
    "car": Car,
    "bounce": Bounce,
    "drop": lambda _: Drop(),
}
ECCO = {  # names and values as in libcosimpy's test of a quarter car, but for the shortest step
    "safety_factor": 0.8,
    "step_size": 1e-4,
    "min_step_size": 1e-6,
    "min_change_rate": 0.2,
    "max_change_rate": 1.5,
    "p_gain": 0.2,
    "i_gain": 0.15,
}
OTHERS: tuple[Other, ...] = (
    Other("libcosim"),
    Controlled("libcosim", "step control", ecco=ECCO),
    Other("ecos"),
    Other("fmpy"),
    Other("cofmupy", "jacobi", {"cosim_method": "jacobi"}),
    Other("cofmupy", "gauss-seidel", {"cosim_method": "gauss_seidel"}),
    Other("cofmupy", "iterative", {"cosim_method": "gauss_seidel", "iterative": True}),
)


def main(arguments: list[str] | None = None) -> int:
    """Print the tables, draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--problems", default=",".join(PROBLEMS), help=f"of {', '.join(PROBLEMS)}")
    tools = dict.fromkeys(other.tool for other in OTHERS)
    parser.add_argument("--tools", default=",".join(tools), help="other tools; '' for none")
    parser.add_argument("--quick", action="store_true", help="the coarsest runs only: does it still run?")
    parser.add_argument("-o", "--output", type=Path, default=Path("runs/masters"))
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    with (
        tempfile.TemporaryDirectory() as folder,
        (options.output / "masters.txt").open("w", encoding="utf-8") as file,
    ):
        fmu = bodies.fmu(bodies.compiled(Path(folder)))
        found, own = {}, []
        for name in options.problems.split(","):
            problem = PROBLEMS[name](fmu)
            ways = [Own(way, table) for way, table in problem.own.items()]
            others = [other for other in OTHERS if other.tool in options.tools.split(",")]
            own += [way.title for way in ways]
            found[problem.title] = compared(problem, [*ways, *others], options.quick, file)
    draw(found, own, options.output / "masters.png")
    print(f"\ntables and picture in {options.output}")
    return 0


def compared(problem: Problem, masters: list[Master], quick: bool, file: TextIO) -> list[Result]:
    """All masters on a problem, and its table on the screen and in a file."""
    rows: list[tuple[Result, str]] = []
    for master in masters:
        tried = master.settings(problem)
        found = list(comparison.results(master, problem, tried[:1] if quick else tried))
        rests = "-" if quick else comparison.resting(master, problem)
        rows += [(one, "" if k else rests) for k, one in enumerate(found)]
    results = [one for one, _ in rows]
    for line in (*comparison.block(problem.title, rows).lines(), *comparison.reasons(results)):
        print(line, flush=True)
        print(line, file=file, flush=True)
    return results


if __name__ == "__main__":
    sys.exit(main())
