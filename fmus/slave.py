"""The one slave class: an FMU around any `modelkit.model.Model`.

What pythonfmu leaves open is closed here. Only an exception makes its C++ side answer a call with an
error, and the references that its clean-up drops twice are held once more; False is for steps that a
smaller one could take the place of, which the host hears as discarded. The whole state of an instance is
one block of memory, so saving it is copying bytes; what follows from the parameters in it is derived again
where they are others. Vectors are answered whole.
"""

from __future__ import annotations

import ctypes
import math
import struct
import sys
import traceback
import zlib
from pathlib import Path
from typing import Any, ClassVar, NoReturn
from weakref import WeakSet
from xml.etree.ElementTree import Element

import numpy as np
from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from ..modelkit.errors import TouchdownError
from ..modelkit.instance import Instance
from ..modelkit.model import Model, StepSizeError
from ..modelkit.variables import Causality, Scalar
from . import fmu_messages
from .description.described_variables import guid
from .description.fmi2 import describe_fmi2

AT_START = (Causality.PARAMETER, Causality.INPUT)  # what can be set before the first step
READABLE = (*AT_START, Causality.OUTPUT)
NEW, INITIALISING, STEPPING, ENDED = b"0", b"1", b"2", b"3"  # where an instance is in its life
_LIFE = struct.Struct("<c?3d")  # phase, failed, start time, stop time, end of the last step
_CHECK = struct.Struct("<I")  # what serialised states end with: their checksum
TIME_TOLERANCE = 1e-2  # of a step: how far it may begin from the end of the last one


