"""Compile every model once before a long session, half of them beside the other half.

Left to the tests, two workers and the processes they start would compile the same kernels at once.
"""

from __future__ import annotations

import subprocess
import sys

STEP = 2e-5  # s
PROCESSES = 2


def warm_up() -> None:
    """What fails here fails in a test that says more."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    for running in [
        subprocess.Popen([sys.executable, __file__, str(k)], **quiet) for k in range(PROCESSES)
    ]:
        running.wait()


def compile_every(nth: int, of: int) -> None:
    """Start and step models, the largest of each process first."""
    from touchdown.fmus.recipes import names, recipe
    from touchdown.modelkit.instance import Instance

    models = sorted((recipe(name).model for name in names()), key=lambda model: -model.memory.itemsize)
    for model in models[nth::of]:
        instance = Instance(model)
        instance.start(0.0)
        instance.step(0.0, STEP)


if __name__ == "__main__":
    compile_every(int(sys.argv[1]), PROCESSES)
