"""Tables as they are declared, and the one format of what is wrong in them."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path

import pytest

from touchdown.modelkit.errors import TouchdownError
from touchdown.modelkit.reader import FLAG, TEXT, Table, json_of, key, number, text_of, toml_of, whole, word


@dataclass(frozen=True)
class Spring:
    """What the tables here describe."""

    name: str = key(TEXT)
    length: float = key(number("m", above=0.0, size=(1e-4, 10.0), example="5 mm"))
    turns: int = key(whole(1, 20), 3)
    ends: str = key(word(("closed", "open")), "closed")
    angle: float | None = key(number("rad", strict=True), None)
    painted: bool = key(FLAG, False)


def read(text: str) -> Spring:
    return Table("my.toml: spring.", toml_of(text, "my.toml")).read(Spring)


def test_a_table_is_read_as_declared() -> None:
    text = 'name = "a"\nlength = "20 mm"\nturns = 4\nangle = "90 deg"\npainted = true'
    assert read(text) == Spring("a", 0.02, 4, "closed", pytest.approx(math.pi / 2.0), True)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("length = 1", "my.toml: spring.name is missing; it must be text"),
        ('name = 3\nlength = "5 mm"', "my.toml: spring.name = 3 must be text"),
        ('name = "a"\nlength = "5 kg"', "spring.length = '5 kg' has the unit kg; it is measured in m"),
        (
            'name = "a"\nlength = -1',
            "spring.length = -1 must be above 0 m; a number without a unit is in m",
        ),
        ('name = "a"\nlength = nan', "spring.length = nan is not a finite number"),
        ('name = "a"\nlength = 50', "spring.length = 50 is out of proportion; it must be 0.0001 to 10 m"),
        ('name = "a"\nlength = []', "spring.length = [] is not a number"),
        ('name = "a"\nlength = 1\nturns = 2.5', "spring.turns = 2.5 must be a whole number from 1 to 20"),
        ('name = "a"\nlength = 1\nends = "opn"', "spring.ends = 'opn' is not known; did you mean open"),
        (
            'name = "a"\nlength = 1\nangle = 2',
            "spring.angle = 2 has no unit; write text with a unit of rad",
        ),
        ('name = "a"\nlength = 1\npainted = 2', "spring.painted = 2 must be true or false"),
        ('name = "a"\nlenght = 1', "spring.lenght is not a known key; did you mean length"),
        ('name = "a"\nlength = 5 mm', 'is not valid TOML: Expected newline .*; write "5 mm" in quotes'),
    ],
)
def test_a_mistake_is_one_line(text: str, says: str) -> None:
    with pytest.raises(TouchdownError, match=says.replace("[", r"\[")) as caught:
        read(text)
    assert str(caught.value).startswith("my.toml: ")
    assert "\n" not in str(caught.value)


def test_a_pipe_or_a_device_is_refused_before_it_is_opened(tmp_path: Path) -> None:
    """Nothing writes into the pipe, so that opening it would wait for ever."""
    os.mkfifo(tmp_path / "pipe.toml")
    for path in (tmp_path / "pipe.toml", Path("/dev/zero")):
        with pytest.raises(TouchdownError, match="it is a pipe or a device"):
            text_of(path)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[" * 100_000, "too deep in each other"),
        (f'{{"a": {"[" * 40}{"]" * 40}}}', "32 deep in each other"),
        ("null", "holds a NoneType"),
        ("[1]", "holds a list"),
        ('{"a": ', "is not valid JSON"),
        (b"\xff\xfe", "is not valid JSON"),
        (f'{{"a": {"1" * 5000}}}', "is not valid JSON"),
        ('{"a": "b\\u0000"}', "holds a NUL character"),
    ],
)
def test_json_that_is_no_table(text: str | bytes, says: str) -> None:
    with pytest.raises(TouchdownError, match=f"my.json.*{says}"):
        json_of(text, "my.json")
