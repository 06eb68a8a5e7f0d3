"""Every public name has an example in its docstring, and the example holds."""

from __future__ import annotations

import doctest
from collections.abc import Iterator
from pathlib import Path

import matplotlib as mpl
import pytest

import touchdown
from touchdown.master.coupling import steppers
from touchdown.master.scene import schemes

pytestmark = pytest.mark.slow

NAMES = [name for name in touchdown.__all__ if name != "__version__"]


@pytest.fixture(autouse=True)
def _alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """In a folder of its own, without a display; schemes that an example registers go with it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(mpl.rcParams, "backend", "agg")
    registries = (schemes._schemes, steppers._sequences)
    before = [dict(registry) for registry in registries]
    yield
    for registry, was in zip(registries, before, strict=True):
        registry.clear()
        registry.update(was)


@pytest.mark.parametrize("name", NAMES)
def test_an_example_holds(name: str) -> None:
    given = getattr(touchdown, name)
    (example,) = doctest.DocTestFinder(recurse=False).find(given, name, globs={"touchdown": touchdown})
    assert example.examples, f"touchdown.{name} has no example"
    found = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(example)
    assert not found.failed


def test_the_package_s_own_example_holds() -> None:
    assert not doctest.testmod(touchdown, globs={"touchdown": touchdown}).failed


def test_the_names_are_few_and_typed() -> None:
    assert len(touchdown.__all__) <= 40
    assert touchdown.__all__ == sorted(touchdown.__all__)
    assert set(touchdown.__all__) <= set(dir(touchdown))
    assert set(touchdown.__all__) - {"__version__"} == touchdown._HOMES.keys()
