"""A component that is an FMU of FMI 3.0 in this process, driven through fmpy.

Its arrays are one scalar for each element. FMI 3.0 hands arrays over whole, so values travel in vectors,
one for each type of number, and elements that nothing feeds keep their start values.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.fmi3 import (
    FMU3Slave,
    fmi3IntermediateUpdateCallback,
    fmi3LogMessageCallback,
    fmi3ValueReference,
)

from ..common.errors import TouchdownError
from .component import MAX_EXACT_INTEGER, READABLE, Call, fill_values
from .description import fmi_version
from .fmu import OK, WARNING, FmuComponent, LoadedFmu, ignore_call
from .log import compiled

NUMBERS = {  # types of FMI 3.0: whose functions take them, and numpy's name
    "Float64": ("Float64", "f8"),
    "Float32": ("Float32", "f4"),
    **{f"Int{bits}": (f"Int{bits}", f"i{bits // 8}") for bits in (8, 16, 32, 64)},
    **{f"UInt{bits}": (f"UInt{bits}", f"u{bits // 8}") for bits in (8, 16, 32, 64)},
    "Boolean": ("Boolean", "?"),
    "Enumeration": ("Int64", "i8"),
}


@dataclass(frozen=True)
class _Vector:
    """Values of one type, of all elements of the variables that are asked for."""

    get: Callable[..., int]
    set: Callable[..., int]
    references: np.ndarray  # (m,) uint32
    data: np.ndarray  # (n,) of that type
    places: np.ndarray  # where in `data` the scalars are that were asked for
    which: np.ndarray  # their places among the scalars that were asked for

    @property
    def exact(self) -> bool:
        """Whether float64 holds all its values exactly."""
        return self.data.dtype.itemsize < 8 or self.data.dtype.kind == "f"

    @property
    def arguments(self) -> tuple[int, int, int, int]:
        """Of either function, behind the instance."""
        return self.references.ctypes.data, len(self.references), self.data.ctypes.data, len(self.data)


class _Fmu3Component(LoadedFmu):
    """An FMU of FMI 3.0 that is stepped in this process."""

    EXCHANGE = ("fmi3Set", "fmi3DoStep", "fmi3Get")
    ENDING = ("fmi3Terminate", "fmi3FreeInstance")
    STATES = ("fmi3GetFMUState", "fmi3SetFMUState", "fmi3FreeFMUState")
    SERIALISED = ("serializeFMUState", "deserializeFMUState")
    SET_TEXT = "fmi3SetString"

    def _load(self) -> Any:
        fmu = self._wrapped(FMU3Slave)
        self._on_call("fmi3InstantiateCoSimulation")
        fmu.component = fmu.fmi3InstantiateCoSimulation(
            self.name.encode(),
            fmu.guid.encode(),
            f"{self.folder / 'resources'}{os.sep}".encode("utf-8", "surrogateescape"),
            *(False, True, False, False),  # not visible, but logging; neither events nor early returns
            (fmi3ValueReference * 0)(),
            0,
            self._log.address,
            fmi3LogMessageCallback(compiled().addresses["fmi3"]),
            fmi3IntermediateUpdateCallback(),
        )
        if not fmu.component:
            raise RuntimeError("it gave no instance")
        self._types = {v.valueReference: NUMBERS.get(v.type) for v in self.description.modelVariables}
        self._elements: dict[int, list[float]] = {}  # start values, by reference
        for v in self.variables.values():
            starts = self._elements.setdefault(v.reference, [])
            if v.element == len(starts):  # an alias has the reference of another variable
                starts.append(v.start or 0.0)
        self._taken: list[_Vector] = []
        self._given: list[_Vector] = []
        self._said = [ctypes.c_bool() for _ in range(3)]
        self._reached = ctypes.c_double()
        return fmu

    # -- values --------------------------------------------------------------------------------------

    def _vectors(self, names: Sequence[str]) -> list[_Vector]:
        """Vectors that hold the variables called `names`; their data are start values."""
        by_type: dict[tuple[str, str], list[int]] = {}
        for index, name in enumerate(names):
            kind = self._types[self.variable(name).reference]
            if kind is None:
                what = f"{name} is of the type {self.variable(name).kind}"
                raise TouchdownError(f"component {self.name}: {what}; only numbers are exchanged")
            by_type.setdefault(kind, []).append(index)
        return [self._vector(*kind, names, which) for kind, which in by_type.items()]

    def _vector(self, kind: str, dtype: str, names: Sequence[str], which: list[int]) -> _Vector:
        chosen = [self.variable(names[i]) for i in which]
        first: dict[int, int] = {}
        values: list[float] = []
        for variable in chosen:
            if variable.reference not in first:
                first[variable.reference] = len(values)
                values += self._elements[variable.reference]
        get, give = (getattr(self._fmu.dll, f"fmi3{verb}{kind}") for verb in ("Get", "Set"))
        return _Vector(
            *(_exchange(function) for function in (get, give)),
            references=np.array(list(first), np.uint32),
            data=np.array(values).astype(dtype),
            places=np.array([first[v.reference] + v.element for v in chosen], np.intp),
            which=np.array(which, np.intp),
        )

    def _set_numbers(self, values: Mapping[str, float]) -> None:
        if not values:
            return
        self._on_call("fmi3Set")
        names = list(values)
        for vector in self._vectors(names):
            self._put(vector, names, np.array(list(values.values()), float))
            self._check(vector.set(self._component, *vector.arguments), "setting values")
            for reference in vector.references:  # inputs that nothing feeds keep these
                self._keep(int(reference), names, values)

    def _put(self, vector: _Vector, names: Sequence[str], values: np.ndarray) -> None:
        """Fill `vector` with those of `values`, (n,) of the variables called `names`, of its type."""
        held = np.zeros(len(vector.which), vector.data.dtype)
        fill_values(self, names, vector.which, values[vector.which], held)
        vector.data[vector.places] = held

    def _keep(self, reference: int, names: Sequence[str], values: Mapping[str, float]) -> None:
        for name in names:
            variable = self.variable(name)
            if variable.reference == reference:
                self._elements[reference][variable.element] = values[name]

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        self.inputs = np.zeros(len(inputs))
        self.outputs = outputs
        self._inputs, self._names = inputs, names
        self._taken, self._given = self._vectors(inputs), self._vectors(names)

    def push(self) -> None:
        for vector in self._taken:
            self._put(vector, self._inputs, self.inputs)
            self._check(vector.set(self._component, *vector.arguments), Call.SET)

    def pull(self) -> None:
        self._fetch(self._given, self.outputs, Call.GET)
        for vector in self._given:
            if not vector.exact:
                self._refuse_inexact(vector)
        self._check_finite()

    def _refuse_inexact(self, vector: _Vector) -> None:
        """Raise TouchdownError where float64 cannot hold a whole number exactly."""
        values = vector.data[vector.places]
        beyond = np.flatnonzero(
            (values > MAX_EXACT_INTEGER)
            | (values < (-MAX_EXACT_INTEGER if values.dtype.kind == "i" else 0))
        )
        if len(beyond):
            first = int(beyond[0])
            name = self._names[int(vector.which[first])]
            raise TouchdownError(
                f"component {self.name}: {name} = {values[first]} cannot be exchanged; whole numbers can "
                "up to 2^53"
            )

    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        numbers = [n for n in names if self.variable(n).kind in READABLE]
        values, vectors = np.zeros(len(names)), self._vectors(numbers)
        places = np.array([i for i, n in enumerate(names) if n in set(numbers)], np.intp)
        vectors = [_Vector(v.get, v.set, v.references, v.data, v.places, places[v.which]) for v in vectors]

        def fetch() -> np.ndarray:
            self._fetch(vectors, values, Call.FETCH)
            return values

        return fetch

    def _fetch(self, vectors: Sequence[_Vector], into: np.ndarray, doing: Call) -> None:
        for vector in vectors:
            status = vector.get(self._component, *vector.arguments)
            if not OK <= status <= WARNING:
                self._check(status, doing)
            into[vector.which] = vector.data[vector.places]

    # -- life cycle ----------------------------------------------------------------------------------

    def enter(self, start_time: float, stop_time: float | None = None) -> None:
        enter = partial(self._fmu.enterInitializationMode, startTime=start_time, stopTime=stop_time)
        self._guard("initialising", "fmi3EnterInitializationMode", enter)

    def exit(self) -> None:
        self._guard("initialising", "fmi3ExitInitializationMode", self._fmu.exitInitializationMode)
        self._stepping = True

    def step(self, time: float, step: float) -> None:
        """Raises TouchdownError also where it ends early: steps are neither divided nor repeated for it."""
        flags = [ctypes.byref(flag) for flag in (*self._said, self._reached)]
        do_step = partial(self._fmu.fmi3DoStep, self._component, time, step, True, *flags)
        self._guard(f"stepping from t = {time:.9g} s", "fmi3DoStep", do_step)
        _, ending, early = (flag.value for flag in self._said)
        if ending or early:
            self._stepping = not ending
            what = "asks for the end of the simulation" if ending else "returned early"
            raise TouchdownError(
                f"component {self.name}: its FMU {what} at t = {self._reached.value:.9g} s"
            )
        self._stepped_to = time + step


def _exchange(function: Any) -> Callable[..., int]:
    """A function that gets or sets values, called with plain addresses."""
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    address = ctypes.cast(function, ctypes.c_void_p).value or 0
    return ctypes.CFUNCTYPE(ctypes.c_int, pointer, pointer, size, pointer, size)(address)


def load_fmu(
    name: str, path: Path, cache: Path, origin: str = "", on_call: Callable[[str], object] = ignore_call
) -> LoadedFmu:
    """The FMU at `path`, of any version, in this process; `origin` names one of the project's own.

    Raises TouchdownError where it cannot be loaded.
    """
    third = not origin and fmi_version(path, cache).startswith("3.")
    return (_Fmu3Component if third else FmuComponent)(name, path, cache, origin, on_call)
