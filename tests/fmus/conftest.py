"""A host in C and native FMUs, each made once; native ones of dear models only by tests marked `native`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from fmpy import extract
from hosting import COMPILER, compiled

from touchdown.fmus.native.compiler import NativeError, command, host_target
from touchdown.fmus.native.native_build import cached_native
from touchdown.fmus.recipes import recipe

Native = Callable[[str], Path]


@pytest.fixture(scope="session")
def host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Path of the host."""
    if COMPILER is None:
        pytest.skip("there is no C compiler (cc, gcc)")
    return compiled(tmp_path_factory.mktemp("host"))


@pytest.fixture(scope="session")
def native_file() -> Native:
    """The native FMU of a model, by name."""
    target = host_target()
    if target is None:
        pytest.skip("native FMUs are not built for this machine")
    try:
        command(target)
    except NativeError as error:
        pytest.skip(str(error))
    return cache(lambda name: cached_native(recipe(name)))


@pytest.fixture(scope="session")
def native(native_file: Native, tmp_path_factory: pytest.TempPathFactory) -> Native:
    """The folder that a native FMU is unpacked to, by name."""
    folder = tmp_path_factory.mktemp("native")
    return cache(lambda name: Path(extract(str(native_file(name)), str(folder / name))))
