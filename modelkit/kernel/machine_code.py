"""Machine code of kernels, kept between processes or brought along by a wheel.

numba's own cache loads whatever its files hold: one flipped byte ends the process. Here a file holds the
code of one kernel for one signature behind a digest of it, under a name that both decide. A file that is
damaged, or is another signature's or another user's, counts as missing: the kernel is compiled again and
the file is replaced.

The installed sources, and those that travel in FMUs as a package of another name, share code where they
are the same: it is kept under the names that modules have in the installed package, and given to whichever
package asks for it.

Where this user has kept nothing, code that came with the installation is taken: a wheel for a platform
carries it in the same form. It was compiled for a plain processor, and is used where that processor's
instructions are available, for the very sources, numba and Python that it was made of. It lies beside the
sources of the installed `touchdown`, where the sources in an FMU find it, too. Who can change it can change
the sources, so it is trusted as they are. Its results are those of code compiled here, to the last bit:
nothing is reassociated or contracted, and wider instructions round as plain ones do.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import io
import os
import pickle
import platform
import sys
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numba
from numba import types
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.environment import _rebuild_env
from numba.core.registry import cpu_target
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature

from .cache_folder import put, user_cache
from .front_end import is_tried
from .writing import is_own_folder, make_folder, read_own, remove, remove_file

PACKAGE, FOLDER = "touchdown", "shipped"
HERE = __name__.removesuffix(
    ".modelkit.kernel.machine_code"
)  # the package's name in this process, or in an FMU
MADE_FOR = "made_for.txt"  # beside the code: what `made_for` said

_V3 = "avx avx2 bmi bmi2 cx16 f16c fma lzcnt movbe popcnt sahf sse3 sse4.1 sse4.2 ssse3 xsave"
_PLAIN = {"x86_64": "x86-64-v3", "AMD64": "x86-64-v3"}  # by machine, as LLVM calls it
_NEEDED = {"x86-64-v3": frozenset(f"+{feature}" for feature in _V3.split())}


def plain_processor() -> str:
    """The least processor that portable code for this kind of machine is made for, as LLVM calls it."""
    return _PLAIN.get(platform.machine(), "generic")


def made_for(numba: str) -> str:
    """Requirements of code made here, for people: a version of numba, this Python, and a processor."""
    return f"numba {numba}, {sys.implementation.cache_tag}, {plain_processor()}"


def plainer(processor: tuple[str, str, str]) -> tuple[str, str, str] | None:
    """The plain processor in the place of another, whose code that one runs; None: it lacks instructions.

    Both are LLVM's triple, the name of the processor, and its features as numba lists them.
    """
    triple, _, features = processor
    plain = plain_processor()
    return (triple, plain, "") if _NEEDED.get(plain, frozenset()) <= {*features.split(",")} else None


def folder(kind: str) -> Path | None:
    """Where the installed package has what the cache holds as `kind`; None where it brought none."""
    try:
        spec = find_spec(PACKAGE)
    except (ImportError, ValueError):
        return None
    if spec is None or not spec.origin:
        return None
    found = Path(spec.origin).parent / FOLDER / kind
    return found if found.is_dir() else None


_DIGEST = 32  # bytes
_KIND = "machine-code"  # of what is kept, and came along
_VERSION = (numba.__version__, sys.implementation.cache_tag)


class KernelCache(_Cache):
    """The store of one kernel's code: numba asks it before it compiles, and fills it afterwards."""

    active = True  # in this process; code that is kept has been through code generation for one machine

    def __init__(self, kernel: Callable[..., object], folder: Path, shipped: Path | None = None) -> None:
        """`folder` is for the sources of all that the kernel calls; in `shipped` is what came for them."""
        module = within(kernel.__module__)
        self._folder, self._name = folder / module, _title(kernel)
        self._shipped = None if shipped is None else shipped / module
        self._kernel = kernel
        self._enabled = True

    @property
    def cache_path(self) -> str:
        return str(self._folder)

    def enable(self) -> None:
        self._enabled = True

    def disable(self) -> None:
        self._enabled = False

    def flush(self) -> None:
        for path in self._folder.glob(f"{self._name}.*"):
            remove_file(path)

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        target_context.refresh()
        if not (self.active and self._enabled):
            return None
        processor = target_context.codegen().magic_tuple()
        code = self._code(self._folder, self._key(sig, processor))
        plain = plainer(processor)
        if code is None and self._shipped is not None and plain is not None:
            code = self._code(self._shipped, self._key(sig, plain), own=False)
        return None if code is None else CompileResult._rebuild(target_context, *code)

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Keep it, where that can be: what is not kept is compiled again by the next process, no more.

        Code that holds addresses of this process is of no use to another one.
        """
        arguments, _ = normalize_signature(sig)
        fixed = not any(isinstance(argument, types.Callable) for argument in arguments)
        if self.active and self._enabled and fixed and not data.library.has_dynamic_globals:
            key = self._key(sig, data.codegen.magic_tuple())
            with contextlib.suppress(OSError):
                code = dumps((key, HERE, dumps(data._reduce())))
                _replace(self._path(self._folder, key), sealed(code))

    def _key(self, signature: Any, processor: tuple[str, str, str]) -> tuple[Any, ...]:
        """All that decides the code beside other sources: types, processor, numba, the kernel itself."""
        kernel = self._kernel
        cells = tuple(cell.cell_contents for cell in kernel.__closure__ or ())
        closed = hashlib.sha256(dumps(cells)).hexdigest() if cells else ""
        own = within(kernel.__module__), self._name, kernel.__code__.co_code, closed
        return signature, processor, own, _text_of(inspect.getfile(kernel)), _VERSION

    def _path(self, folder: Path, key: tuple[Any, ...]) -> Path:
        signature, *others = key
        digest = hashlib.sha256(repr((str(signature), others)).encode()).hexdigest()[:24]
        return folder / f"{self._name}.{digest}.nbc"

    def _code(self, folder: Path, key: tuple[Any, ...], own: bool = True) -> Any:
        """The code that `folder` holds for a key, or None."""
        data = unsealed(self._path(folder, key), own)
        if data is None:
            return None
        kept_for, package, code = pickle.loads(data)
        if kept_for != key:
            return None
        parts = _Unpickler(code, package).load()
        parts[_DESCRIPTOR].modname = self._kernel.__module__
        return parts


_DESCRIPTOR = 1  # its place among the parts of a CompileResult


class _Unpickler(pickle.Unpickler):
    """Finds in this process's package what another process had in one of another name."""

    def __init__(self, data: bytes, package: str) -> None:
        super().__init__(io.BytesIO(data))
        self._package = package

    def find_class(self, module: str, name: str) -> Any:
        found = super().find_class(self._name_here(module), name)
        return self._environment if found is _rebuild_env else found

    def _environment(self, module: str, constants: Any, name: str) -> Any:
        return _rebuild_env(self._name_here(module), constants, name)

    def _name_here(self, module: str) -> str:
        return _renamed(module, self._package, HERE)


