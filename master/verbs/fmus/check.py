"""Check FMUs."""

from __future__ import annotations

import argparse
from pathlib import Path

from touchdown.master.common.errors import FAILED
from touchdown.master.scene.run_spec import CALL_TIMEOUT
from touchdown.master.verbs import completion
from touchdown.master.verbs.arguments import above_zero
from touchdown.master.verbs.completion import complete
from touchdown.master.verbs.screen import say_whose_code_runs
from touchdown.master.verbs.verb import Verb

EXAMPLES = (
    "touchdown check simplified_caged",
    "touchdown check my-bearing.fmu --as bearing --names my-names.toml",
)


def declare(verb: argparse.ArgumentParser) -> None:
    """Its options."""
    fmus = verb.add_argument("fmus", nargs="+", help="paths of .fmu files, or names of the project's own")
    complete(fmus, completion.fmus)
    roles = ("bearing", "rotor", "amb", "housing")
    verb.add_argument("--as", dest="role", choices=roles, help="what it is to stand in for")
    verb.add_argument(
        "--names", type=Path, metavar="FILE", help="TOML: what it calls the variables of the contract"
    )
    verb.add_argument(
        "--call-timeout",
        default=f"{CALL_TIMEOUT:g} s",
        metavar="TIME",
        help=f"what a call of an .fmu may take (default: {CALL_TIMEOUT:g} s)",
    )


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.components.library.sources import foreign
    from touchdown.master.interop.check import check_fmu
    from touchdown.master.scene.file import read_names

    names = read_names(options.names) if options.names else {}
    call_timeout = above_zero(options.call_timeout, "s", "--call-timeout")
    assert call_timeout is not None
    say_whose_code_runs({name: True for name in options.fmus if foreign(name)})
    failed = 0
    for name in options.fmus:
        report = check_fmu(name, options.role, names, call_timeout)
        print(report.text, flush=True)
        failed += bool(report.problems)
    return FAILED if failed else 0


VERB = Verb("check", "check FMUs: validity, contract, a dry run, proofs", EXAMPLES, declare, execute)
