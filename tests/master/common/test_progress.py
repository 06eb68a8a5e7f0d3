"""Progress in a file: lines, not one that is written over."""

from __future__ import annotations

import io
import sys

import pytest

from touchdown.master.common.progress import LINES, bar_over, growing_bar


def test_a_file_gets_a_line_for_each_part(monkeypatch: pytest.MonkeyPatch) -> None:
    written = io.StringIO()
    monkeypatch.setattr(sys, "stderr", written)
    with bar_over(1000, "drops", quiet=False) as bar:
        for _ in range(1000):
            bar.update()
    lines = written.getvalue().split("\n")
    assert "\r" not in written.getvalue()
    assert len(lines) == LINES + 2  # one at the start; nothing after the last
    assert lines[1].startswith("drops:   5%")


def test_one_that_grows(monkeypatch: pytest.MonkeyPatch) -> None:
    written = io.StringIO()
    monkeypatch.setattr(sys, "stderr", written)
    with growing_bar("runs", quiet=False) as growing:
        for _ in range(2):
            growing.planned(100)
            for _ in range(100):
                growing.done()
    assert LINES < written.getvalue().count("\n") < 2 * LINES


def test_a_quiet_bar_may_grow(capsys: pytest.CaptureFixture[str]) -> None:
    with growing_bar("runs", quiet=True) as growing:
        for _ in range(2):
            growing.planned(1)
            growing.done()
    assert capsys.readouterr().err == ""
