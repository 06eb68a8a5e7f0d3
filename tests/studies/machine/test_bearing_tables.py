"""What `touchdown catalogue` tells of a bearing under thrust."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from touchdown.master.common.errors import TouchdownError
from touchdown.studies.machine.bearings import find_bearing, pushed


def told(name: str, *arguments: object) -> list[str]:
    """The lines about a bearing."""
    return pushed(find_bearing(name, Path()), *arguments).splitlines()  # type: ignore[arg-type]


def test_a_pair_with_preload_is_told_by_rows() -> None:
    """The rows share alike what is preload alone; under 2.8 times it one bears nothing."""
    light = told("7014", 1.0, "back to back", 300.0)
    heavy = told("7014", 2000.0, "back to back", 300.0)
    row = 300.0 / (20 * math.sin(math.radians(16.02)))  # N, of a ball; a thrust of 1 N shifts it by 0.1 N
    assert [float(line.split()[6]) for line in light[2:4]] == pytest.approx([row, row], abs=0.2)
    assert heavy[3].split() == ["each", "ball", "of", "row", "2", "bears", "nothing"]
    assert "at a contact angle of 18.09 deg" in heavy[2]
    assert heavy[5].startswith("  stiffness by preload alone: 508.2 N/um radial, 87.08 N/um axial")


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("7014", (100.0, "back"), "--arrangement back: did you mean back to back"),
        ("7014", (100.0, "", 50.0), "--preload clamps rows against each other, which single has none of"),
        ("6904", (100.0, "tandem"), "6904 has no contact angle, and makes no pair"),
    ],
)
def test_what_makes_no_sense_is_refused(name: str, arguments: tuple[object, ...], message: str) -> None:
    with pytest.raises(TouchdownError, match=message):
        told(name, *arguments)
