"""The command `touchdown`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from touchdown.master import verbs
from touchdown.master.common.errors import FAILED, TouchdownError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status. A user's mistake is one line on stderr."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    options = _parser().parse_args(_joined(given))
    try:
        return options.run(options)
    except TouchdownError as error:
        print(f"touchdown: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("touchdown: interrupted", file=sys.stderr)
        return 130
    except BrokenPipeError:
        return 0


def _joined(arguments: list[str]) -> list[str]:
    """Tie options to their values where these may be negative: argparse would take them for options."""
    found = list(arguments)
    for option in ("--macro-step", "--macro-steps", "--speed", "--wanted"):
        if option in found[:-1]:
            i = found.index(option)
            found[i : i + 2] = [f"{option}={found[i + 1]}"]
    return found


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="touchdown", description="Rotor drops onto touchdown bearings, co-simulated with FMUs."
    )
    added = parser.add_subparsers(required=True, metavar="VERB")
    for verb in verbs.ALL:
        verb.add_to(added)
    return parser
