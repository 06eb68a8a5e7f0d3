"""Machine code that is kept: damaged, it is made anew and never loaded."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import damage
import numba
import pytest

from touchdown.modelkit.kernel import cache_folder
from touchdown.modelkit.kernel.machine_code import KernelCache


def doubled(x):
    return 2.0 * x


def halved(x):
    return 0.5 * x


def compiled(folder: Path, function: Any = doubled) -> Any:
    """A new process's view of a kernel: nothing of it in memory."""
    kernel = numba.njit(function)
    cast(Any, kernel)._cache = KernelCache(function, folder)
    return kernel


def loaded(kernel: Any) -> bool:
    """Whether its code came from the folder; calls it."""
    assert kernel(3.0) == kernel.py_func(3.0)
    return sum(kernel.stats.cache_hits.values()) == 1


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    """The file of a kernel's code, in the folder of its module in `tmp_path`."""
    assert not loaded(compiled(tmp_path))
    (path,) = tmp_path.rglob("*.nbc")
    return path


def test_code_is_kept(kept: Path) -> None:
    assert loaded(compiled(kept.parents[1]))
    assert [path.name for path in kept.parent.iterdir()] == [kept.name]


@pytest.mark.parametrize("harm", damage.OF_FILES.values(), ids=damage.OF_FILES)
def test_damaged_code_is_made_anew_once(harm: damage.Damage, kept: Path) -> None:
    harm(kept)
    assert not loaded(compiled(kept.parents[1]))
    assert loaded(compiled(kept.parents[1]))


@pytest.mark.parametrize("at", [0.0, 0.01, 0.9999])
def test_one_bit_is_enough(at: float, kept: Path) -> None:
    damage.flipped(kept, at)
    assert not loaded(compiled(kept.parents[1]))


@pytest.mark.parametrize("harm", [damage.removed, damage.file], ids=["removed", "file"])
def test_a_damaged_folder_is_made_anew_once(harm: damage.Damage, kept: Path) -> None:
    harm(kept.parent)
    assert not loaded(compiled(kept.parents[1]))
    assert loaded(compiled(kept.parents[1]))


def test_code_of_another_kernel_is_not_taken_for_it(kept: Path) -> None:
    """A whole file, under a name that is not its own."""
    assert not loaded(compiled(kept.parents[1], halved))
    (other,) = kept.parent.glob("halved-*")
    other.replace(kept)
    assert not loaded(compiled(kept.parents[1]))


def test_code_of_another_user_is_not_taken(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache_folder.os, "geteuid", lambda: 12345)
    assert not loaded(compiled(kept.parents[1]))


def test_code_that_others_may_write_is_not_taken(kept: Path) -> None:
    kept.chmod(0o666)
    assert not loaded(compiled(kept.parents[1]))


def test_code_that_cannot_be_kept_runs(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"x")
    assert not loaded(compiled(tmp_path / "file"))
