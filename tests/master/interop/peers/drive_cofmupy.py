"""A drop in cofmupy, which reads no SSP: the package's content as its configuration.

cofmupy calls every variable of an FMI 2.0 FMU as Real, which integers and choices refuse: `Typed` calls
each by its type. With ORDER in the environment (COMPONENT,...;COMPONENT,...) groups are stepped one after
the other, else all side by side.
"""

from __future__ import annotations

import os
import tempfile
import zipfile
from contextlib import redirect_stdout
from io import StringIO

from cofmupy import Coordinator, wrappers
from driver import WARM_UP, Answer, Drop, Watch, main, values


class Typed(wrappers.Fmu2Handler):
    """Sets integers as such, and reads real outputs only."""

    def _set_variable(self, name: str, value: list) -> None:
        variable = self.var_name2attr[name]
        kind = "Integer" if variable.type == "Enumeration" else variable.type  # one function for both
        getattr(self.fmu, f"set{kind}")([variable.valueReference], value)

    def get_output_names(self) -> list[str]:
        return [name for name in super().get_output_names() if self.get_variable_type(name) == "Real"]


def drive(drop: Drop) -> Answer:
    """One call a step, as the tool's own loop does."""
    wrappers.Fmu2Handler = Typed
    coordinator = Coordinator()
    with tempfile.TemporaryDirectory() as folder, redirect_stdout(StringIO()):
        with zipfile.ZipFile(drop.path) as archive:
            archive.extractall(folder)
        coordinator.start(configuration(drop, folder))
    if "ORDER" in os.environ:
        coordinator.master.sequence_order = [group.split(",") for group in os.environ["ORDER"].split(";")]
    watch = Watch()
    for k in range(drop.steps):
        if k == WARM_UP:
            watch = Watch()
        coordinator.do_step(drop.step)
    spent = watch.read()
    return Answer([coordinator.get_variable(wanted)[0] for wanted in drop.wanted], spent)


def configuration(drop: Drop, folder: str) -> dict[str, object]:
    """cofmupy's own description of the system."""
    return {
        "fmus": [
            {"id": name, "path": f"{folder}/{c.attrib['source']}", "initialization": values(c)}
            for name, c in drop.components.items()
        ],
        "connections": [
            {"source": {"id": source, "variable": output}, "target": {"id": target, "variable": given}}
            for source, output, target, given in drop.connections
        ],
        "cosim_method": "jacobi",
        "iterative": False,
    }


if __name__ == "__main__":
    main(drive)
