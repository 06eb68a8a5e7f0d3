"""extra/org.fmi-standard.fmi-ls-ref/: an experiment with its results, and parameter sets, in the FMU.

By the layered standard FMI-LS-REF 1.0.0-alpha.1: a manifest says which files there are and what they are
for. Whoever has the FMU can run the experiment where it is to work, and hold what comes out against what
came out where it was built; `touchdown check` does.

The experiment moves what the FMU's ports take, for a millisecond. A journal is pressed from just inside
the clearance into the bearing and out again, to and fro a little; a body is pushed up and shaken; a
controller sees an axis go to and fro. The results are those of the model without the FMU around it.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent

from ...modelkit.model import Model, Slot, slots
from ...modelkit.variables import Causality, Scalar
from ..description.variables import ARRAY_GROUPS, causality, scalars
from .terminals import document, ports

NAME, VERSION = "org.fmi-standard.fmi-ls-ref", "1.0.0-alpha.1"
FOLDER = f"extra/{NAME}"
STEP, STEPS = 2e-5, 50  # s; macro steps
RATE = math.pi / (STEP * STEPS)  # rad/s, of what goes to and fro once
TOLERANCE = 1e-6  # of the largest value in a result's unit
START, DEPTH, AROUND = 1e-6, 4e-6, 1e-6  # m; how far inside the clearance, pressed in, and sideways
SPIN = 500.0  # rad/s
INVERSE_MASS = 0.5  # 1/kg, of what a bearing holds
SEEN = ".sensed"  # what a controller is told of an axis
PUSH, SHAKE = 20.0, 10.0  # N
DIGITS = 12

Values = Mapping[str, float]
Row = dict[str, float]  # of a table, by its heads
_SSV = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
_LS = "http://fmi-standard.org/fmi-ls-manifest"
_ABOUT = "Layered Standard providing information on related files included in an FMU."
_SET = "application/x-ssp-parameter-set"
_EXPERIMENT = "application/x-ma-ls-experiments"


@dataclass(frozen=True)
class Trial:
    """Where an experiment is run: in a new instance, and what it raises where the model refuses.

    An FMU's sources have classes of their own, so these are not always `modelkit.instance`'s.
    """

    instance: Any
    refused: type[Exception]


def entries(model: Model, trial: Trial, sets: Mapping[str, Values]) -> dict[str, bytes]:
    """The folder's files by their names in the FMU of `model`, which runs the experiment in `trial`.

    sets: parameter sets by name, SI. Where the model cannot run the experiment from its start values, it
    comes without.
    """
    exposed = slots(model)
    own = {s.variable.name: s.variable.default for s in exposed if s.causality is Causality.PARAMETER}
    files = {"default.ssv": _parameter_set("default", own, exposed)}
    related = [(_SET, "default.ssv", "parameter", "Start values")]
    for name, values in sets.items():
        file = f"{name.replace(' ', '-')}.ssv"
        files[file] = _parameter_set(name, values, exposed)
        related.append((_SET, file, "parameter", f"Bearing {name}"))
    stimuli = _stimuli(model)
    results = _results(trial, exposed, stimuli)
    if results:
        files |= {
            "stimuli.csv": _csv(stimuli),
            "results.csv": _csv(results),
            "smoke-test.exp": _experiment(),
        }
        related.append((_EXPERIMENT, "smoke-test.exp", "experiment/smoke-test", "One millisecond"))
        related.append(("text/csv", "results.csv", "result", "Results of the experiment, SI"))
    files["fmi-ls-manifest.xml"] = _manifest(related)
    return {f"{FOLDER}/{name}": content for name, content in files.items()}


# -- what is done, and what comes out ----------------------------------------------------------------------


def _stimuli(model: Model) -> list[Row]:
    """Times (s) and what the inputs hold then."""
    settable = {s.variable.name for s in slots(model) if s.causality is Causality.INPUT}
    clearance = next((s.variable.default for s in slots(model) if s.variable.name == "clearance"), 0.0)
    moved = [port for port in ports(scalars(model)) if not port.startswith("housing")]

    def row(time: float) -> Row:
        given = _pressed(clearance, time) | _pushed(time)
        held = {f"{port}.{member}": value for port in moved for member, value in given.items()}
        if not moved:
            held = _sampled(settable, time)
        values = {"time": time} | {name: value for name, value in held.items() if name in settable}
        return {name: float(_written(value)) for name, value in values.items()}

    return [row(k * STEP) for k in range(STEPS + 1)]


def _pressed(clearance: float, time: float) -> dict[str, float]:
    """Motion of a journal (m, m/s, rad/s) that is pressed down and out again, and its mobility (1/kg)."""
    return {
        "x": AROUND * math.sin(2.0 * RATE * time),
        "y": -(clearance - START) - DEPTH * math.sin(RATE * time) ** 2,
        "vx": 2.0 * RATE * AROUND * math.cos(2.0 * RATE * time),
        "vy": -RATE * DEPTH * math.sin(2.0 * RATE * time),
        "omega": SPIN,
        "inv_m": INVERSE_MASS,
    }


def _pushed(time: float) -> dict[str, float]:
    """Forces on a body (N)."""
    return {"fx": SHAKE * math.sin(2.0 * RATE * time), "fy": PUSH * math.sin(RATE * time) ** 2}


def _sampled(settable: Iterable[str], time: float) -> dict[str, float]:
    """Inputs of a controller: a new sample with each step (`tick`), positions (m) that go to and fro."""
    sampled = [name for name in sorted(settable) if name.endswith(SEEN)]
    return {"tick": time / STEP} | dict.fromkeys(sampled, DEPTH * math.sin(RATE * time) ** 2)


def _results(trial: Trial, exposed: tuple[Slot, ...], stimuli: list[Row]) -> list[Row]:
    """Time (s) and outputs at the start and after each step; those of single modes, and zeros, left out.

    Nothing where the model refuses to start or to step, or has nothing to tell.
    """
    instance = trial.instance
    own = {s.variable.name: s for s in instance.slots}
    inputs = {s.variable.name: s.index for s in exposed if s.causality is Causality.INPUT}
    told = [s.variable.name for s in exposed if causality(s)[0] is Causality.OUTPUT]
    outputs = [own[name] for name in told if not any(f"{group}[" in name for group in ARRAY_GROUPS)]
    found: list[Row] = []
    try:
        for number, row in enumerate(stimuli):
            if number:
                instance.step(stimuli[number - 1]["time"], STEP)
            for name in row.keys() & inputs.keys():
                instance.reals[inputs[name]] = row[name]
            if not number:
                instance.start(row["time"])
            values = {s.variable.name: float(instance.store(s)[s.index]) for s in outputs}
            found.append({"time": row["time"], **values})
    except trial.refused:
        return []
    moved = [name for name in found[0] if name == "time" or any(row[name] for row in found)]
    return [{name: row[name] for name in moved} for row in found] if len(moved) > 1 else []


# -- files -------------------------------------------------------------------------------------------------


def _written(value: float) -> str:
    return f"{value + 0.0:.{DIGITS}g}"  # no -0


def _csv(rows: Sequence[Row]) -> bytes:
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(rows[0])
    table.writerows([_written(value) for value in row.values()] for row in rows)
    return text.getvalue().encode()


def _parameter_set(name: str, values: Values, exposed: Sequence[Slot]) -> bytes:
    """SSP's; choices by their numbers, which is how FMI 2.0 sets them."""
    kinds = {s.variable.name: s.variable.spec for s in exposed}
    root = Element("ssv:ParameterSet", {"xmlns:ssv": _SSV, "version": "1.0", "name": name})
    parameters = SubElement(root, "ssv:Parameters")
    for variable, value in values.items():
        spec = kinds[variable]
        parameter = SubElement(parameters, "ssv:Parameter", {"name": variable})
        if spec.kind is Scalar.REAL:
            SubElement(parameter, "ssv:Real", {"value": repr(float(value))})
        else:
            SubElement(parameter, "ssv:Integer", {"value": str(int(value))})
    return _xml(root)


def _experiment() -> bytes:
    root = Element(
        "Experiments", {"name": "smoke-test", "description": "Whether it runs here as elsewhere"}
    )
    times = {"startTime": "0.0", "stopTime": repr(STEP * STEPS), "stepSize": repr(STEP)}
    experiment = SubElement(root, "Experiment", {"name": "press", "tolerance": repr(TOLERANCE), **times})
    SubElement(experiment, "Parameters", {"source": "default.ssv"})
    SubElement(experiment, "Stimuli", {"source": "stimuli.csv"})
    SubElement(experiment, "References", {"source": "results.csv"})
    return _xml(root)


def _manifest(related: Iterable[tuple[str, str, str, str]]) -> bytes:
    told = {"name": NAME, "version": VERSION, "description": _ABOUT}
    attributes = {f"fmi-ls:fmi-ls-{key}": value for key, value in told.items()}
    root = Element("fmiReferences", {"xmlns:fmi-ls": _LS, **attributes})
    for kind, source, role, description in related:
        file = {"type": kind, "source": source, "role": role, "description": description}
        SubElement(root, "Related", file)
    return _xml(root)


def _xml(root: Element) -> bytes:
    indent(root)
    return document(root)
