# PYTHON_ARGCOMPLETE_OK
"""The command `touchdown`."""

from __future__ import annotations

import argparse
import platform
import sys
from collections.abc import Sequence
from importlib import metadata

import argcomplete

from touchdown.fmus.version import VERSION
from touchdown.master import verbs
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.master.common.interrupts import ended_as_by_ctrl_c
from touchdown.master.verbs.screen import broken_off, complain


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status. A user's mistake is one line on stderr."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    command = parser()
    argcomplete.autocomplete(command)  # answers the shell and exits where it was asked to
    options = command.parse_args(joined(given))
    try:
        with ended_as_by_ctrl_c():
            return options.run(options)
    except TouchdownError as error:
        complain(str(error))
        return FAILED
    except KeyboardInterrupt:
        return broken_off()
    except BrokenPipeError:
        return 0


def parser() -> argparse.ArgumentParser:
    """What reads the command line; `run` of its result does what was asked for."""
    command = argparse.ArgumentParser(
        prog="touchdown",
        description="Rotor drops onto touchdown bearings, co-simulated with FMUs.",
        epilog="`touchdown VERB --help` has the options of a verb, and examples.",
    )
    command.add_argument("--version", action="version", version=_versions())
    added = command.add_subparsers(required=True, metavar="VERB")
    for verb in verbs.ALL:
        verb.add_to(added)
    return command


def joined(arguments: list[str]) -> list[str]:
    """Tie options to their values where these may be negative: argparse would take them for options."""
    found = list(arguments)
    for option in ("--macro-step", "--macro-steps", "--speed", "--wanted"):
        if option in found[:-1]:
            i = found.index(option)
            found[i : i + 2] = [f"{option}={found[i + 1]}"]
    return found


def _versions() -> str:
    numba = metadata.version("numba")
    return f"touchdown-cosim {VERSION}, Python {platform.python_version()}, numba {numba}"
