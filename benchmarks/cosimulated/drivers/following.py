"""What the drivers share: a package and names of variables come in, their values at every step go out.

    python follow_TOOL.py SYSTEM.ssp ANSWER.npz OPTIONS COMPONENT.VARIABLE...

OPTIONS is JSON, of the tool's own. Drivers run in the tools' environments, without the project; the modules
of tests/master/interop/peers, which read packages, are on their path.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from driver import Drop, opened

Options = Mapping[str, object]


@dataclass
class Followed:
    """What a run gave."""

    rows: list[list[float]]  # of what was wanted, after every step of the master
    calls: int  # doSteps of all FMUs


def main(follow: Callable[[Drop, Options], Followed]) -> None:
    """Run the package of the command line with `follow`, and leave the answer."""
    package, target, options, *names = sys.argv[1:]
    found = follow(opened(package, names), json.loads(options))
    np.savez(target, rows=np.array(found.rows), calls=found.calls)
    sys.stdout.flush()
    os._exit(0)  # tools may unload FMUs after the interpreter that both need
