"""The command under seeded damage: it works or says why in one line; no traceback, signal or stall."""

from __future__ import annotations

from pathlib import Path

import bases
import pytest
from cases import FMU, KINDS, play, wrong
from commands import Command
from mutators import archive
from pool import run_cases

from touchdown.master.interop.ssp.xml import SSD_FILE

pytestmark = pytest.mark.slow

CASES = 420
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


def test_every_case_works_or_is_one_line() -> None:
    ended = run_cases(play, range(CASES))
    found = {ran.case: said for ran in ended if (said := wrong(ran))}
    assert not found
    assert sorted(ran.case for ran in ended) == list(range(CASES))
    worked = {KINDS[ran.case % len(KINDS)].__name__ for ran in ended if ran.status == 0}
    assert worked >= {"scene", "rotor", "setting", "package", "fmu"}
