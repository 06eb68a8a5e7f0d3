"""texts.h: what the FMI side in C says, from the templates that the Python side speaks by."""

from __future__ import annotations

from collections.abc import Iterator
from string import Formatter

from touchdown.fmus import refusals as calls
from touchdown.fmus.native.targets import NativeError
from touchdown.fmus.slave import LATE
from touchdown.modelkit import refusals as steps
from touchdown.modelkit import status
from touchdown.modelkit.integrators.control import MOST_STEPS

OWN = {  # what only a native FMU has to say
    "NOT_HELD": "this FMU holds no constants for {chosen}; it was built for {held}; build it for others "
    "with touchdown build --native --modes",
    "NO_MEMORY": "there is no memory left",
    "NO_MODEL_EXCHANGE": "it is an FMU for co-simulation only",
    "FOREIGN_GUID": "the GUID is not this FMU's; its description and its library do not belong together",
    "OLD_PROCESSOR": "this processor lacks AVX2, FMA or BMI2; build the FMU for a target that ends in -v2",
    "NOT_OFFERED": "the FMU does not offer this",
    "NO_ROOM": "there is too little room for the state",
    "NO_EVENT_MODE": "it has no event mode; instantiate it without",
    "PAST_STOP": "cannot step from t = {time:.9g} s by {step:g} s; the end was said to be t = {stop:.9g} s",
    "OTHER_COUNT": "{given:d} values for variables that hold {held:d}",
}
_CONVERSIONS = {"": "s", "g": "g", ".9g": ".9g", "d": "u"}


def header() -> str:
    """The file."""
    lines = ["/* Written by touchdown.fmus.native.texts. */", *_numbers()]
    for name, template in {**_templates(steps), **_templates(calls), **OWN}.items():
        lines.append(f"#define SAY_{name} {quoted(printf(template)[0])}")
    return "\n".join(lines) + "\n"


def printf(template: str) -> tuple[str, list[str]]:
    """printf's format for a template of `str.format`, and the names of its fields in order.

    Raises ValueError where C cannot say it.
    """
    text, names = "", []
    for plain, name, conversion, _ in Formatter().parse(template):
        if "%" in plain or (name is not None and conversion not in _CONVERSIONS):
            raise ValueError(f"C cannot print {template!r}")
        text += plain
        if name is not None:
            text += f"%{_CONVERSIONS[conversion or '']}"
            names.append(name)
    return text, names


def quoted(text: str) -> str:
    """A literal of C. Raises NativeError where it is not plain ASCII, which C can be sure to print."""
    if not text.isascii() or not text.isprintable():
        raise NativeError(f"{text!r} is not plain ASCII, which C can be sure to print; choose another word")
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def word(text: str) -> str:
    """A literal of C for what goes into a text. Raises NativeError where a host's log would misread it."""
    if "%" in text:  # FMI's log takes a format
        raise NativeError(f"{text!r} has a percent sign, which begins a format in C; choose another word")
    return quoted(text)


def _templates(module: object) -> dict[str, str]:
    return {name: text for name, text in vars(module).items() if name.isupper() and isinstance(text, str)}


def _numbers() -> Iterator[str]:
    yield f"#define LATE {LATE!r} /* of a step: how far it may begin from the end of the last one */"
    yield f"#define MOST_STEPS {MOST_STEPS}u"
    for name in ("BAD_INPUT", "BAD_LOAD", "TOO_MANY_STEPS"):
        yield f"#define {name} {getattr(status, name)}"
