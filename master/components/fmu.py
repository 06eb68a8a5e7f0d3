"""FMI 2.0: a component that is an FMU in this process, driven through fmpy.

Values travel through arrays allocated once, and the FMI functions are called with their addresses, so a
call costs only the crossing.
"""

from __future__ import annotations

import ctypes
import os
import weakref
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2CoSimulation,
    fmi2False,
    fmi2True,
)

from ...modelkit.variables import Causality, Variability
from ..common.errors import TouchdownError
from .component import (
    GAINS,
    WHOLE,
    ByFunctions,
    Call,
    Component,
    FmiType,
    InMemory,
    ScalarVariable,
    Setting,
    fill_values,
)
from .description import (
    defined_units,
    made_by_pythonfmu,
    read_description,
    seconds,
    steps_of,
    variables_of,
)
from .log import FmuLog, allocators, compiled, one_line
from .unpack import unpack

OK, WARNING = 0, 1
DISCARD = 2  # fmi2Status
TERMINATED = 3  # fmi2StatusKind: whether the FMU ended the simulation
STATUS = ("OK", "warning", "discard", "error", "fatal", "pending")


def _resources(folder: Path, description: Any) -> str:
    """URI of an unpacked FMU's resources.

    pythonfmu's library knows %20 for a space and reads all other text literally; without a folder of
    that name it crashes.
    """
    path = (folder / "resources").absolute()
    if not made_by_pythonfmu(description):
        return path.as_uri()
    if "%20" in str(path):
        raise TouchdownError(f"pythonfmu cannot read {path}: it has %20 in it; set another TOUCHDOWN_CACHE")
    return f"file://{path}"


def _release_interpreter(library: ctypes.CDLL) -> None:
    """Let pythonfmu's library release the interpreter, which this process owns.

    Its handle is released by a static destructor and again by a destructor of the library, which aborts
    some processes when they end (NTNU-IHB/PythonFMU, issue 229); after this call only the first one acts.
    """
    release = getattr(library, "finalizePythonInterpreter", None)
    if release is not None:
        release()


TYPES = (("Real", (FmiType.REAL,), "f8"), ("Integer", WHOLE, "i4"), ("Boolean", (FmiType.BOOLEAN,), "i4"))
"""In the names of FMI 2.0's functions, which kinds they are for, and numpy's name of the values."""


class _Function(NamedTuple):
    """A function that hands over or fetches values of one type."""

    title: str
    call: Callable[..., int]
    kinds: Sequence[FmiType]
    dtype: str  # numpy's name of its values


class _Exchange(NamedTuple):
    """A call that fetches or hands over all values of one type; arrays must outlive their addresses."""

    function: _Function
    places: np.ndarray  # where the values go, or come from
    references: np.ndarray
    data: np.ndarray
    reference_address: int  # address of `references`
    data_address: int  # address of `data`


def _address(held: Any) -> int:
    """Address of a function, or of the object that a ctypes pointer points to."""
    return ctypes.cast(held, ctypes.c_void_p).value or 0


def _step_from(time: float) -> str:
    return f"{Call.STEP} from t = {time:.9g} s"


class ArchivedFmu(Component):
    """A component that is an FMU in a file, stepped in this process or in another."""

    def __init__(self, name: str, path: Path, cache: Path, origin: str) -> None:
        self.folder = unpack(path, cache)
        self.description = read_description(path, self.folder)
        super().__init__(name, origin or str(path), variables_of(self.description))
        self.foreign = not origin
        self.third_party = not str(self.description.generationTool).startswith("touchdown-cosim")
        self._names: Sequence[str] = ()  # of what it gives
        self._stepped_to = 0.0  # s
        able = self.description.coSimulation
        self.tool = (  # that it cannot run without, where it says so
            self.description.generationTool or "the tool that made it" if able.needsExecutionTool else ""
        )
        self.can_save = bool(able.canGetAndSetFMUstate)
        self.can_serialise = self.can_save and bool(able.canSerializeFMUstate)
        self.any_step = bool(able.canHandleVariableCommunicationStepSize)
        self.declared_constant = [v.name for v in self.variables.values() if _doubtful(v)]
        if self.foreign:
            self.variables = {name: _exchanged(v) for name, v in self.variables.items()}
            experiment = self.description.defaultExperiment
            self.inner_step, self.made_for_step = steps_of(self.description)
            self.stop_time = seconds(experiment.stopTime if experiment else None)
        self.units = defined_units(self.description)
        self.path, self._cache, self._own_origin = path, cache, origin


