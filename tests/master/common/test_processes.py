"""Processes that are started: none outlives the one that started it, and one that dies costs no other."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest
from places import ROOT

from touchdown.master.common import cluster, watched
from touchdown.master.common.errors import Ended
from touchdown.master.common.pool import run_all

PARENT = """
import multiprocessing, os, sys, time
from touchdown.master.common.watched import die_with_parent, watch_parent

def child(way):
    {"kernel": lambda: die_with_parent(os.getppid()), "thread": watch_parent}[way]()
    print("there", flush=True)
    time.sleep(600)

if __name__ == "__main__":
    multiprocessing.get_context("spawn").Process(target=child, args=(sys.argv[1],)).start()
    time.sleep(600)
"""


@pytest.mark.parametrize("way", ["kernel", "thread"])
def test_a_process_ends_with_the_one_that_started_it(way: str, tmp_path) -> None:
    """Both hold the pipe: it ends when both are gone."""
    script = tmp_path / "parent.py"
    script.write_text(PARENT, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    arguments = [sys.executable, str(script), way]
    with subprocess.Popen(arguments, env=environment, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        assert parent.stdout.readline() == "there\n"
        parent.send_signal(signal.SIGKILL)
        assert parent.communicate(timeout=60) == ("", None)


def die_at_two(number: int) -> int:
    """Half of a number; the process dies of 2."""
    if number == 2:
        os._exit(1)
    return number // 2


def test_the_others_of_a_process_that_dies_go_on() -> None:
    heard: list[int] = []
    ended = run_all(die_at_two, [0, 2, 4, 6, 8], 2, lambda: None, lambda place, _: heard.append(place))
    assert [one.value for one in ended] == [0, None, 2, 3, 4]
    assert (ended[1].ended, ended[1].reason) == (Ended.DIED, "its process ended with status 1, twice")
    assert sorted(heard) == [0, 1, 2, 3, 4]


def test_what_ctrl_c_keeps_from_being_heard_is_interrupted() -> None:
    def heard(place: int, outcome: object) -> None:
        raise KeyboardInterrupt

    ended = run_all(die_at_two, [0, 4], 1, lambda: None, heard)
    assert [one.ended for one in ended] == [Ended.INTERRUPTED, Ended.INTERRUPTED]


def test_a_task_on_a_cluster_has_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever its worker was started with."""
    monkeypatch.setenv("OMP_NUM_THREADS", "4")
    assert cluster._one_by_one(os.environ.get, "OMP_NUM_THREADS").value == "1"
    assert os.environ["OMP_NUM_THREADS"] == "4"


HANGS = """
import os, signal
from {watched} import allow_watching, watch
import {watched} as watched

watched.GRACE_S = 0.1
allow_watching()
watch("code of others ran in it")
signal.signal(signal.SIGTERM, signal.SIG_IGN)  # as code that never comes back to Python
os.kill(os.getppid(), signal.SIGTERM)
while True:
    signal.pause()
"""


def test_a_process_that_hangs_is_killed_once_it_was_told_to_end() -> None:
    script = HANGS.format(watched=watched.__name__)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 128 + signal.SIGKILL
    assert "did not end within 0.1 s of being told to" in done.stderr
    assert done.stderr.splitlines()[-1].endswith("before its work was done; code of others ran in it")
