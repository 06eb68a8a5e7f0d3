"""A drop in OMSimulator; the package, as `touchdown ssp --outputs-only` writes it, goes in whole.

It records connectors only, with twelve digits, a row before and a row after each exchange. The end of the
run is an option of its own, which by default is 1 s whatever the package says.
"""

from __future__ import annotations

import csv
import subprocess
from pathlib import Path

from driver import WARM_UP, Answer, Drop, Watch, main


def drive(drop: Drop) -> Answer:
    """The program keeps no time of its own: two runs of different length give the steps' cost."""

    def run(steps: int) -> tuple[dict[str, float], tuple[float, float]]:
        watch, result = Watch(), Path(f"{drop.path.stem}-{steps}.csv")
        end = (steps + 0.5) * drop.step
        options = [f"--resultFile={result}", f"--stopTime={end!r}"]
        subprocess.run(["OMSimulator", *options, drop.path], check=True, stdout=subprocess.DEVNULL)
        spent = watch.read()
        with result.open(encoding="utf-8") as file:
            names, *rows = csv.reader(file)
        time = steps * drop.step
        last = next(row for row in reversed(rows) if abs(float(row[0]) - time) < 0.1 * drop.step)
        return dict(zip(names, map(float, last), strict=True)), spent

    _, short = run(WARM_UP)
    values, long = run(drop.steps)
    found = [
        next(value for title, value in values.items() if title.endswith(f".{name}.{variable}"))
        for name, variable in drop.wanted
    ]
    return Answer(found, (long[0] - short[0], long[1] - short[1]))


main(drive)
