"""Numbers, enumerations and tables as text."""

from __future__ import annotations

import doctest

from touchdown.master.common import text


def test_the_examples_hold() -> None:
    found = doctest.testmod(text)
    assert found.attempted > 6
    assert not found.failed


def test_nothing_is_listed_where_there_is_nothing() -> None:
    assert text.joined([]) == ""
    assert text.joined("ab", most=2) == "a and b"


def test_lines_have_no_blanks_at_their_ends() -> None:
    assert text.aligned([("", "a", ""), ("1", "", "why")], ">") == ["   a", "1     why"]
