"""What a verb of the command is."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Verb:
    """A verb: what it is called, what its help shows, its options, and what it does.

    Modules of verbs are imported for every command and at every <TAB>: what is slow to import (numba,
    matplotlib, the studies) is imported by `execute`.
    """

    name: str
    title: str  # one line in the list of verbs
    examples: tuple[str, ...]  # whole command lines, as they are typed
    declare: Callable[[argparse.ArgumentParser], None]
    execute: Callable[[argparse.Namespace], int]  # returns the exit status

    def add_to(self, verbs: Any) -> None:
        """Add it to the command; `verbs` are argparse's subparsers."""
        parser = verbs.add_parser(
            self.name,
            help=self.title,
            description=f"{self.title[0].upper()}{self.title[1:]}.",
            epilog="\n  ".join(("examples:", *self.examples)),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        self.declare(parser)
        parser.set_defaults(run=self.execute)
