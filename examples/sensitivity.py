"""Which settings the peak contact force depends on: Sobol indices by SALib, from a sweep.

    pip install SALib
    python examples/sensitivity.py [FOLDER]

S1 is the part of the variance that a setting makes alone, ST the part that it has a hand in; behind each,
half of the 95 % interval. The second command with the same folder runs nothing again.
"""

from __future__ import annotations

import sys

import pandas
from SALib import ProblemSpec

import touchdown

RANGES = {  # SI
    "bearing.clearance": (0.2e-3, 0.3e-3),  # m
    "bearing.friction.dynamic": (0.05, 0.3),
    "rotor.eccentricity": (0.0, 20e-6),  # m
}
POINTS = 32  # times 5: a run for each column exchanged


def main(folder: str | None) -> None:
    """Draw points, run them, and print the indices."""
    problem = ProblemSpec({"names": list(RANGES), "bounds": list(map(list, RANGES.values()))})
    problem.sample_sobol(POINTS, calc_second_order=False, seed=1)
    points = pandas.DataFrame(problem.samples, columns=list(RANGES)).to_dict("records")
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "12 ms"})
    found = touchdown.sweep(scene, points, folder, in_process=True, progress=True)
    problem.set_results(found.data["seats.A.peak_contact_force"].values)
    problem.analyze_sobol(calc_second_order=False, seed=1)
    total, first = problem.to_df()
    print(f"{len(found)} drops")
    print(first.join(total).round(2).to_string())


if __name__ == "__main__":
    main(*(sys.argv[1:] or [None]))
