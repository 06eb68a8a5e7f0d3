"""Co-simulation masters on the same FMUs: error, energy, longest stable step, number of doSteps.

    python benchmarks/masters.py [--problems car,bounce] [--tools libcosim,ecos] [--quick] [-o runs/masters]

Four systems: two masses on springs that are shot at each other (also where the position or the velocity
alone comes back), a quarter car that meets a step of the road, a ball on an undamped one-sided spring (FMUs
in C, compiled for it), and a shipped scene, the disk that falls onto a touchdown bearing. Every scheme of
this project, and libcosim with fixed steps and with its energy-based step control, ecos, fmpy's SSP runner
and cofmupy, which are installed from PyPI into environments of their own; ecos needs Debian's libtbb12. One
table for each system, and one picture. The step control has the parameters of libcosimpy's own test of a
quarter car, but may take steps from 1 us to the longest that the others are asked for; its tolerances,
absolute and relative, are what is varied. Results are kept, so that problems can be run one by one.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

sys.path.extend(
    str(Path(__file__).resolve().parents[1] / part)
    for part in (
        "benchmarks",
        "tests/support",
        "tests/master/interop/peers",
    )
)

from cosimulated import comparison
from cosimulated.comparison import Result, draw
from cosimulated.masters import Controlled, Master, Other, Own
from cosimulated.problems import Bounce, Car, Drop, Oscillator, PositionAlone, Problem, VelocityAlone

from touchdown.validation import bodies

PROBLEMS: Mapping[str, Callable[[Path], Problem]] = {
    "car": Car,
    "drop": lambda _: Drop(),
    "bounce": Bounce,
    "oscillator": Oscillator,
    "position": PositionAlone,
    "velocity": VelocityAlone,
}
SHOWN = {"car": Car.title, "drop": Drop.title, "bounce": Bounce.title, "oscillator": Oscillator.title}
ECCO = {  # names and values as in libcosimpy's test of a quarter car, but for the shortest step
    "safety_factor": 0.8,
    "step_size": 1e-4,
    "min_step_size": 1e-6,
    "min_change_rate": 0.2,
    "max_change_rate": 1.5,
    "p_gain": 0.2,
    "i_gain": 0.15,
}
SLOW = 10_000  # macro steps
OTHERS: tuple[Other, ...] = (
    Other("libcosim"),
    Controlled("libcosim", "step control", ecco=ECCO),
    Other("ecos"),
    Other("fmpy"),
    Other("cofmupy", "jacobi", {"cosim_method": "jacobi"}, SLOW),
    Other("cofmupy", "gauss-seidel", {"cosim_method": "gauss_seidel"}, SLOW),
    Other("cofmupy", "iterative", {"cosim_method": "gauss_seidel", "iterative": True}, SLOW),
)


TUNED: Mapping[str, Mapping[str, float]] = {  # what else was tried for the step control
    "as above": {},
    "first step 1 us": {"step_size": 1e-6},
    "rates 0.5 to 1.1": {"min_change_rate": 0.5, "max_change_rate": 1.1},
    "rates 0.2 to 2": {"max_change_rate": 2.0},
    "safety 1": {"safety_factor": 1.0},
    "gains 0, 0.5": {"p_gain": 0.0, "i_gain": 0.5},
    "gains 0.4, 0.3": {"p_gain": 0.4, "i_gain": 0.3},
    "gains 0.13, 0.2": {"p_gain": 0.13, "i_gain": 0.2},
}


def main(arguments: list[str] | None = None) -> int:
    """Print the tables, draw the picture."""
    options = asked(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        fmu = bodies.fmu(bodies.compiled(Path(folder)))
        if options.tune:
            tuned = [
                Controlled("libcosim", name, ecco={**ECCO, **change}) for name, change in TUNED.items()
            ]
            tabled(Car(fmu), tuned, options)
            return 0
        for name in options.problems:
            problem = PROBLEMS[name](fmu)
            ways = [Own(way, table) for way, table in problem.ways.items()]
            others = [other for other in OTHERS if other.tool in options.tools]
            comparison.keep(tabled(problem, [*ways, *others], options), options.output / f"{name}.json")
    known = {title: comparison.known(options.output / f"{name}.json") for name, title in SHOWN.items()}
    drawn = {title: found for title, found in known.items() if found}
    if drawn:
        draw(drawn, options.output / "masters.png")
        print(f"\npicture, of all problems that were ever run into it, in {options.output}")
    return 0


def asked(arguments: list[str] | None) -> argparse.Namespace:
    """The command's options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    tools = dict.fromkeys(other.tool for other in OTHERS)
    parser.add_argument("--problems", default=",".join(PROBLEMS), help=f"of {', '.join(PROBLEMS)}")
    parser.add_argument("--tools", default=",".join(tools), help=f"of {', '.join(tools)}; '' for none")
    parser.add_argument("--quick", action="store_true", help="the coarsest runs only: does it still run?")
    parser.add_argument(
        "--tune", action="store_true", help="only the step control's other parameters, on the car"
    )
    parser.add_argument(
        "--no-stable", action="store_true", help="no search for stable steps, which takes long"
    )
    parser.add_argument("-o", "--output", type=Path, default=Path("runs/masters"))
    options = parser.parse_args(arguments)
    for key, known in (("problems", PROBLEMS), ("tools", tools)):
        chosen = [name for name in getattr(options, key).split(",") if name]
        if not set(chosen) <= set(known):
            parser.error(f"--{key} {','.join(chosen)}: of {', '.join(known)}")
        setattr(options, key, chosen)
    if bodies.COMPILER is None:
        parser.error("needs a C compiler, for FMUs in C")
    return options


def tabled(problem: Problem, masters: Sequence[Master], options: argparse.Namespace) -> list[Result]:
    """What all masters give on a problem, which is printed."""
    stability = None if options.quick or options.no_stable else comparison.Stability(problem)
    found = list(comparison.compared(masters, problem, stability, options.quick))
    print(*comparison.table(problem.title, found), sep="\n", flush=True)
    return found


if __name__ == "__main__":
    sys.exit(main())
