"""Sizes beyond reason: refused before the work begins, with the limit in the line."""

from __future__ import annotations

import shlex

import pytest
from commands import Command

from touchdown.master.common.errors import FAILED

DISK, ROTOR = "disk-caged-simplified", "rotor1-9000"


@pytest.mark.parametrize(
    ("line", "limit"),
    [
        (f"run {DISK} --in-process --set run.macro_step=1e-300", "more than 1e+09 of them"),
        (f"sweep {DISK} --vary rotor.mass=1:2:100000 --vary rotor.speed=1:2:100000", "at most 10000"),
        (f"sweep {DISK} --vary rotor.mass=1:2:100001", "a whole number from 1 to 100000"),
        (f"sweep {DISK} --vary rotor.mass=1,2 --jobs 1000", "--jobs 1000 must be at most 256"),
        (f"verdict {ROTOR} --grid '1e-9 deg'", "must be from 0.1 to 180 deg"),
        (f"verdict {ROTOR} --macro-steps 1e-300", "more than 1e+09 of them"),
        (f"compare {DISK} --repeat 1e300", "--repeat 1e300 must be at most 10000"),
        (f"compare {DISK} --duration 1e300", "more than 1e+09 of them"),
        (f"compare {DISK} --timed 1e300", "more than 1e+09 of them"),
        (f"compare {ROTOR} --of modes --modes 2,3 --duration 1e300", "more than 1e+09 of them"),
        ("figure bearings --ensemble 1e9", "--ensemble 1e9 must be at most 10000"),
    ],
)
def test_a_size_beyond_reason_is_refused(line: str, limit: str, command: Command) -> None:
    ended = command(*shlex.split(line), "--quiet", "-o", "out")
    assert limit in ended.line
    assert ended.status == FAILED
