"""Machine code that is kept: damaged, it is made anew and never loaded."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any, cast

import damage
import numba
import pytest

from touchdown.modelkit.kernel import cache_folder, machine_code
from touchdown.modelkit.kernel import machine_code as shipped
from touchdown.modelkit.kernel.machine_code import KernelCache


def doubled(x):
    return 2.0 * x


def halved(x):
    return 0.5 * x


def compiled(folder: Path, function: Any = doubled, shipped: Path | None = None) -> Any:
    """A new process's view of a kernel: nothing of it in memory."""
    kernel = numba.njit(function)
    cast(Any, kernel)._cache = KernelCache(function, folder, shipped)
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


@pytest.mark.parametrize("at", [0.0, 0.01, 0.1, 0.9, 0.9999])
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


# -- what came along with the installation -------------------------------------------------------------

HERE = ("x86_64-unknown-linux-gnu", "znver4", ",".join(sorted(shipped._NEEDED["x86-64-v3"])) + ",+avx512f")


@pytest.fixture
def came_along(kept: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a kernel's code, as if it had been made for a plain processor by somebody else."""
    monkeypatch.setattr(machine_code, "plainer", lambda processor: processor)
    monkeypatch.setattr(cache_folder.os, "geteuid", lambda: 12345)
    kept.chmod(0o644)
    return kept.parents[1]


def test_code_that_came_along_is_taken_and_stays_there(came_along: Path, tmp_path: Path) -> None:
    assert loaded(compiled(tmp_path / "own", shipped=came_along))
    assert not (tmp_path / "own").exists()


def test_damaged_code_that_came_along_is_not_taken(came_along: Path, kept: Path, tmp_path: Path) -> None:
    damage.flipped(kept, 0.5)
    assert not loaded(compiled(tmp_path / "own", shipped=came_along))


def test_code_that_came_along_for_another_kernel_is_not_taken(came_along: Path, tmp_path: Path) -> None:
    assert not loaded(compiled(tmp_path / "own", halved, came_along))


def test_code_that_this_processor_cannot_run_is_not_taken(
    came_along: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(machine_code, "plainer", lambda processor: None)
    assert not loaded(compiled(tmp_path / "own", shipped=came_along))


def test_a_plain_processor_stands_in_where_it_lacks_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shipped.platform, "machine", lambda: "x86_64")
    assert shipped.plainer(HERE) == ("x86_64-unknown-linux-gnu", "x86-64-v3", "")
    triple, name, features = HERE
    assert shipped.plainer((triple, name, features.replace("+fma", "-fma"))) is None
    assert shipped.plainer((triple, "x86-64", "")) is None


def test_only_an_installed_package_brings_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder of its name, in which somebody works, is none."""
    monkeypatch.setattr(shipped, "PACKAGE", "brings_code")
    monkeypatch.syspath_prepend(tmp_path)
    brought = tmp_path / "brings_code" / shipped.FOLDER / "fmus"
    brought.mkdir(parents=True)
    assert shipped.folder("fmus") is None
    (tmp_path / "brings_code" / "__init__.py").touch()
    importlib.invalidate_caches()
    assert shipped.folder("fmus") == brought
    assert shipped.folder("machine-code") is None
    monkeypatch.setattr(shipped, "PACKAGE", "json")
    assert shipped.folder("fmus") is None