def _doubtful(variable: ScalarVariable) -> bool:
    constant = (variable.causality, variable.variability) == (Causality.OUTPUT, Variability.CONSTANT)
    return constant and variable.name.rpartition(".")[2] not in GAINS


def _exchanged(variable: ScalarVariable) -> ScalarVariable:
    """An output declared constant as one that can change, which tools mean: pythonfmu's tables, for one.

    What a body is held by, constant by its nature, stays so.
    """
    if not _doubtful(variable):
        return variable
    real = variable.kind is FmiType.REAL
    return replace(variable, variability=Variability.CONTINUOUS if real else Variability.DISCRETE)


_once: weakref.WeakValueDictionary[Path, LoadedFmu] = weakref.WeakValueDictionary()
"""FMUs in this process that can be instantiated once in a process, by their folders."""


def ignore_call(_: str) -> None:
    """Ignore the name of a call."""


class LoadedFmu(ArchivedFmu):
    """An FMU of any version of FMI that is loaded into this process.

    `origin` names one of the project's own. on_call(name) is called before each rare call.
    """

    EXCHANGE: ClassVar[tuple[str, str, str]]  # names of the functions that set inputs, step and get outputs
    ENDING: ClassVar[tuple[str, str]]  # names of the functions that terminate an instance, and free it
    STATES: ClassVar[tuple[str, str, str]]  # and that save, restore and free its states
    SERIALISED: ClassVar[tuple[str, str]]  # fmpy's names of those that make bytes of a state, and back
    SET_TEXT: ClassVar[str]  # and that sets Strings

    def __init__(
        self,
        name: str,
        path: Path,
        cache: Path,
        origin: str = "",
        on_call: Callable[[str], object] = ignore_call,
    ) -> None:
        super().__init__(name, path, cache, origin)
        self._on_call = on_call
        self._log = FmuLog()
        self._open = self._stepping = False
        if self.description.coSimulation.canBeInstantiatedOnlyOncePerProcess:
            other = _once.get(self.folder)
            if other is not None and other._open:
                raise TouchdownError(
                    f"cannot load {path} as {name}: it can be instantiated only once in a process, and is "
                    f"{other.name} already; leave out isolate = false, so that each has a process"
                )
            _once[self.folder] = self
        folder = Path.cwd()
        try:
            on_call("loading its library")
            self._fmu = self._load()
        except Exception as error:
            os.chdir(folder)  # fmpy leaves the library's folder current where loading fails
            needs = f"; it needs {self.tool} (needsExecutionTool)" if self.tool else ""
            reason = self._reason(str(error))
            raise TouchdownError(f"cannot load {path} as {name}: {reason}{needs}") from None
        self._open = True
        self._component = self._fmu.component

    def _load(self) -> Any:
        """fmpy's wrapper of the library, with an instance."""
        raise NotImplementedError

    def _wrapped(self, wrapper: type) -> Any:
        """fmpy's wrapper of the library, which is loaded."""
        return wrapper(
            guid=self.description.guid,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            unzipDirectory=str(self.folder),
            instanceName=self.name,
        )

    def second(self) -> LoadedFmu:
        second = type(self)(f"{self.name} (witness)", self.path, self._cache, self._own_origin)
        second.rename(self._own)
        return second

    def save(self) -> object:
        state = ctypes.c_void_p()
        self._state(0, "saving its state", ctypes.byref(state))
        return state

    def restore(self, state: object) -> None:
        self._state(1, "restoring its state", state)

    def release(self, state: object) -> None:
        assert isinstance(state, ctypes.c_void_p)
        self._state(2, "freeing a state", ctypes.byref(state))

    def to_bytes(self) -> bytes:
        state, found = self.save(), list[bytes]()
        make = getattr(self._fmu, self.SERIALISED[0])
        self._guard("serialising its state", self.SERIALISED[0], lambda: found.append(make(state)))
        self.release(state)
        return found[0]

    def from_bytes(self, state: bytes, tuned: Mapping[str, Setting]) -> None:
        found, make = list[object](), getattr(self._fmu, self.SERIALISED[1])
        self._guard("taking a state", self.SERIALISED[1], lambda: found.append(make(state)))
        self.restore(found[0])
        self.release(found[0])
        self.set(tuned)

    def _state(self, which: int, doing: str, state: Any) -> None:
        name = self.STATES[which]
        self._guard(doing, name, partial(getattr(self._fmu, name), self._component, state))

    def close(self) -> str:
        if not self._open:
            return ""
        self._open = False
        problem = ""
        terminate, free = self.ENDING
        try:
            if self._stepping:
                self._guard("terminating", terminate, self._fmu.terminate)
        except TouchdownError as error:
            problem = str(error)
        self._on_call(free)
        getattr(self._fmu, free)(self._component)
        return problem

    # -- values --------------------------------------------------------------------------------------

    def set(self, values: Mapping[str, Setting]) -> None:
        texts = {name: value for name, value in values.items() if isinstance(value, str)}
        if texts:
            self._set_texts(texts)
        self._set_numbers({name: value for name, value in values.items() if not isinstance(value, str)})

    def _set_numbers(self, values: Mapping[str, float]) -> None:
        raise NotImplementedError

    def _set_texts(self, texts: Mapping[str, str]) -> None:
        """Set Strings; an array of FMI 3.0 has one reference, and is set whole."""
        strings = [v for v in self.variables.values() if v.kind is FmiType.STRING]
        by_reference: dict[int, dict[int, str]] = {}  # by reference and element
        for name, text in texts.items():
            by_reference.setdefault(self.variable(name).reference, {})[self.variable(name).element] = text
        for v in strings:
            if v.element not in by_reference.get(v.reference, {v.element: ""}):
                raise TouchdownError(f"{self.name}.{v.name} is not set, and others of its array are")
        values = [of_one[element] for of_one in by_reference.values() for element in sorted(of_one)]
        call = partial(self._fmu.setString, list(by_reference), values)
        self._guard("setting values", self.SET_TEXT, call)

    # -- failure -------------------------------------------------------------------------------------

    def _check_finite(self) -> None:
        """Raise TouchdownError where an exchanged output of a third-party FMU is not finite.

        During initialisation outputs may lack what they follow from.
        """
        if not (self.foreign and self._stepping) or np.isfinite(self.outputs.sum()):
            return
        outputs = zip(self._names, self.outputs, strict=True)
        wrong = [f"{name} = {value}" for name, value in outputs if not np.isfinite(value)]
        if wrong:  # the sum of finite numbers may overflow
            self._stepping = False
            raise TouchdownError(
                f"component {self.name}: its FMU gives {', '.join(wrong)} at t = {self._stepped_to:.9g} s"
            )

    def _guard(self, doing: str, name: str, call: Callable[[], object]) -> None:
        self._on_call(name)
        try:
            call()
        except Exception as error:
            self._stepping = False
            raise TouchdownError(
                f"component {self.name}: {self._reason(str(error))} (while {doing})"
            ) from None

    def _check(self, status: int, doing: str) -> None:
        if not OK <= status <= WARNING:
            self._stepping = False
            if status == DISCARD and not list(self._log) and self._ended_itself():
                raise TouchdownError(f"component {self.name}: its FMU ended the simulation (while {doing})")
            known = DISCARD <= status < len(STATUS)
            answer = f"'{STATUS[status]}'" if known else f"{status}, which is not a status of FMI,"
            reason = self._reason(f"it answered {answer} and gave no reason")
            if status == DISCARD:
                reason += "; it may not take a step of this length, try another run.macro_step"
            raise TouchdownError(f"component {self.name}: {reason} (while {doing})")

    def _ended_itself(self) -> bool:
        """Whether an FMU that discarded a step takes no more; those of FMI 3.0 say so in the step."""
        return False

    def _reason(self, fallback: str) -> str:
        """The last message of the FMU that people can read."""
        texts = [message.text for message in self._log if message.text]
        spoken = [text for text in texts if not text.startswith("Fatal py exception")]
        if made_by_pythonfmu(self.description):  # of a traceback the last line has the reason
            spoken = [line for text in spoken[-1:] for line in text.splitlines()[-1:]]
        return one_line((spoken or texts or [fallback])[-1])

    def warned(self) -> str:
        return self._log.warned()


