"""cofmupy: the options are those of its own configuration, `cosim_method` and `iterative`."""

from __future__ import annotations

import tempfile
import zipfile
from contextlib import redirect_stdout
from io import StringIO

from cofmupy import Coordinator, wrappers
from drive_cofmupy import Typed, configuration
from driver import Drop
from following import Followed, Options, main


class Counted(Typed):
    """Counts the steps of all, and those that are repeated."""

    calls = 0

    def step(self, current_time: float, step_size: float, input_dict: dict) -> dict:
        Counted.calls += 1
        return super().step(current_time, step_size, input_dict)


def follow(drop: Drop, options: Options) -> Followed:
    """One call a step, as the tool's own loop does."""
    wrappers.Fmu2Handler = Counted
    coordinator = Coordinator()
    with tempfile.TemporaryDirectory() as folder, redirect_stdout(StringIO()):
        with zipfile.ZipFile(drop.path) as archive:
            archive.extractall(folder)
        coordinator.start(configuration(drop, folder) | dict(options))
    rows: list[list[float]] = []
    for _ in range(drop.steps):
        coordinator.do_step(drop.step)
        rows.append([coordinator.get_variable(wanted)[0] for wanted in drop.wanted])
    return Followed(rows, Counted.calls)


main(follow)
