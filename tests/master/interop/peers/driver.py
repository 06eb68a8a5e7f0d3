"""What all drivers share: an SSP package and names of variables come in, the answer goes out as JSON.

    python drive_TOOL.py SYSTEM.ssp ANSWER.json COMPONENT.VARIABLE...

Drivers run in environments without the project: they import the standard library, their tool and what
stands beside them.
"""

from __future__ import annotations

import json
import os
import sys
import time as clock
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

STANDARD = "{http://ssp-standard.org/SSP1/SystemStructure"
SSD, SSC, SSV = f"{STANDARD}Description}}", f"{STANDARD}Common}}", f"{STANDARD}ParameterValues}}"
OSP = "{http://opensimulationplatform.com/SSP/OSPAnnotations}"
HEART = "SystemStructure.ssd"
WARM_UP = 200  # macro steps before the clock starts


@dataclass
class Drop:
    """A system to run, and what to read at its end."""

    path: Path
    root: Element  # of its SystemStructure.ssd
    step: float  # s
    steps: int
    wanted: list[tuple[str, str]]  # component, variable

    @property
    def components(self) -> dict[str, Element]:
        """By name."""
        return {element.attrib["name"]: element for element in self.root.iter(f"{SSD}Component")}

    @property
    def connections(self) -> list[tuple[str, str, str, str]]:
        """Component and variable it comes from, component and variable it goes to."""
        ends = ("startElement", "startConnector", "endElement", "endConnector")
        return [tuple(c.attrib[end] for end in ends) for c in self.root.iter(f"{SSD}Connection")]


def values(component: Element) -> dict[str, float]:
    """Parameters and start values of a component."""
    found: dict[str, float] = {}
    for parameter in component.iter(f"{SSV}Parameter"):
        (given,) = parameter
        number = float if given.tag == f"{SSV}Real" else int
        found[parameter.attrib["name"]] = number(given.attrib["value"])
    return found


class Watch:
    """A stopwatch of time on the wall and on the processor (all threads), in s."""

    def __init__(self) -> None:
        self._began = clock.perf_counter(), clock.process_time()

    def read(self) -> tuple[float, float]:
        """Since it was started."""
        return clock.perf_counter() - self._began[0], clock.process_time() - self._began[1]


@dataclass
class Answer:
    """What a tool found."""

    values: list[float]  # of what was wanted, at the end
    spent: tuple[float, float]  # s, wall and processor, of all steps but the first WARM_UP


def opened(package: str, names: Sequence[str]) -> Drop:
    """The package at a path, and what is wanted of it as COMPONENT.VARIABLE."""
    with zipfile.ZipFile(package) as archive:
        root = fromstring(archive.read(HEART))
    step = float(next(root.iter(f"{OSP}FixedStepAlgorithm")).attrib["baseStepSize"])
    stop = float(next(root.iter(f"{SSD}DefaultExperiment")).attrib["stopTime"])
    wanted = [tuple(name.split(".", 1)) for name in names]
    return Drop(Path(package), root, step, round(stop / step), wanted)


def main(drive: Callable[[Drop], Answer]) -> None:
    """Run the package of the command line with `drive`, and leave the answer."""
    package, target, *names = sys.argv[1:]
    drop = opened(package, names)
    answer = drive(drop)
    found = {
        "values": dict(zip(names, answer.values, strict=True)),
        "spent": [1e6 * seconds / (drop.steps - WARM_UP) for seconds in answer.spent],  # us per macro step
    }
    Path(target).write_text(json.dumps(found), encoding="utf-8")
    sys.stdout.flush()
    os._exit(0)  # tools may unload FMUs after the interpreter that both need
