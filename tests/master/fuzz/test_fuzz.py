"""The command under seeded damage: it works or says why in one line; no traceback, signal or stall."""

from __future__ import annotations

import os
import signal
import sys
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


def crash(case: int, _: Path) -> int:
    """Cases that go wrong in every way that the pool must survive, and some that do not."""
    if case == 1:
        os.kill(os.getpid(), signal.SIGSEGV)
    elif case == 2:
        os._exit(0)
    elif case == 3:
        raise ZeroDivisionError
    elif case == 4:
        signal.pause()
    elif case == 5:
        os.write(2, b"from a library\n")
    elif case == 6:
        print("touchdown: no", file=sys.stderr)
        return 2
    return 0


def test_the_pool_finds_what_goes_wrong() -> None:
    """Crashes, untimely ends, tracebacks, stalls and stray lines, each as the case it is."""
    ended = {ran.case: wrong(ran) for ran in run_cases(crash, range(9), limit=5)}
    assert sorted(ended) == list(range(9))
    assert sorted(case for case, said in ended.items() if not said) == [0, 6, 7, 8]
    assert "crashed with SIGSEGV" in ended[1]
    assert "ended with status 0" in ended[2]
    assert "ZeroDivisionError" in ended[3]
    assert "SIGALRM" in ended[4]
    assert "from a library" in ended[5]
