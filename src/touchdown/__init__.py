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
    from touchdown.command.api.machines import (
        animate,
        catalogue,
        diff,
        export,
        import_foundation,
        import_mount,
        import_rotor,
        new,
        report,
        view,
    )
    from touchdown.command.api.result import Result
    from touchdown.command.api.rotor import Rotor
    from touchdown.command.api.run import load, open_result, register_scheme, run, scenes
    from touchdown.command.api.studies import (
        amb_margins,
        compare,
        figure,
        open_sweep,
        rank,
        survival,
        sweep,
        validate,
        verdict,
        whirl,
    )
    from touchdown.master.common.errors import Ended, TouchdownError
    from touchdown.master.coupling.steppers.stepper import Stepper
    from touchdown.master.quantities import Quantity
    from touchdown.master.scene.scene import Scene
    from touchdown.master.scene.schemes import Scheme
    from touchdown.rotor.beams.beam_body import PointMass
    from touchdown.rotor.beams.element import Element
    from touchdown.rotor.beams.shaft import Station, Support, Unbalance
    from touchdown.studies.sweep.design import Design

    __version__: str

__all__ = [
    "Design",
    "Element",
    "Ended",
    "PointMass",
    "Quantity",
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
    "amb_margins",
    "animate",
    "build",
    "catalogue",
    "check",
    "compare",
    "diff",
    "export",
    "figure",
    "import_foundation",
    "import_mount",
    "import_rotor",
    "load",
    "new",
    "open_result",
    "open_sweep",
    "rank",
    "register_scheme",
    "report",
    "run",
    "scenes",
    "survival",
    "sweep",
    "validate",
    "verdict",
    "view",
    "whirl",
]

_NAMES = {  # by the module that they are in
    "command.api.fmus": "build check",
    "command.api.machines": "animate catalogue diff export import_foundation import_mount import_rotor new "
    "report view",
    "command.api.result": "Result",
    "command.api.rotor": "Rotor",
    "command.api.run": "load open_result register_scheme run scenes",
    "command.api.studies": "amb_margins compare figure open_sweep rank survival sweep validate verdict "
    "whirl",
    "master.common.errors": "Ended TouchdownError",
    "master.coupling.steppers.stepper": "Stepper",
    "master.quantities": "Quantity",
    "master.scene.scene": "Scene",
    "master.scene.schemes": "Scheme",
    "studies.sweep.design": "Design",
    "rotor.beams.element": "Element",
    "rotor.beams.shaft": "PointMass Station Support Unbalance",
}
_HOMES = {name: module for module, names in _NAMES.items() for name in names.split()}

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
