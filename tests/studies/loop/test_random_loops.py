"""Loops of random rotors and controllers against another model: a few of `benchmarks/random_loops.py`."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from places import ROOT


@pytest.mark.parametrize("first", [0, 6])
def test_stability_peaks_zones_and_delay_margins(
    first: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Peaks to 1e-5, a hundred times what the dense grid leaves."""
    monkeypatch.setattr(sys, "path", [str(ROOT / "benchmarks"), *sys.path])
    import random_loops

    cases = map(random_loops.random_case, range(first, first + 6))
    found = [one for case in cases for one in random_loops.judged(case, tmp_path)]
    kinds = [what for what, _ in found]
    assert not [one for one in found if one[0].startswith("wrong")]
    assert kinds.count("stable") >= 2
    assert kinds.count("stable") + kinds.count("unstable") == 6
    assert max(abs(size) for what, size in found if what == "peak") < 1e-5
