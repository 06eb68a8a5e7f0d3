"""Check FMUs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from touchdown.master.common.errors import FAILED


def add_to(verbs: Any) -> None:
    """Add the verb to the command."""
    verb = verbs.add_parser("check", help="check FMUs: validity, contract, a dry run")
    verb.add_argument("fmus", nargs="+", help="paths of .fmu files, or names of the project's own")
    roles = ("bearing", "rotor", "amb", "housing")
    verb.add_argument("--as", dest="role", choices=roles, help="what it is to stand in for")
    verb.add_argument(
        "--names", type=Path, metavar="FILE", help="TOML: what it calls the variables of the contract"
    )
    verb.set_defaults(run=execute)


def execute(options: argparse.Namespace) -> int:
    """Do it; returns the exit status."""
    from touchdown.master.interop.check import check_fmu
    from touchdown.master.scene.file import read_names

    names = read_names(options.names) if options.names else {}
    failed = 0
    for name in options.fmus:
        report = check_fmu(name, options.role, names)
        print(report.text)
        failed += bool(report.problems)
    return FAILED if failed else 0
