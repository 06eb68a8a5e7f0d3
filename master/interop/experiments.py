"""Experiments that FMUs bring along, by the layered standard FMI-LS-REF: run, and held to their results.

A manifest, extra/org.fmi-standard.fmi-ls-ref/fmi-ls-manifest.xml, names files of experiments. Each says
from when to when and in which steps to run, from which parameters (SSP's parameter sets), with which inputs
and to which results (tables over time, of which inputs are linear between rows). A result may be off by the
experiment's tolerance times the largest result in its unit: components of a force belong together.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from posixpath import normpath
from xml.etree.ElementTree import Element

import numpy as np

from ..common.errors import TouchdownError
from ..components.component import NUMBERS, Component, Kind, Variable, check_value, value_of
from .ssp import xml
from .ssp.structure import parameters

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
MANIFEST = f"{FOLDER}/fmi-ls-manifest.xml"
ROLES = ("experiment", "experiment/smoke-test", "experiment/validation")
TYPES = ("application/x-ma-ls-experiments", "application/x-ma-hs-experiments")
TOLERANCE = 1e-3  # where an experiment states none
MAX_STEPS = 1_000_000
MAX_TABLE_BYTES = 64 * 2**20  # bytes of a table


@dataclass(frozen=True)
class Table:
    """Columns over time (n,), s; `values` (n, m)."""

    times: np.ndarray
    names: tuple[str, ...]
    values: np.ndarray

    def at(self, time: float) -> dict[str, float]:
        """Values at `time` (s) by name, linear between rows."""
        columns = zip(self.names, self.values.T, strict=True)
        return {name: float(np.interp(time, self.times, column)) for name, column in columns}


NO_STIMULI = Table(np.zeros(1), (), np.zeros((1, 0)))


@dataclass(frozen=True)
class Experiment:
    """An experiment and its expected results; times in s."""

    name: str
    start: float
    stop: float
    step: float
    tolerance: float
    parameters: Mapping[str, float | str]  # numbers, and words of enumerations
    stimuli: Table
    references: Table

    @property
    def steps(self) -> int:
        """How many macro steps it takes."""
        return round((self.stop - self.start) / self.step)


@dataclass(frozen=True)
class Deviation:
    """Where a result is furthest off, as tolerances count it; values in `unit`."""

    name: str
    unit: str
    time: float  # s
    expected: float
    found: float
    share: float  # of the largest result in that unit

    @property
    def distance(self) -> str:
        """How far, for people."""
        off = abs(self.found - self.expected)
        return f"{self.name} is off most, by {off:.2g}{self._unit}, {self.share:.2g} of the largest"

    @property
    def text(self) -> str:
        """The actual result, for people."""
        found, expected = (f"{value:.6g}{self._unit}" for value in (self.found, self.expected))
        return f"{self.name} is {found} at t = {self.time:.6g} s, not {expected}; {self.distance}"

    @property
    def _unit(self) -> str:
        return f" {self.unit}" if self.unit not in ("", "1") else ""


# -- reading them ------------------------------------------------------------------------------------------


def experiments(folder: Path) -> Iterator[Experiment]:
    """The experiments that an unpacked FMU brings along to be validated with.

    Raises TouchdownError for one that cannot be read.
    """
    if not (folder / MANIFEST).is_file():
        return
    manifest = xml.read_plain(folder / MANIFEST, MANIFEST, "fmiReferences")
    for related in manifest.iterfind("Related"):
        if related.get("role") in ROLES and related.get("type") in TYPES:
            source = _source_path(MANIFEST, related)
            root = xml.read_plain(xml.inside(folder, source, MANIFEST), source, "Experiments")
            for element in root.iterfind("Experiment"):
                yield _experiment(element, folder, source)


def _source_path(where: str, element: Element) -> str:
    """Path in the FMU of the file that an element in the file `where` names as its source."""
    return normpath(f"{where.rpartition('/')[0]}/{xml.required(element, 'source', where)}")


def _experiment(element: Element, folder: Path, where: str) -> Experiment:
    name = xml.required(element, "name", where)
    what = f"{where}: experiment {name}"
    references = _table(element.find("References"), folder, where)
    if references is None:
        raise TouchdownError(f"{what} has no References; there is nothing to hold its results against")
    given = element.find("Parameters")
    values = (
        [] if given is None else parameters(xml.inside(folder, _source_path(where, given), where), what)
    )
    start = xml.number(element, "startTime", what, float(references.times[0]))
    stop = xml.number(element, "stopTime", what, float(references.times[-1]))
    step = xml.number(element, "stepSize", what, float(np.diff(references.times).max(initial=0.0)))
    if not (step > 0.0 and 0.5 <= (stop - start) / step <= MAX_STEPS):
        raise TouchdownError(f"{what} runs from {start:g} s to {stop:g} s in steps of {step:g} s")
    return Experiment(
        name=name,
        start=start,
        stop=stop,
        step=step,
        tolerance=xml.number(element, "tolerance", what, TOLERANCE),
        parameters={value.name: value.given for value in values},
        stimuli=_table(element.find("Stimuli"), folder, where) or NO_STIMULI,
        references=references,
    )


def _table(element: Element | None, folder: Path, where: str) -> Table | None:
    """The table that an element of the file `where` names."""
    if element is None:
        return None
    if element.get("type", "text/csv") != "text/csv":
        raise TouchdownError(
            f"{where}: a table is of the type {element.get('type')}; only text/csv is read"
        )
    source = _source_path(where, element)
    path = xml.inside(folder, source, where)
    if path.stat().st_size > MAX_TABLE_BYTES:
        raise TouchdownError(f"{source} has more than {MAX_TABLE_BYTES >> 20} MiB")
    try:
        head, *rows = csv.reader(path.read_text(encoding="utf-8").splitlines())
        values = np.array([[float(cell) for cell in row] for row in rows if row])
    except (ValueError, csv.Error) as error:
        raise TouchdownError(f"{source} is no table of numbers ({error})") from None
    if values.ndim != 2 or values.shape[1] != len(head) or not np.all(np.diff(values[:, 0]) >= 0.0):
        raise TouchdownError(f"{source} is no table with a time that rises")
    return Table(values[:, 0], tuple(name.strip() for name in head[1:]), values[:, 1:])


# -- running one -------------------------------------------------------------------------------------------


def largest_deviation(component: Component, experiment: Experiment) -> Deviation:
    """Run `experiment` on a component that was not initialised; where it is furthest off its results.

    Raises TouchdownError where the component does not have its variables, or refuses.
    """
    expected = experiment.references
    variables = [_number(component, name) for name in expected.names]
    found = np.array(list(_run(component, experiment)))
    times = experiment.start + experiment.step * np.arange(len(found))
    within = (expected.times >= times[0]) & (expected.times <= times[-1] + 0.5 * experiment.step)
    if not variables or not within.any():
        raise TouchdownError("there are no results within its time")
    wanted, at = expected.values[within], expected.times[within]
    there = np.stack([np.interp(at, times, column) for column in found.T], axis=1)
    share = _shares(np.abs(there - wanted), _scales(variables, wanted))
    row, column = np.unravel_index(int(np.argmax(share)), share.shape)
    return Deviation(
        name=variables[column].name,
        unit=variables[column].unit or "",
        time=float(at[row]),
        expected=float(wanted[row, column]),
        found=float(there[row, column]),
        share=float(share[row, column]),
    )


def _scales(variables: Sequence[Variable], wanted: np.ndarray) -> np.ndarray:
    """By variable, the largest result in its unit; of one that states none, its own."""
    largest = np.max(np.abs(wanted), axis=0)
    units = [v.unit or v.name for v in variables]
    return np.array([max(largest[i] for i, u in enumerate(units) if u == unit) for unit in units])


def _shares(off: np.ndarray, scales: np.ndarray) -> np.ndarray:
    """Deviations (n, m) over their scales (m,); infinite where nothing was expected, or no number came."""
    beyond = np.where(off == 0.0, 0.0, math.inf)
    shares = np.divide(off, scales, out=np.array(beyond), where=(scales > 0.0) & np.isfinite(off))
    return np.asarray(shares)


def _run(component: Component, experiment: Experiment) -> Iterator[list[float]]:
    """The values that the references name, at the start and after each step."""
    stimuli = experiment.stimuli
    given = {**experiment.parameters, **stimuli.at(experiment.start)}
    starts: dict[str, float] = {}
    for name, value in given.items():
        variable = _settable(component, name)
        starts[name] = value_of(component, variable, value)
        check_value(component, variable, starts[name])
    fed = [n for n in stimuli.names if component.variable(n).kind is Kind.REAL]
    for index, name in enumerate(stimuli.names):
        if name not in fed and np.ptp(stimuli.values[:, index]) > 0.0:
            raise TouchdownError(f"{name} is of the type {component.variable(name).kind} and cannot be fed")
    component.set(starts)
    component.bind(fed, np.zeros(0), [])
    read = component.reader(experiment.references.names)
    component.enter(experiment.start)
    component.exit()
    yield read().tolist()
    for k in range(experiment.steps):
        time = experiment.start + k * experiment.step
        now = stimuli.at(time)
        component.inputs[:] = [now[n] for n in fed]
        component.push()
        component.step(time, experiment.step)
        yield read().tolist()


def _settable(component: Component, name: str) -> Variable:
    variable = component.variable(name)
    if not variable.settable:
        raise TouchdownError(f"{name} has the causality {variable.causality} and cannot be set")
    return variable


def _number(component: Component, name: str) -> Variable:
    variable = component.variable(name)
    if variable.kind not in NUMBERS:
        raise TouchdownError(f"{name} is of the type {variable.kind}; only numbers can be compared")
    return variable
