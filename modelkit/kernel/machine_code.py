"""Machine code of kernels, kept between processes.

numba's own cache loads its files unchecked: one flipped byte ends the process. Here a file holds the
code of one kernel for one signature behind a digest of it, under a name that both decide. A file that is
damaged, or is another signature's or another user's, counts as missing: the kernel is compiled again and
the file is replaced.

The installed sources, and those that travel in FMUs as a package of another name, share code where they
are the same: it is kept under the names that modules have in the installed package, and given to whichever
package asks for it.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import io
import os
import pickle
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba import types
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.environment import _rebuild_env
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature

from .cache_folder import put_file, user_cache
from .front_end import is_tried
from .writing import is_own_folder, make_folder, read_own, remove, remove_file

PACKAGE = "touchdown"
FOLDER = "machine-code"  # of the cache
HERE = __name__.removesuffix(
    ".modelkit.kernel.machine_code"
)  # the package's name in this process, or in an FMU

_DIGEST = 32  # bytes
_VERSION = (numba.__version__, sys.implementation.cache_tag)


class KernelCache(_Cache):
    """The store of one kernel's code: numba asks it before it compiles, and fills it afterwards."""

    active = True  # in this process; code that is kept has been through code generation for one machine

    def __init__(self, kernel: Callable[..., object], folder: Path) -> None:
        """`folder` is for the sources of all that the kernel calls."""
        self._folder, self._name = folder / installed_name(kernel.__module__), _title(kernel)
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
        code = self._code(self._key(sig, target_context.codegen().magic_tuple()))
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
                _replace(self._path(key), sealed(code))

    def _key(self, signature: Any, processor: tuple[str, str, str]) -> tuple[Any, ...]:
        """All that decides the code beside other sources: types, processor, numba, the kernel itself."""
        kernel = self._kernel
        cells = tuple(cell.cell_contents for cell in kernel.__closure__ or ())
        closed = hashlib.sha256(dumps(cells)).hexdigest() if cells else ""
        function = installed_name(kernel.__module__), self._name, kernel.__code__.co_code, closed
        return signature, processor, function, _text_of(inspect.getfile(kernel)), _VERSION

    def _path(self, key: tuple[Any, ...]) -> Path:
        signature, *others = key
        digest = hashlib.sha256(repr((str(signature), others)).encode()).hexdigest()[:24]
        return self._folder / f"{self._name}.{digest}.nbc"

    def _code(self, key: tuple[Any, ...]) -> Any:
        """The code that is kept for a key, or None."""
        data = unsealed(self._path(key))
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


def installed_name(module: str, package: str = HERE) -> str:
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
    pattern = f"*/{installed_name(kernel.py_func.__module__, package)}/{_title(kernel.py_func)}.*"
    return next((user_cache() / FOLDER).glob(pattern), None) is not None


@cache
def _text_of(file: str) -> str:
    """Digest of a source file; "" for what was never in one."""
    path = Path(file)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""


def sealed(data: bytes) -> bytes:
    """`data` behind a digest of it."""
    return hashlib.sha256(data).digest() + data


def unsealed(path: Path) -> bytes | None:
    """The data given to `sealed`; None where the file is missing, damaged or another user's."""
    try:
        content = read_own(path)
    except OSError:
        return None
    data = content[_DIGEST:]
    return data if content and sealed(data) == content else None


def _replace(path: Path, content: bytes) -> None:
    """Write a file in place of any other."""
    if os.path.lexists(path.parent) and not is_own_folder(path.parent):
        remove(path.parent)
    make_folder(path.parent, 0o700)
    if path.is_dir():
        remove(path)
    put_file(path, content)
