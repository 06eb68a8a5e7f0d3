"""What several verbs read from their options."""

from __future__ import annotations

from master.errors import TouchdownError
from master.units import to_si


def assignment(text: str, option: str) -> tuple[str, str]:
    """NAME and VALUE of NAME=VALUE, given with `option`. Raises TouchdownError."""
    name, equals, value = text.partition("=")
    if not equals or not name or not value:
        raise TouchdownError(f"{option} {text}: write NAME=VALUE")
    return name.strip(), value.strip()


def count(text: str, option: str) -> int:
    """A whole number above 0, given with `option`. Raises TouchdownError."""

    number = to_si(text, "1", option)
    if number < 1.0 or number != int(number):
        raise TouchdownError(f"{option} {text} must be a whole number above 0")
    return int(number)
