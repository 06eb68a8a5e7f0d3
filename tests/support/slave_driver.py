"""A bare FMI 2.0 host for one FMU, built on nothing but fmpy.

Tests run it in processes of their own, where the project itself cannot be imported.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from fmpy import calloc, free, read_model_description
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.model_description import ModelDescription

STEP = 2e-5  # s
TOUCHING = {
    "journal.y": -0.31e-3,
    "journal.vy": -0.05,
    "journal.inv_m": 1 / 1.65,
    "journal.ay_free": -9.81,
    "journal.omega": 900.0,
    "axis[1].sensed": 1e-4,
    "clock": 1,
}  # of a bearing of 0.3 mm clearance with its journal 10 um inside; of a controller that samples by itself


@cache
def description_in(folder: str) -> ModelDescription:
    """Of an unpacked FMU; checked and read once, however many instances there are."""
    return read_model_description(folder)


class Slave:
    """One instance of an unpacked FMU; what it logs is kept in `messages`."""

    def __init__(self, folder: str | Path, name: str = "slave") -> None:
        description = description_in(str(folder))
        self.variables = {v.name: v for v in description.modelVariables}
        self.messages: list[str] = []
        self.categories: set[bytes | None] = set()  # of the messages
        self._callbacks = self._make_callbacks()
        self.fmu = FMU2Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=str(folder),
            instanceName=name,
        )
        self.fmu.instantiate(callbacks=self._callbacks, loggingOn=True)

    def _make_callbacks(self) -> fmi2CallbackFunctions:
        def log(_: Any, __: bytes, status: int, category: bytes | None, message: bytes) -> None:
            self.messages.append(message.decode())
            self.categories.add(category)

        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(log)
        callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        return callbacks

    @property
    def said(self) -> str:
        """Everything it logged."""
        return "\n".join(self.messages)

    def named(self, *causalities: str) -> list[str]:
        """Names of its variables of these causalities; of members of a group the first stands for all."""
        names = [v.name for v in self.variables.values() if v.causality in causalities]
        return [name for name in names if not re.search(r"\[(?!1\])", name)]

    def set(self, values: Mapping[str, float]) -> None:
        """Set variables by name; those it does not have, or computes itself, are left out."""
        for name, value in values.items():
            variable = self.variables.get(name)
            if variable is not None and variable.causality in ("parameter", "input"):
                call = self.fmu.setReal if variable.type == "Real" else self.fmu.setInteger
                call([variable.valueReference], [value])

    def get(self, names: Iterable[str]) -> dict[str, float]:
        """Values of variables by name, asked for by one call for each type."""
        chosen = [self.variables[name] for name in names]
        found: dict[str, float] = {}
        for real, call in ((True, self.fmu.getReal), (False, self.fmu.getInteger)):
            of_type = [variable for variable in chosen if (variable.type == "Real") == real]
            if of_type:
                values = call([variable.valueReference for variable in of_type])
                found |= {variable.name: value for variable, value in zip(of_type, values, strict=True)}
        return {variable.name: found[variable.name] for variable in chosen}

    def outputs(self) -> dict[str, float]:
        """Everything it computes."""
        return self.get(self.named("output", "local", "calculatedParameter"))

    def start(self, values: Mapping[str, float] | None = None) -> Slave:
        """Initialise it with `values` set."""
        self.set(values or {})
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def run(self, first: int, count: int) -> list[dict[str, str]]:
        """Take `count` macro steps from number `first` on; all outputs after each, to the last bit."""
        found = []
        for k in range(first, first + count):
            self.fmu.doStep(k * STEP, STEP)
            found.append({name: float(value).hex() for name, value in self.outputs().items()})
        return found

    def refuses(self, call: Any, *arguments: Any) -> bool:
        """Whether `call` is answered by a status worse than a warning."""
        try:
            call(*arguments)
        except Exception as error:
            if "failed with status" not in str(error):
                raise
            return True
        return False

    def free(self) -> None:
        """Free the instance and unload the library."""
        self.fmu.freeInstance()
