"""Try one unpacked FMU: `python -I trial.py FOLDER` loads it, initialises it, steps it and frees it.

It runs in a process of its own and imports nothing of the project, as another tool would. It prints the
stage it enters and what the FMU logs, so that a crash, too, is known by its place.
"""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Any

from fmpy import calloc, free, read_model_description
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)

STEPS, STEP = 10, 1e-5  # s
STAGE, LOG = "stage: ", "log: "


class Stage(StrEnum):
    """The stage that the process has reached."""

    LOADING = "loading"
    INITIALISING = "initialising"
    STEPPING = "stepping"
    FREEING = "freeing"
    ENDING = "ending"


def say(text: str) -> None:
    """One line, out before anything may crash."""
    print(" ".join(text.split()), flush=True)


def callbacks() -> fmi2CallbackFunctions:
    """The functions that the FMU may call."""

    def log(_: Any, __: bytes, status: int, ___: bytes, message: bytes | None) -> None:
        if status > 1 and message:
            say(LOG + message.decode("utf-8", "replace"))

    functions = fmi2CallbackFunctions()
    functions.logger = fmi2CallbackLoggerTYPE(log)
    functions.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
    functions.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
    return functions


def main() -> None:
    """Try it."""
    folder = sys.argv[1]
    description = read_model_description(folder, validate=False)
    assert description.coSimulation is not None
    kept = callbacks()
    say(STAGE + Stage.LOADING)
    fmu = FMU2Slave(
        guid=description.guid,
        modelIdentifier=description.coSimulation.modelIdentifier,
        unzipDirectory=folder,
        instanceName="trial",
    )
    fmu.instantiate(callbacks=kept, loggingOn=True)
    say(STAGE + Stage.INITIALISING)
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    say(STAGE + Stage.STEPPING)
    for k in range(STEPS):
        fmu.doStep(k * STEP, STEP)
    say(STAGE + Stage.FREEING)
    fmu.terminate()
    fmu.freeInstance()
    say(STAGE + Stage.ENDING)


if __name__ == "__main__":
    try:
        main()
    except Exception as error:
        say(LOG + str(error))
        sys.exit(1)
