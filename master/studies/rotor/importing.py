"""Rotors of others', imported."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from touchdown.master.common.errors import TouchdownError
from touchdown.modelkit.model import ModelError
from touchdown.rotor.beams.shaft import Shaft
from touchdown.rotor.file import load, written
from touchdown.rotor.imports import from_ross, of_arrays, placed, read
from touchdown.rotor.imports.places import Places


def import_rotor(
    source: Any,
    at: Places | None = None,
    amb: Places | None = None,
    sensors: Places | None = None,
    speed: float | None = None,
) -> Shaft:
    """The rotor in a file or folder (`rotor.imports.read`), of arrays by name, or of a `ross.Rotor`.

    at: stations for touchdown bearings; amb: those that levitate it before it drops; sensors: where only
    motion is asked for. Each is a node (from 1), or text such as "120 mm" from node 1, by name. speed:
    rad/s, at which bearings whose coefficients hang on it are taken. Raises TouchdownError.
    """
    try:
        shaft = placed(_found(source, speed), at, amb, sensors)
        written(shaft, f"rotor {shaft.title}")  # what no rotor file can say is named here
    except ModelError as error:
        raise TouchdownError(_already(source) or str(error)) from None
    return shaft


def _already(source: Any) -> str:
    """That a file is a rotor's of the project's own, where it is; "" of another."""
    if not isinstance(source, (str, os.PathLike)) or not os.fspath(source).endswith(".toml"):
        return ""
    try:
        load(os.fspath(source))
    except ModelError:
        return ""
    return (
        f"{os.fspath(source)} is a rotor's file already; `touchdown rotor` describes it, `touchdown new "
        "FOLDER --rotor` makes a machine with it"
    )


def _found(source: Any, speed: float | None) -> Shaft:
    """As it is, without places. Raises ImportedRotorError."""
    if isinstance(source, (str, os.PathLike)):
        return read(os.fspath(source), speed)
    if isinstance(source, Mapping):
        return of_arrays(source, "the arrays", "Rotor of matrices")
    return from_ross(source, speed)