def within(module: str, package: str = HERE) -> str:
    """The name of a kernel's module that its code is kept under: that of the installed package.

    With a numba that this was not tried with, that of the `package` it runs in: its code is then not named
    by its sources (`front_end`).
    """
    return _renamed(module, HERE, PACKAGE if is_tried() else package)


def _renamed(module: str, package: str, other: str) -> str:
    inside = module == package or module.startswith(f"{package}.")
    return other + module.removeprefix(package) if inside else module


def _title(kernel: Callable[..., object]) -> str:
    return f"{kernel.__qualname__}-{kernel.__code__.co_firstlineno}".replace("<", "").replace(">", "")


def is_kept(kernel: Any, package: str) -> bool:
    """Whether code of a kernel is there to be tried, for some sources and processor.

    `package` is what the kernel's package is called where it runs.
    """
    module = within(kernel.py_func.__module__, package)
    brought = folder(_KIND)
    places = [user_cache() / _KIND, *([] if brought is None else [brought])]
    pattern = f"*/{module}/{_title(kernel.py_func)}.*"
    return any(next(place.glob(pattern), None) is not None for place in places)


@cache
def _text_of(file: str) -> str:
    """Digest of a source file; "" for what was never in one."""
    path = Path(file)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


def about_shipped() -> str:
    """A line for people about machine code that came along with the installation."""
    found = folder(_KIND)
    if found is None or not (found / MADE_FOR).is_file():
        return "compiled on first use; no machine code came along with this installation"
    made = (found / MADE_FOR).read_text("utf-8").strip()
    codegen: Any = cpu_target.target_context.codegen  # type: ignore[attr-defined]
    if made == made_for(numba.__version__) and plainer(codegen().magic_tuple()) is not None:
        return f"machine code came along, made with {made}"
    return f"compiled on first use; the machine code that came along was made with {made}"


def sealed(data: bytes) -> bytes:
    """`data` behind a digest of it."""
    return hashlib.sha256(data).digest() + data


def unsealed(path: Path, own: bool = True) -> bytes | None:
    """The data given to `sealed`; None where the file is missing, damaged or, `own`, another user's."""
    try:
        content = read_own(path) if own else path.read_bytes()
    except OSError:
        return None
    data = content[_DIGEST:]
    return data if content and sealed(data) == content else None


def _replace(path: Path, content: bytes) -> None:
    """Write a file, whatever is in its place."""
    if os.path.lexists(path.parent) and not is_own_folder(path.parent):
        remove(path.parent)
    make_folder(path.parent, 0o700)
    if path.is_dir():
        remove(path)
    put(path, content)
