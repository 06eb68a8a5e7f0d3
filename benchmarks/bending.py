"""What a ring that bends costs, and how far its ball loads are off.

The shipped bearings carry a disk through its first impact with the balls at twelve angles, on a bore by
the source's law and on a steel line. Worst ball and journal are compared with all harmonics in adaptive
steps of a tolerance of 1e-9; time is the ratio over the same run with a rigid ring, the fastest of some
runs of each in turn: over the impact, and over a span of sliding and rebounds after it.

    python benchmarks/bending.py [--repeat 5]
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np
from random_bearings import MODULES, Case, carry, landed, shipped_cases

from touchdown.bearings.rolling.bending import AUTOMATIC, MAX_HARMONICS

LAWS = {"source": {}, "line": {"contact.law": 1, "contact.damping": 1e9, "contact.load": 400.0}}
MICRO_STEP = 2.5e-6  # s, the default
MACRO_STEP = 5e-5  # s
TIMED_STEP = 5e-4  # s, of macro steps that are timed: long ones, so that little but kernels is
IMPACT, SLIDING = 2e-3, 20e-3  # s


def with_ring(case: Case, law: str, harmonics: int) -> Case:
    """The case with that law of the bore and a ring that bends in so many harmonics."""
    return replace(case, parameters=case.parameters | LAWS[law] | {"ring.harmonics": harmonics})


def peaks(case: Case, micro_step: float) -> tuple[float, float]:
    """Peak force (N) of the most loaded ball and of the journal in the first impact."""
    instance = landed(case, 1e-9, micro_step)
    carry(instance, MACRO_STEP, round(IMPACT / MACRO_STEP))
    outputs = instance.record["o"]
    return float(outputs["balls"]["peak_force"]), float(outputs["contact"]["peak_force"])


def seconds(case: Case, span: float) -> float:
    """Time that the bearing takes over a span (s) from the landing on."""
    instance = landed(case, 1e-6, MICRO_STEP)
    start = time.process_time()
    carry(instance, TIMED_STEP, round(span / TIMED_STEP))
    return time.process_time() - start


def ratio(case: Case, law: str, span: float, repeat: int) -> float:
    """Time with a ring that bends over that with a rigid one."""
    rigid, bent = with_ring(case, law, 0), with_ring(case, law, AUTOMATIC)
    runs = [(seconds(rigid, span), seconds(bent, span)) for _ in range(repeat + 1)][1:]
    return min(b for _, b in runs) / min(a for a, _ in runs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--repeat", type=int, default=5)
    repeat = parser.parse_args().repeat
    print("model               bore    largest error of ball, journal   time, impact, sliding")
    for model in (name for name in MODULES if not name.startswith("angular_")):  # whose ring is rigid
        for law in LAWS:
            cases = shipped_cases(model)
            exact = np.array([peaks(with_ring(c, law, MAX_HARMONICS), 0.0) for c in cases])
            found = np.array([peaks(with_ring(c, law, AUTOMATIC), MICRO_STEP) for c in cases])
            off = 100.0 * np.abs(found / exact - 1.0).max(axis=0)
            cost = [ratio(cases[0], law, span, repeat) for span in (IMPACT, SLIDING)]
            print(
                f"{model:20}{law:8}{off[0]:10.1f} %{off[1]:8.1f} %         {cost[0]:10.2f}{cost[1]:10.2f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