class ModelSlave(Fmi2Slave):
    """FMU of the model named by the class attribute `model`."""

    model: ClassVar[Model]
    _living: ClassVar[WeakSet[ModelSlave]] = WeakSet()

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not self.instance_name.strip():
            raise RuntimeError(fmu_messages.NO_NAME)
        self.description = self.model.about
        self._instance = Instance(self.model)
        self._identity = guid(self.model).encode()
        self._stores = {Scalar.REAL: self._instance.words, Scalar.INTEGER: self._instance.words.view("i8")}
        self._tunable = {s.index for s in self._instance.slots if s.variable.spec.tunable}
        self._known: dict[tuple[object, ...], np.ndarray] = {}  # vectors of value references checked before
        self._last: dict[tuple[str, str], tuple[list[int], np.ndarray]] = {}
        self._phase = NEW
        self._end = 0.0  # s, of the last step
        self._stale = True  # outputs do not yet follow from what was set
        self._failed = ""
        self._start_time = 0.0
        self._stop_time = math.nan  # what the host announced; no number before it set the experiment up
        self._living.add(self)
        if self.resources:
            folder = str(self.resources)  # pythonfmu lists it in the search path for every instance
            while sys.path.count(folder) > 1:
                sys.path.remove(folder)
            _release_at_exit(Path(self.resources), type(self).__name__)

    # -- description ---------------------------------------------------------------------------------

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """modelDescription.xml with units, bounds, dependencies and initial unknowns."""
        return describe_fmi2(self.model, type(self).__name__, self.log_categories)

    # -- life cycle ----------------------------------------------------------------------------------

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:
        if self._phase != NEW:
            self._raise(fmu_messages.SETUP_LATE)
        if not math.isfinite(start_time):
            self._raise(fmu_messages.NO_START.format(time=start_time))
        stop = math.inf if stop_time is None else stop_time
        if not stop > start_time:
            self._raise(fmu_messages.NO_STOP.format(stop=stop, start=start_time))
        self._start_time, self._stop_time = start_time, stop

    def enter_initialization_mode(self) -> None:
        if self._phase != NEW:
            self._raise(fmu_messages.ENTERED_TWICE)
        if math.isnan(self._stop_time):
            self._raise(fmu_messages.NOT_SET_UP)
        self._phase = INITIALISING

    def exit_initialization_mode(self) -> None:
        if self._phase != INITIALISING:
            self._raise(fmu_messages.NOT_ENTERED)
        if self._failed:
            self._stop_again()
        problem = self._refresh()
        if problem:
            self._raise(problem)
        self._phase, self._end = STEPPING, self._start_time
        self._forget()

    def do_step(self, current_time: float, step_size: float) -> bool:
        if self._failed:
            self._stop_again()
        if self._phase != STEPPING:
            self._raise(fmu_messages.ENDED if self._phase == ENDED else fmu_messages.NOT_STARTED)
        if abs(current_time - self._end) > TIME_TOLERANCE * step_size:
            self._raise(fmu_messages.APART.format(time=current_time, step=step_size, end=self._end))
        if current_time + step_size > self._stop_time + TIME_TOLERANCE * step_size:
            self._raise(
                fmu_messages.PAST_STOP.format(time=current_time, step=step_size, stop=self._stop_time)
            )
        problem = ""
        try:
            self._instance.step(current_time, step_size)
        except StepSizeError as error:
            self._fail(str(error), Fmi2Status.discard)
            return False
        except TouchdownError as error:
            problem = str(error)
        except Exception:
            problem = traceback.format_exc()
        if problem:
            self._raise(problem)
        self._end = current_time + step_size
        return True

    def terminate(self) -> None:
        if self._phase != STEPPING:
            self._raise(fmu_messages.NOT_TO_END)
        self._phase = ENDED

    # -- variables -----------------------------------------------------------------------------------

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        self._set(Scalar.REAL, vrs, values)

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        self._set(Scalar.INTEGER, vrs, values)

    def get_real(self, vrs: list[int]) -> list[float]:
        return self._get(Scalar.REAL, vrs)

    def get_integer(self, vrs: list[int]) -> list[int]:
        return self._get(Scalar.INTEGER, vrs)

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        self._absent(fmu_messages.SET_LATE, vrs, "boolean")

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        self._absent(fmu_messages.SET_LATE, vrs, "string")

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        return self._absent(fmu_messages.UNREADABLE, vrs, "boolean")

    def get_string(self, vrs: list[int]) -> list[str]:
        return self._absent(fmu_messages.UNREADABLE, vrs, "string")

    def _absent(self, refusal: str, vrs: list[int], kind: str) -> list[Any]:
        """There are no booleans and no strings."""
        if vrs:
            self._raise(refusal.format(names=self._misfits(Scalar.REAL, vrs, ()), kind=kind))
        return []

    def _set(self, kind: Scalar, vrs: list[int], values: list[Any]) -> None:
        places, tuning = self._places("set", kind, vrs), False
        if places is None:
            late = self._phase >= STEPPING
            wrong = self._misfits(kind, vrs, AT_START, late)
            if wrong:
                self._raise(fmu_messages.SET_LATE.format(names=wrong, kind=kind))
            tuning = late and not self._tunable.isdisjoint(vrs)
            places = np.array(vrs, dtype=np.intp)
            if not tuning:  # which is rare, and looked at each time
                self._known[("set", kind, *vrs)] = places
        self._stores[kind][places] = values
        self._stale = True
        if tuning:
            self._instance.tune()

    def _get(self, kind: Scalar, vrs: list[int]) -> list[Any]:
        places = self._places("get", kind, vrs)
        if places is None:
            wrong = self._misfits(kind, vrs, READABLE)
            if wrong:
                self._raise(fmu_messages.UNREADABLE.format(names=wrong, kind=kind))
            places = self._known[("get", kind, *vrs)] = np.array(vrs, dtype=np.intp)
        if self._phase < STEPPING:
            self._compute_early(self._misfits(kind, vrs, AT_START))
        return self._stores[kind][places].tolist()

    def _compute_early(self, outputs: str) -> None:
        """See that `outputs` (names) have values before initialisation is complete."""
        if outputs and self._phase == NEW:
            self._raise(fmu_messages.READ_EARLY.format(names=outputs))
        if outputs and self._stale:
            problem = self._refresh()
            if problem:
                self._raise(problem)

    def _places(self, access: str, kind: Scalar, vrs: list[int]) -> np.ndarray | None:
        """Where a vector of value references that was checked before lies in the memory.

        Mostly it is the one that came last: comparing lists is cheaper than looking a long one up.
        """
        last = self._last.get((access, kind))
        if last is not None and last[0] == vrs:
            return last[1]
        places = self._known.get((access, kind, *vrs))
        if places is not None:
            self._last[access, kind] = (list(vrs), places)
        return places

    def _forget(self) -> None:
        """Forget which values may be set: that has changed."""
        self._known.clear()
        self._last.clear()

    def _misfits(
        self, kind: Scalar, vrs: list[int], causes: tuple[Causality, ...], late: bool = False
    ) -> str:
        """Names of the variables among `vrs` that are not of this kind and these causalities.

        late: nor may parameters be that are not tunable.
        """
        slots = {s.index: s for s in self._instance.slots}
        wrong: list[str] = []
        for i in sorted({vr % 2**32 for vr in vrs}):  # unsigned, as FMI has them
            slot = slots.get(i)
            if slot is None:
                wrong.append(fmu_messages.UNKNOWN.format(number=i))
                continue
            fixed = late and slot.causality is Causality.PARAMETER and i not in self._tunable
            if slot.variable.spec.kind is not kind or slot.causality not in causes or fixed:
                wrong.append(slot.variable.name)
        return ", ".join(wrong)

    # -- state ---------------------------------------------------------------------------------------

    def _get_fmu_state(self) -> bytes:  # type: ignore[override]
        life = _LIFE.pack(self._phase, bool(self._failed), self._start_time, self._stop_time, self._end)
        return b"".join((self._identity, life, self._instance.state))

    def _set_fmu_state(self, state: bytes) -> None:  # type: ignore[override]
        identity = self._identity
        head = len(identity) + _LIFE.size
        if len(state) != head + len(self._instance.state) or not state.startswith(identity):
            self._raise(fmu_messages.FOREIGN_STATE)
        life, announced = _LIFE.unpack_from(state, len(identity)), self._stop_time
        self._phase, failed, self._start_time, self._stop_time, self._end = life
        if math.isfinite(announced):  # by this instance's host; the state may be of a shorter run
            self._stop_time = announced
        self._instance.restore(memoryview(state)[head:])
        self._stale = self._phase < STEPPING
        self._failed = self._failed or fmu_messages.FAILED_STATE if failed else ""
        self._forget()

    @classmethod
    def _fmu_state_to_bytes(cls, state: bytes) -> bytes:  # type: ignore[override]
        return state + _CHECK.pack(zlib.crc32(state))

    @classmethod
    def _fmu_state_from_bytes(cls, state: bytes) -> bytes:  # type: ignore[override]
        content, noted = state[: -_CHECK.size], state[-_CHECK.size :]
        if noted != _CHECK.pack(zlib.crc32(content)) or not content.startswith(guid(cls.model).encode()):
            for slave in cls._living:  # pythonfmu asks the class and releases one of its instances
                if type(slave) is cls:
                    slave._outlive_release()
            raise RuntimeError(fmu_messages.FOREIGN_STATE)
        return content

    # -- failure -------------------------------------------------------------------------------------

    def _refresh(self) -> str:
        """Compute state and outputs from parameters and inputs; returns what is wrong, or ""."""
        try:
            self._instance.start(self._start_time)
        except TouchdownError as error:
            return str(error)
        except Exception:
            return traceback.format_exc()
        self._stale = False
        return ""

    def _fail(self, message: str, status: Fmi2Status = Fmi2Status.error) -> None:
        """Log the message and keep it: a failed instance does not go on."""
        self._failed = message.strip().splitlines()[-1]
        self.log(message, status)

    def _raise(self, message: str) -> NoReturn:
        """Fail, and answer the call with an error."""
        self._fail(message)
        self._outlive_release()
        raise RuntimeError(message)

    def _stop_again(self) -> NoReturn:
        """Answer with an error that it failed before."""
        message = fmu_messages.STOPPED.format(why=self._failed)
        self.log(message, Fmi2Status.error)
        self._outlive_release()
        raise RuntimeError(message)

    def _outlive_release(self) -> None:
        """Take references for an exception to release.

        pythonfmu answers one by releasing class, instance and log, and releases them again with the
        instance, which would free freed memory.
        """
        for kept in (type(self), self, self.log_queue):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(kept))


_ending: set[Path] = set()  # libraries that end the interpreter of a host without Python


def _release_at_exit(resources: Path, identifier: str) -> None:
    """See that pythonfmu's library frees its interpreter once when the process ends.

    The library keeps a handle on the interpreter that a static destructor and a library destructor both
    release, which aborts or crashes most processes. In a Python program the handle is of no use and can go
    at once. Elsewhere it ends the interpreter, so it goes before all else when the process ends; the
    library stays loaded until then, with every host.
    """
    if not sys.platform.startswith("linux"):
        return
    binary = resources.parent / "binaries" / "linux64" / f"{identifier}.so"
    try:
        library = ctypes.PyDLL(str(binary), mode=ctypes.RTLD_LOCAL | 4)  # RTLD_NOLOAD: only if loaded
        release = library.finalizePythonInterpreter
    except (OSError, AttributeError):
        return
    if sys.orig_argv:  # a Python program
        release()
    elif binary not in _ending:
        _ending.add(binary)
        at_exit = ctypes.CDLL(None).__cxa_atexit
        at_exit.argtypes = [ctypes.c_void_p] * 3
        at_exit(ctypes.cast(release, ctypes.c_void_p), None, None)
