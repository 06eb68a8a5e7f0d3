"""The command under seeded damage: it works or says why in one line; no traceback, signal or stall.

Nor a file outside of the folder for results, nor more than 1 GB of memory.
"""

from __future__ import annotations

from pathlib import Path

import bases
import pytest
from cases import FMU, KINDS, counted, play, wrong
from commands import Command
from mutators import archive
from pool import run_cases

from touchdown.master.interop.ssp.xml import SSD_FILE

CASES, SAMPLE = 1000, 28
PACKAGE = {
    SSD_FILE: bases.STRUCTURE.encode(),
    "b.ssv": bases.VALUES.encode(),
    "resources/m.fmu": archive(FMU),
}


def test_what_is_damaged_is_right_before(command: Command) -> None:
    Path("scene.ssp").write_bytes(archive(PACKAGE))
    Path("scene.toml").write_text(bases.TURNING, encoding="utf-8")
    Path("rotor.toml").write_text(bases.ROTOR, encoding="utf-8")
    assert command("scenes", "scene.ssp") == (0, "")
    assert command("scenes", "scene.toml", "--variables", "rotor") == (0, "")


@pytest.mark.slow
def test_every_case_works_or_is_one_line() -> None:
    ended = run_cases(play, range(CASES))
    print("\n".join(counted(ended)))
    found = {ran.case: said for ran in ended if (said := wrong(ran))}
    assert not found
    assert sorted(ran.case for ran in ended) == list(range(CASES))
    worked = {KINDS[ran.case % len(KINDS)].__name__ for ran in ended if ran.status == 0}
    assert worked == {kind.__name__ for kind in KINDS if kind.__name__ != "options"}


def test_a_few_cases_work_or_are_one_line() -> None:
    found = {ran.case: said for ran in run_cases(play, range(SAMPLE), jobs=1) if (said := wrong(ran))}
    assert not found
