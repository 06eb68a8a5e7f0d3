# PYTHON_ARGCOMPLETE_OK
"""The command `touchdown`."""

from __future__ import annotations

import argparse
import re
import sys
import textwrap
import warnings
from collections.abc import Sequence
from contextlib import redirect_stdout
from difflib import get_close_matches
from typing import Any, NoReturn

import argcomplete

from ..master.common.errors import FAILED, TouchdownError, one_of
from ..master.common.files import NO_ROOM
from ..master.common.interrupts import signals_as_interrupt
from . import verbs
from .console import Escaping, flush_error, print_error, report_interrupt, show_any_text
from .fault import report_fault, versions

# Warnings of libraries that would say in lines of code what the command says, or shows, itself
SUPPRESSED_WARNINGS = (
    (UserWarning, "Glyph .* missing"),  # in a title: the picture shows a box
    (RuntimeWarning, ""),  # of numpy: a run that runs away is stopped, and has no figures
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status. What goes wrong is one line on stderr."""
    show_any_text()
    with redirect_stdout(sys.stdout and Escaping(sys.stdout)):
        try:
            status = _executed(sys.argv[1:] if arguments is None else list(arguments))
        except SystemExit as end:  # argparse's, after help, version, or what it could not read
            if isinstance(end.code, str):
                raise
            raise SystemExit(_delivered(end.code or 0)) from None
        return _delivered(status)


def _executed(arguments: list[str]) -> int:
    """The exit status of what is asked for."""
    try:
        options = _parsed(arguments)
        with warnings.catch_warnings():
            warnings.showwarning = lambda message, *_: print_error(f"warning: {message}")
            for kind, meant in SUPPRESSED_WARNINGS:
                warnings.filterwarnings("ignore", meant, kind)
            with signals_as_interrupt():
                return options.execute(options)
    except TouchdownError as error:
        print_error(str(error))
        return FAILED
    except KeyboardInterrupt as interrupt:
        return report_interrupt(str(interrupt))
    except BrokenPipeError:
        return 0
    except MemoryError:
        print_error("it needs more memory than there is; ask for less of it")
        return FAILED
    except OSError as error:
        if error.errno not in NO_ROOM:
            return report_fault(error, arguments)
        flush_error()  # or what is left to print would be refused, and said, again
        what = error.filename or "what it has to say"
        print_error(f"cannot write {what}: {error.strerror}; make room for it")
        return FAILED
    except Exception as error:
        return report_fault(error, arguments)


RENAMED = {"import-rotor": ["import", "rotor"], "import-mount": ["import", "mount"]}  # old verbs


def _in_current_words(arguments: list[str]) -> list[str]:
    """A command line without words of earlier versions; a line on stderr tells of each."""
    if arguments and arguments[0] in RENAMED:
        words = RENAMED[arguments[0]]
        print_error(f"{arguments[0]} is called {' '.join(words)} now")
        return [*words, *arguments[1:]]
    if arguments[:1] != ["run"]:
        return arguments
    if "--isolate" in arguments:
        print_error("--isolate does nothing now: third-party FMUs are isolated by default")
        arguments = [word for word in arguments if word != "--isolate"]
    words = re.sub("\0--macro-step[=\0]", "\0--set\0run.macro_step=", "\0".join(arguments)).split("\0")
    if words != arguments:
        print_error("--macro-step TIME is called --set run.macro_step=TIME now")
    return words


def _parsed(arguments: list[str]) -> argparse.Namespace:
    """The options of a command line. Raises TouchdownError for a verb or an option that does not exist."""
    arguments = _in_current_words(arguments)
    command = parser()
    argcomplete.autocomplete(command)  # answers the shell and exits where it was asked to
    names = [verb.name for verb in verbs.ALL]
    if arguments and not arguments[0].startswith("-") and arguments[0] not in names:
        raise TouchdownError(
            f"there is no verb {arguments[0]}; {one_of(arguments[0], names)}; see touchdown --help"
        )
    options, extra = command.parse_known_args(arguments)
    if not extra:
        return options
    verb, first = next(word for word in arguments if word in names), extra[0]
    see = f"see touchdown {verb} --help"
    if not first.startswith("-"):
        raise TouchdownError(f"touchdown {verb} takes no argument {first} here; {see}")
    known = set(re.findall(r"(?<![\w-])--([a-z][\w-]*)", options.help_text()))
    near = " or ".join(f"--{name}" for name in get_close_matches(first.lstrip("-"), sorted(known)))
    meant = f"did you mean {near}; " if near else ""
    raise TouchdownError(f"touchdown {verb} has no option {first}; {meant}{see}")


def _delivered(status: int) -> int:
    """The exit status, once all that was printed is out."""
    why = flush_error()
    if why:
        print_error(f"cannot write what it has to say: {why}; make room for it")
    return FAILED if why else status


SYNTAX = "touchdown [-h] [--version] VERB ..."


class _Parser(argparse.ArgumentParser):
    """A parser whose complaints are one line, too; -9e2 is a value, as from Python 3.14 on.

    Options are not shortened: one that is gone is not taken for another.
    """

    def __init__(self, **keywords: Any) -> None:
        super().__init__(**keywords, allow_abbrev=False)
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        print_error(f"{message}; see {self.prog.replace(SYNTAX, 'touchdown')} --help")
        raise SystemExit(FAILED)


def _verb_list() -> str:
    """The verbs by group, a line for each, for a terminal of 80 columns."""
    width = max(len(verb.name) for verb in verbs.ALL) + 4
    lines: list[str] = []
    for group, members in verbs.GROUPS.items():
        lines += [f"{group}:"]
        for verb in members:
            first, others = f"  {verb.name:{width - 2}}", " " * width
            lines += textwrap.wrap(verb.words, 79, initial_indent=first, subsequent_indent=others)
    return "\n".join(lines)


def parser() -> argparse.ArgumentParser:
    """The parser of the command line; `run` of its result does the work."""
    command = _Parser(
        prog="touchdown",
        usage=SYNTAX,
        description=f"Rotor drops onto touchdown bearings, co-simulated with FMUs.\n\n{_verb_list()}",
        epilog="`touchdown VERB --help` has the options of a verb, and examples.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.add_argument("--version", action="version", version=versions())
    added = command.add_subparsers(prog="touchdown", required=True, metavar="VERB", help=argparse.SUPPRESS)
    for verb in verbs.ALL:
        verb.add_to(added)
    return command