class FmuComponent(LoadedFmu):
    """An FMU of FMI 2.0 that is stepped in this process."""

    EXCHANGE = ("fmi2SetReal", "fmi2DoStep", "fmi2GetReal")
    ENDING = ("fmi2Terminate", "fmi2FreeInstance")
    STATES = ("fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate")
    SERIALISED = ("serializeFMUstate", "deSerializeFMUstate")
    SET_TEXT = "fmi2SetString"
    _in: tuple[int, int, int] = (0, 0, 0)  # places and number of what it takes: references, values
    _out: tuple[int, int, int] = (0, 0, 0)  # and gives
    _taken: Sequence[_Exchange] = ()  # what it takes, where some is not Real
    _given: Sequence[_Exchange] = ()

    def _ended_itself(self) -> bool:
        ended = ctypes.c_int(0)
        asked = getattr(self._fmu.dll, "fmi2GetBooleanStatus", None)
        if asked is None:
            return False
        asked.argtypes, asked.restype = (ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p), ctypes.c_int
        return asked(self._component, TERMINATED, ctypes.byref(ended)) == 0 and ended.value != 0

    def _load(self) -> Any:
        self._fmu = self._wrapped(FMU2Slave)
        self._callbacks = self._make_callbacks()
        self._instantiate(_resources(self.folder, self.description))
        self._bind_functions()
        return self._fmu

    def _instantiate(self, resources: str) -> None:
        self._on_call("fmi2Instantiate")
        try:
            self._fmu.component = self._fmu.fmi2Instantiate(
                self.name.encode(),
                fmi2CoSimulation,
                self._fmu.guid.encode(),
                resources.encode("utf-8", "surrogateescape"),
                ctypes.byref(self._callbacks),
                fmi2False,
                fmi2True,
            )
        finally:
            _release_interpreter(self._fmu.dll)
        if self._fmu.component is None:
            raise RuntimeError("it gave no instance")

    def _make_callbacks(self) -> fmi2CallbackFunctions:
        """In compiled code: the FMU may call them from threads of its own, while Python is locked."""
        loggers = compiled().addresses  # pythonfmu hands over whole messages, where a % is a %
        logger = loggers["plain" if made_by_pythonfmu(self.description) else "fmi2"]
        allocate, free = allocators()
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(logger)
        callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(allocate)
        callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        callbacks.componentEnvironment = self._log.address
        return callbacks

    def _bind_functions(self) -> None:
        """The FMI functions of the step, called with plain addresses.

        Python is not unlocked for a pythonfmu FMU, which runs in this interpreter and would lock it again
        at once, nor for the project's own, whose calls are short.
        """
        pointer, size, real, integer = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_double, ctypes.c_int
        unlocks = self.foreign and not made_by_pythonfmu(self.description)
        function = ctypes.CFUNCTYPE if unlocks else ctypes.PYFUNCTYPE
        exchange, step = (
            function(integer, pointer, pointer, size, pointer),
            function(integer, pointer, real, real, integer),
        )

        def functions(verb: str) -> list[_Function]:
            return [
                _Function(f"fmi2{verb}{name}", exchange((f"fmi2{verb}{name}", self._fmu.dll)), kinds, dtype)
                for name, kinds, dtype in TYPES
            ]

        self._setters, self._getters = functions("Set"), functions("Get")
        self._set_real = self._setters[0].call
        self._get_real, self._get_integer, self._get_boolean = (f.call for f in self._getters)
        self._do_step = step(("fmi2DoStep", self._fmu.dll))

    # -- values --------------------------------------------------------------------------------------

    def _references(self, names: Sequence[str]) -> np.ndarray:
        return np.array([self.variable(n).reference for n in names], dtype=np.uint32)

    def _set_numbers(self, values: Mapping[str, float]) -> None:
        names, numbers = list(values), np.array(list(values.values()), float)
        for exchange in self._exchanges(names, self._setters):
            self._on_call(exchange.function.title)
            self._hand_over(exchange, names, numbers, "setting values")

    def _hand_over(
        self, exchange: _Exchange, names: Sequence[str], values: np.ndarray, doing: Call | str
    ) -> None:
        """Hand over those of `values`, (n,) of the variables called `names`, of the exchange's type."""
        function, places, references, data, reference_address, data_address = exchange
        fill_values(self, names, places, values[places], data)
        self._check(function.call(self._component, reference_address, len(references), data_address), doing)

    def _exchanges(self, names: Sequence[str], functions: Sequence[_Function]) -> list[_Exchange]:
        """The functions that exchange the variables called `names`, type by type."""
        found: list[_Exchange] = []
        for f in functions:
            places = np.array([i for i, n in enumerate(names) if self.variable(n).kind in f.kinds], np.intp)
            if len(places):
                references, data = (
                    self._references([names[int(i)] for i in places]),
                    np.zeros(len(places), f.dtype),
                )
                addresses = references.ctypes.data, data.ctypes.data
                found.append(_Exchange(f, places, references, data, *addresses))
        return found

    def _typed(self, names: Sequence[str], functions: Sequence[_Function]) -> list[_Exchange]:
        """`_exchanges` of variables of which some are not Real; where all are, none is needed."""
        mixed = any(self.variable(n).kind is not FmiType.REAL for n in names)
        return self._exchanges(names, functions) if mixed else []

    def bind(self, inputs: Sequence[str], outputs: np.ndarray, names: Sequence[str]) -> None:
        self.inputs = np.zeros(len(inputs))
        self.outputs = outputs
        self._inputs, self._names = inputs, names
        self._taken, self._given = self._typed(inputs, self._setters), self._typed(names, self._getters)
        real_inputs, real_names = (() if self._taken else inputs), (() if self._given else names)
        self._held = self._references(real_inputs), self._references(real_names)
        self._in = self._held[0].ctypes.data, len(real_inputs), self.inputs.ctypes.data
        self._out = self._held[1].ctypes.data, len(real_names), outputs.ctypes.data

    def push(self) -> None:
        status = self._set_real(self._component, *self._in)
        if not OK <= status <= WARNING:
            self._check(status, Call.SET)
        for exchange in self._taken:
            self._hand_over(exchange, self._inputs, self.inputs, Call.SET)

    def pull(self) -> None:
        status = self._get_real(self._component, *self._out)
        if not OK <= status <= WARNING:
            self._check(status, Call.GET)
        if self._given:
            self._fetch(self._given, self.outputs, Call.GET)
        self._check_finite()

    def _fetch(self, exchanges: Sequence[_Exchange], values: np.ndarray, doing: Call) -> None:
        for function, places, references, data, reference_address, data_address in exchanges:
            status = function.call(self._component, reference_address, len(references), data_address)
            if not OK <= status <= WARNING:
                self._check(status, doing)
            boolean = FmiType.BOOLEAN in function.kinds
            values[places] = data != 0 if boolean else data  # some FMUs give -1 or 255 for true

    def by_address(self) -> InMemory | ByFunctions | None:
        """Compiled code holds the GIL, as these calls do: pythonfmu's FMUs find it as they do here.

        What it exchanges is Real.
        """
        if self._taken or self._given:
            return None
        inputs, outputs = self._held
        return ByFunctions(
            component=_address(self._component),
            set_real=_address(self._set_real),
            do_step=_address(self._do_step),
            get_real=_address(self._get_real),
            get_integer=_address(self._get_integer),
            get_boolean=_address(self._get_boolean),
            taken=inputs,
            given=outputs,
            checked=self.foreign,
            any_thread=not (self.foreign or made_by_pythonfmu(self.description)),
        )

    def refuse(self, call: Call, status: int, time: float, step: float) -> None:
        self._stepped_to = time + step
        self._check_finite()  # outputs that are not finite: the FMU itself reported success
        self._check(status, _step_from(time) if call is Call.STEP else call)

    def reader(self, names: Sequence[str]) -> Callable[[], np.ndarray]:
        values, exchanges = np.zeros(len(names)), self._exchanges(names, self._getters)

        def fetch() -> np.ndarray:
            self._fetch(exchanges, values, Call.FETCH)
            return values

        return fetch

    # -- life cycle ----------------------------------------------------------------------------------

    def enter(self, start_time: float, stop_time: float | None = None) -> None:
        setup = partial(self._fmu.setupExperiment, startTime=start_time, stopTime=stop_time)
        self._guard("initialising", "fmi2SetupExperiment", setup)
        enter = self._fmu.enterInitializationMode
        self._guard("initialising", "fmi2EnterInitializationMode", enter)

    def exit(self) -> None:
        self._guard("initialising", "fmi2ExitInitializationMode", self._fmu.exitInitializationMode)
        self._stepping = True

    def step(self, time: float, step: float) -> None:
        status = self._do_step(self._component, time, step, 1)
        if not OK <= status <= WARNING:
            self._check(status, _step_from(time))
        self._stepped_to = time + step
