"""A host in C, compiled once."""

from __future__ import annotations

from pathlib import Path

import pytest
from hosting import COMPILER, compiled


@pytest.fixture(scope="session")
def host(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its path."""
    if COMPILER is None:
        pytest.skip("there is no C compiler (cc, gcc)")
    return compiled(tmp_path_factory.mktemp("host"))
