"""The FMU of body.c, in the kinds that tests need."""

from __future__ import annotations

from pathlib import Path

import fmpy
import pytest

from touchdown.validation import bodies


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if bodies.COMPILER is None:
        pytest.skip("needs a C compiler")
    if fmpy.platform != bodies.PLATFORM:
        pytest.skip(f"packs libraries for {bodies.PLATFORM} only")
    return bodies.compiled(tmp_path_factory.mktemp("bodies"))


@pytest.fixture(scope="session")
def body(library: Path) -> Path:
    return bodies.fmu(library)


@pytest.fixture(scope="session")
def unitless(library: Path) -> Path:
    return bodies.fmu(library, "unitless", bodies.Kind(units=False))


@pytest.fixture(scope="session")
def stubborn(library: Path) -> Path:
    """It takes steps of one length only, and cannot go back."""
    return bodies.fmu(library, "stubborn", bodies.Kind(states=False, any_step=False))
