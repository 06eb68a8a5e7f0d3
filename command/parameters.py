"""Kinds of parameters of the public functions, and how the command reads the texts of its options."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from ..master.common.errors import TouchdownError, as_list
from ..master.common.text import RPM
from ..master.common.units import to_si
from ..modelkit.units import is_bare

PathLike = str | os.PathLike[str]
Count = int  # above 0
Points = int  # above 0, of a sample
Jobs = int | str  # processes, or the address of a Dask scheduler
Names = str | Iterable[str]  # on the command line with commas between them
Counts = int | str | Iterable[int | str]  # on the command line with commas between them
Texts = Iterable[str]  # an option that may be repeated
Settings = Mapping[str, Any]  # NAME=VALUE, repeated
Places = Mapping[str, Any]  # NAME=VALUE,NAME=VALUE, repeated, each name once
# Numbers in SI, or texts with a unit, above 0:
Time = Length = Force = Mass = Inertia = Speed = Ratio = float | str
Angle = Spin = Fraction = float | str  # of any sign
Times = float | str | Iterable[float | str]
Spins = float | str | Iterable[float | str]  # of any sign

MOST = 10_000  # of what is counted: runs, repetitions
MOST_POINTS = 100_000  # of a sample: weeks of drops
MOST_JOBS = 256  # processes, each of a hundred MB and more
POSITIVE = {
    "Time": "s",
    "Length": "m",
    "Force": "N",
    "Mass": "kg",
    "Inertia": "kg.m2",
    "Speed": "rad/s",
    "Ratio": "1",
}
SIGNED = {"Angle": "rad", "Spin": "rad/s", "Fraction": "1"}
REPEATED = ("Texts", "Settings", "Places")  # options that may be given several times
METAVARS = {
    "Count": "N",
    "Points": "N",
    "Jobs": "N",
    "Counts": "N,N,...",
    "Names": "NAME,...",
    "Texts": "TEXT",
    "Settings": "NAME=VALUE",
    "Places": "NAME=PLACE,...",
    "Times": "TIME,...",
    "Spins": "SPEED,...",
    "Spin": "SPEED",
    "PathLike": "FILE",
    "Fraction": "NUMBER",
    "Ratio": "NUMBER",
    "str": "VALUE",
}


def read(kind: str, entered: Any, option: str) -> Any:
    """The value of an `option` for a parameter of this kind. Raises TouchdownError.

    A single quantity stays as text, once it is known to be one: functions take it so, too.
    """
    if kind in POSITIVE:
        above_zero(entered, POSITIVE[kind], option)
    elif kind in SIGNED:
        to_si(entered, SIGNED[kind], option)
    readers: dict[str, Callable[[Any, str], Any]] = {
        "Count": lambda text, name: count(text, name, MOST_JOBS if name == "--jobs" else MOST),
        "Points": lambda text, name: count(text, name, MOST_POINTS),
        "Jobs": lambda text, name: text if ":" in text else count(text, name, MOST_JOBS),
        "Names": _names,
        "Counts": lambda text, _: text.split(","),
        "Times": lambda text, name: sorted({above_zero(one, "s", name) for one in _listed(text, name)}),
        "Spins": _spins,
        "Settings": lambda texts, name: dict(assignment(text, name, empty=True) for text in texts),
        "Places": _places,
        "PathLike": lambda text, _: Path(text),
    }
    return readers[kind](entered, option) if kind in readers else entered


def above_zero(text: str, unit: str, option: str) -> float:
    """A number above 0 in the SI unit. Raises TouchdownError."""
    value = to_si(text, unit, option)
    if not 0.0 < value < math.inf:
        raise TouchdownError(f"{option} {text} must be above 0")
    return value


def count(text: str, option: str, most: int = MOST) -> int:
    """A whole number above 0, at most `most`, given with `option`. Raises TouchdownError."""
    number = to_si(text, "1", option)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{option} {text} must be a whole number above 0")
    if number > most:
        raise TouchdownError(f"{option} {text} must be at most {most}")
    return int(number)


def assignment(text: str, option: str, empty: bool = False) -> tuple[str, str]:
    """NAME and VALUE, which may be `empty`, of NAME=VALUE given with `option`. Raises TouchdownError."""
    name, equals, value = text.partition("=")
    if not equals or not name or not (value or empty):
        raise TouchdownError(f"{option} {text}: write NAME=VALUE")
    return name.strip(), value.strip()


def _names(text: str, option: str) -> list[str]:
    """Names between commas. Raises TouchdownError where one is missing."""
    found = [name.strip() for name in text.split(",")]
    if found == [""]:
        raise TouchdownError(f"{option} is empty; give names, with commas between them")
    if not all(found):
        raise TouchdownError(f"{option} {text}: a name is missing between the commas")
    return found


def parted(names: Names) -> list[str]:
    """The names that a function got: several, one, or a text with commas between them."""
    return [one.strip() for name in as_list(names) for one in name.split(",") if one.strip()]


def bare_speeds(speeds: Iterable[Any]) -> list[str]:
    """What is to be said of speeds that are texts without a unit, a line each."""
    bare = (one for one in speeds if isinstance(one, str) and is_bare(one) and float(one))
    return [
        f"speed {one} has no unit: it is taken for rad/s, {RPM * float(one):.0f} rpm; "
        f'write "{one} rpm" where that is meant'
        for one in bare
    ]


def _spins(text: str, option: str) -> list[str]:
    """Speeds with commas between them, as text. Raises TouchdownError."""
    found = list(_listed(text, option))
    for one in found:
        to_si(one, "rad/s", option)
    return found


def _listed(text: str, option: str) -> Iterable[str]:
    """Quantities with commas between them; a unit at the end is everyone's."""
    from ..studies.sweep.design import listed

    return listed(text, f"{option} {text}")


def _places(texts: Iterable[str], option: str) -> dict[str, str]:
    places: dict[str, str] = {}
    for text in (one for several in texts for one in several.split(",")):
        name, place = assignment(text, option)
        if name in places:
            raise TouchdownError(f"{option} {text}: {name} is there twice")
        places[name] = place
    return places
