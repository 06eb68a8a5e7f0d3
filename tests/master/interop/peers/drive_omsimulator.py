"""A drop in OMSimulator; the package, as `touchdown ssp --outputs-only` writes it, goes in whole.

It records connectors only, with twelve digits. The end of the run is an option of its own, which by default
is 1 s whatever the package says.
"""

from __future__ import annotations

import csv
import subprocess
from pathlib import Path

from driver import Answer, Drop, main


def drive(drop: Drop) -> Answer:
    """The macro step is the package's own; what it costs cannot be told from the program's start."""
    result, end = Path(f"{drop.path.stem}.csv"), drop.steps * drop.step
    options = [f"--resultFile={result}", f"--stopTime={end + 0.5 * drop.step!r}"]
    subprocess.run(["OMSimulator", *options, drop.path], check=True, stdout=subprocess.DEVNULL)
    with result.open(encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    last = next(row for row in reversed(rows) if abs(float(row[0]) - end) < 0.1 * drop.step)
    values = dict(zip(names, map(float, last), strict=True))
    found = [
        next(value for title, value in values.items() if title.endswith(f".{name}.{variable}"))
        for name, variable in drop.wanted
    ]
    return Answer(found, (0.0, 0.0))


main(drive)
