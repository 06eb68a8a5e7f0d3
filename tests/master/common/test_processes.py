"""Processes that are started: none outlives the one that started it, and one that dies costs no other."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

from touchdown.master.common import pool
from touchdown.master.common.errors import Ended
from touchdown.master.common.pool import run_all

HEAD = """
import os, time
from touchdown.master.common.pool import run_all

def work(number):
    os.write(1, b"there\\n")  # whole, as the other's
    time.sleep(600)

"""
CALL = "run_all(work, [1, 2], 2, lambda: None)\n"


def script(folder: Path, text: str) -> subprocess.Popen[str]:
    """A script of Python that runs."""
    path = folder / "script.py"
    path.write_text(HEAD + text, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    pipe = subprocess.PIPE
    return subprocess.Popen(
        [sys.executable, str(path)], env=environment, stdout=pipe, stderr=pipe, text=True
    )


def test_processes_end_with_the_one_that_started_them(tmp_path: Path) -> None:
    """All hold the pipe: it ends when all are gone."""
    with script(tmp_path, f'if __name__ == "__main__":\n    {CALL}') as parent:
        assert parent.stdout is not None
        assert [parent.stdout.readline() for _ in range(2)] == 2 * ["there\n"]
        parent.send_signal(signal.SIGKILL)
        assert parent.communicate(timeout=60)[0] == ""


def test_a_script_that_starts_itself_again_is_told_what_to_write(tmp_path: Path) -> None:
    with script(tmp_path, f"try:\n    {CALL}except Exception as error:\n    print(error)\n") as parent:
        out, err = parent.communicate(timeout=60)
    assert out == "processes that are started here end before they begin\n"
    lines = set(err.splitlines())
    assert len(lines) == 1
    assert lines.pop().endswith('put what it does under if __name__ == "__main__":')


def die_at_two(number: int) -> int:
    """Half of a number; the process dies of 2."""
    if number == 2:
        os._exit(1)
    return number // 2


def test_the_others_of_a_process_that_dies_go_on() -> None:
    heard: list[int] = []
    ended = run_all(die_at_two, [0, 2, 4, 6, 8], 2, lambda: None, lambda place, _: heard.append(place))
    assert [one.value for one in ended] == [0, None, 2, 3, 4]
    reason = "its process ended with status 1 while it ran alone"
    assert (ended[1].ended, ended[1].reason) == (Ended.DIED, reason)
    assert sorted(heard) == [0, 1, 2, 3, 4]


def test_what_ctrl_c_keeps_from_being_heard_is_interrupted() -> None:
    def heard(place: int, outcome: object) -> None:
        raise KeyboardInterrupt

    ended = run_all(die_at_two, [0, 4], 1, lambda: None, heard)
    assert [one.ended for one in ended] == [Ended.INTERRUPTED, Ended.INTERRUPTED]


def test_a_task_has_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the worker of a cluster was started with."""
    monkeypatch.setenv("OMP_NUM_THREADS", "4")
    assert pool._do(os.environ.get, "OMP_NUM_THREADS").value == "1"
    assert os.environ["OMP_NUM_THREADS"] == "4"
