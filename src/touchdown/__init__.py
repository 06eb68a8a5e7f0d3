"""Rotor drops onto touchdown bearings, co-simulated with FMUs.

>>> scene = touchdown.load("disk-caged-simplified").set({"run.duration": "10 ms"})
>>> touchdown.run(scene, in_process=True).summary["completed"]
True
"""

from __future__ import annotations

import os
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from touchdown.command.api.fmus import build, check
    from touchdown.command.api.machines import animate, catalogue, new, report
    from touchdown.command.api.rotor import Rotor
    from touchdown.command.api.run import Result, load, open_result, register_scheme, run, scenes
    from touchdown.command.api.studies import compare, figure, open_sweep, sweep, verdict
    from touchdown.master.common.errors import Ended, TouchdownError
    from touchdown.master.coupling.steppers.stepper import Stepper
    from touchdown.master.scene.scene import Scene
    from touchdown.master.scene.schemes import Scheme
    from touchdown.rotor.beams.body import PointMass
    from touchdown.rotor.beams.element import Element
    from touchdown.rotor.beams.shaft import Station, Support, Unbalance
    from touchdown.studies.sweep.design import Design

    __version__: str

__all__ = [
    "Design",
    "Element",
    "Ended",
    "PointMass",
    "Result",
    "Rotor",
    "Scene",
    "Scheme",
    "Station",
    "Stepper",
    "Support",
    "TouchdownError",
    "Unbalance",
    "__version__",
    "animate",
    "build",
    "catalogue",
    "check",
    "compare",
    "figure",
    "load",
    "new",
    "open_result",
    "open_sweep",
    "register_scheme",
    "report",
    "run",
    "scenes",
    "sweep",
    "verdict",
]

_HOMES = {
    "figure": "command.api.studies",
    "build": "command.api.fmus",
    "check": "command.api.fmus",
    "catalogue": "command.api.machines",
    "new": "command.api.machines",
    "animate": "command.api.machines",
    "report": "command.api.machines",
    "Rotor": "command.api.rotor",
    "open_result": "command.api.run",
    "run": "command.api.run",
    "Result": "command.api.run",
    "load": "command.api.run",
    "scenes": "command.api.run",
    "register_scheme": "command.api.run",
    "compare": "command.api.studies",
    "open_sweep": "command.api.studies",
    "sweep": "command.api.studies",
    "verdict": "command.api.studies",
    "Ended": "master.common.errors",
    "TouchdownError": "master.common.errors",
    "Stepper": "master.coupling.steppers.stepper",
    "Scene": "master.scene.scene",
    "Scheme": "master.scene.schemes",
    "Design": "studies.sweep.design",
    "Element": "rotor.beams.element",
    "PointMass": "rotor.beams.shaft",
    "Station": "rotor.beams.shaft",
    "Support": "rotor.beams.shaft",
    "Unbalance": "rotor.beams.shaft",
}

# In a wheel the packages lie in this folder. In a checkout they lie at its top: this file is
# TOP/src/touchdown/__init__.py there, and they are looked for in TOP first.
_top = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
if os.path.isfile(os.path.join(_top, "pyproject.toml")) and os.path.isdir(os.path.join(_top, "modelkit")):
    __path__.insert(0, _top)


def __getattr__(name: str) -> object:
    """A public name, imported when it is first asked for: numpy and numba take their time."""
    if name == "__version__":
        from touchdown.fmus.version import VERSION

        value: object = VERSION
    elif name in _HOMES:
        value = getattr(import_module(f"touchdown.{_HOMES[name]}"), name)
    else:
        raise AttributeError(f"module 'touchdown' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
