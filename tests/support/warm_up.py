"""Compile every model once before a long session, in process and as FMUs beside each other.

Left to the tests, two workers and the processes they start would compile the same kernels at once: an
FMU's sources and the checkout's have machine code of their own, but models share most of it.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

STEP = 2e-5  # s


def warm_up() -> None:
    """Both ways, each in a process; what fails here fails in a test that says more."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    for running in [subprocess.Popen([sys.executable, __file__, way], **quiet) for way in WAYS]:
        running.wait()


def models() -> None:
    """Start and step each model in process."""
    from touchdown.fmus.recipes import names, recipe
    from touchdown.modelkit.instance import Instance

    for name in names():
        instance = Instance(recipe(name).model)
        instance.start(0.0)
        instance.step(0.0, STEP)


def fmus() -> None:
    """Start and step each FMU."""
    from fmpy import extract
    from slave_driver import Slave

    from touchdown.fmus.build import cached
    from touchdown.fmus.recipes import names, recipe

    with tempfile.TemporaryDirectory() as folder:
        for name in names():
            unpacked = extract(str(cached(recipe(name))), str(Path(folder, name)))
            Slave(unpacked).start().run(0, 1)


WAYS = {"models": models, "fmus": fmus}

if __name__ == "__main__":
    WAYS[sys.argv[1]]()
