"""Layers: each package, and each subpackage of one, imports only what lies below it."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from places import PACKAGES, ROOT

SCIENCE = {"numpy", "scipy", "numba"}
OWN = "touchdown"

LAYERS = {  # package: what it may import beside itself and the standard library
    "modelkit": {"llvmlite"} | SCIENCE,  # numba's own: calls by address
    "rotor": {"touchdown.modelkit"} | SCIENCE,
    "bearings": {"touchdown.modelkit"} | SCIENCE,
    "fmus": {"touchdown.modelkit", "touchdown.rotor", "touchdown.bearings", "pythonfmu", "llvmlite"}
    | SCIENCE,
    "master": {
        *("touchdown.modelkit", "touchdown.fmus", "tqdm", "fmpy", "h5py", "distributed"),
        "llvmlite",  # an FMU's logger, which has variable arguments
        *("numpy", "scipy", "pandas", "xarray"),
    },
    "reports.figures": {"touchdown.modelkit", "touchdown.master", "matplotlib", "numpy"},  # of one run
    "studies": {
        *("touchdown.modelkit", "touchdown.fmus", "touchdown.master", "touchdown.reports.figures"),
        *("numpy", "scipy", "pandas", "xarray", "matplotlib"),
    },
    "reports": {
        *("touchdown.modelkit", "touchdown.fmus", "touchdown.master", "touchdown.studies"),
        *("numpy", "matplotlib", "jinja2", "markupsafe", "imageio_ffmpeg"),
    },
    "command": {
        *("touchdown.modelkit", "touchdown.fmus", "touchdown.master", "touchdown.studies"),
        *("touchdown.reports", "touchdown.validation", "argcomplete", "numpy", "matplotlib"),
    },
    "validation": {"touchdown", "fmpy", "matplotlib"} | SCIENCE,  # above all others
}
BUDGETS = {  # lines of a package at most, with room for one feature. A commit that raises one says why
    "rotor": 6960,
    "bearings": 21710,
    "modelkit": 4390,
    "fmus": 3450,
    "master": 21200,
    "studies": 14120,
    "reports": 6445,
    "command": 3625,
    "validation": 4400,
}
MODELS = "modules that define a MODEL"
ORDER = {  # package: its subpackages and modules, each importing only from those after it
    "command": ("cli", "verbs", "options", "completion", "fault", "console", "api", "parameters"),
    "master": ("interop", "results", "coupling", "components", "scene", "quantities", "common"),
    "bearings": (
        "landing_sleeve",  # a bushing with faces
        MODELS,  # on their own: a new one needs no entry
        *(
            "catalogue",
            "rating",
            "supports",
            "magnetic",
            "angular",
            "rolling",
            "heat",
            "contact",
            "seat",
        ),
    ),
    "rotor": (
        *(
            "properties",
            "flexible",
            "rigid",
            "file",
            "imports",
            "static_deflection",
            "motion",
            "brake",
            "thrust",
            "table",
            "modal",
            "beams",
        ),
    ),
    "modelkit": (
        *("instance", "body", "needs", "model", "ports", "integrators", "numerics"),
        *("base_motion", "excitation", "gravity", "kernel"),
        *("variables", "sheets", "archives", "reader", "units", "errors", "status", "messages"),
    ),
    "validation": (
        *("dissertation", "references", "coupled", "bodies", "drops", "loops", "pulled", "rig", "rotors"),
        *("at_speed", "statics", "rings", "mounts", "contacts", "page", "case"),
    ),
    "fmus": (
        *("native", "build", "presentation", "recipes", "model_names", "slave", "variants", "description"),
        *("python", "fmu_messages", "version"),
    ),
}
RATED = {
    *("touchdown.master.results.ratings", "touchdown.reports"),
    *("touchdown.studies.machine", "touchdown.command.api.machines"),
    "touchdown.studies.rotor.whirl_prediction",
}
MODE_ERROR = {"touchdown.studies.rotor.mode_error"}
READERS = {  # of physics beside the co-simulation: what may be read, and by whom
    "touchdown.rotor": {
        *("touchdown.studies.rotor", "touchdown.command.verbs.machines"),
        "touchdown.command.api.rotor",
        *("touchdown.studies.machine", "touchdown.studies.loop"),
        *("touchdown.reports.chapters.machine", "touchdown.reports.drawings"),
    },
    "touchdown.bearings.angular": {"touchdown.studies.machine", "touchdown.master.results.clamped_pairs"},
    "touchdown.bearings.magnetic": {"touchdown.studies.loop"},
    "touchdown.bearings.rating": RATED,
    "touchdown.bearings.catalogue": RATED,
    "touchdown.bearings.heat": {"touchdown.master.results.heat", "touchdown.reports.chapters.heat"},
    "touchdown.bearings.supports.foundation": {"touchdown.studies.machine"},
    "touchdown.bearings.supports.mount_law": {
        "touchdown.studies.rotor.whirl_prediction",
        "touchdown.studies.machine",
    },
    "touchdown.bearings.contact.laws": MODE_ERROR,
    "touchdown.bearings.rolling": MODE_ERROR,
    "touchdown.bearings.contact.line": {
        *MODE_ERROR,
        *("touchdown.reports.chapters.machine", "touchdown.studies.machine"),
    },
    "touchdown.bearings.contact.materials": MODE_ERROR,
}
STEPPED = {"touchdown.modelkit.model", "touchdown.modelkit.instance"}


def modules(package: str) -> dict[str, Path]:
    """The modules of a package by their full names."""
    found: dict[str, Path] = {}
    for path in sorted((ROOT / package.replace(".", "/")).rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        found[".".join((OWN, *parts)).removesuffix(".__init__")] = path
    assert found
    return found


MODULES = {name: path for package in LAYERS for name, path in modules(package).items()}


def source(node: ast.ImportFrom, path: Path) -> str:
    """Full name of the module or package that an import in the file at `path` names."""
    package = (OWN, *path.relative_to(ROOT).parent.parts)
    above = package[: len(package) - node.level + 1] if node.level else ()
    return ".".join((*above, *filter(None, [node.module])))


def imports(path: Path) -> Iterator[str]:
    """Full names of what a module imports, anywhere in it; of the project's own, the modules."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = source(node, path)
            for name in node.names:
                whole = f"{module}.{name.name}"
                yield whole if whole in MODULES else module


def defines_model(path: Path) -> bool:
    """Whether a module defines a bearing's or a body's MODEL."""
    return "\nMODEL = Model(" in path.read_text(encoding="utf-8")


def within(name: str, allowed: set[str]) -> bool:
    """Whether a module is one of those allowed, or inside one."""
    return any(f"{name}.".startswith(f"{one}.") for one in allowed)


@pytest.mark.parametrize("package", LAYERS)
def test_a_package_imports_only_what_it_may(package: str) -> None:
    allowed = LAYERS[package] | {f"{OWN}.{package}"}
    for module, path in modules(package).items():
        here = allowed | {what for what, readers in READERS.items() if within(module, readers)}
        extra = {
            name
            for name in imports(path)
            if name.partition(".")[0] not in sys.stdlib_module_names and not within(name, here)
        }
        assert not extra, f"{path.relative_to(ROOT)} imports {sorted(extra)}"


@pytest.mark.parametrize("package", ORDER)
def test_no_import_points_up(package: str) -> None:
    order = ORDER[package]
    models = [name for name, path in modules(package).items() if defines_model(path)]
    if MODELS in order:
        at = order.index(MODELS)
        parts = [name.split(".")[2] for name in models if name.count(".") == 2]
        order = (*order[:at], *parts, *order[at + 1 :])
    for name, path in modules(package).items():
        if name.count(".") == 1:  # the package itself
            continue
        mine = name.split(".")[2]
        assert mine in order, f"{name} has no place in the order"
        above = {f"{OWN}.{package}.{other}" for other in order[: order.index(mine)]}
        upward = {other for other in imports(path) if within(other, above)}
        assert not upward, f"{name} imports {sorted(upward)}, which lies above it"


def test_no_two_modules_import_each_other() -> None:
    """Nor in a longer circle, functions' own imports counted too. Raises CycleError where they do."""
    graph = {
        name: {other for other in imports(path) if other in MODULES and other != name}
        for name, path in MODULES.items()
    }
    assert len(list(TopologicalSorter(graph).static_order())) == len(MODULES)


@pytest.mark.parametrize("package", PACKAGES)
def test_a_package_keeps_to_its_budget(package: str) -> None:
    lines = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in modules(package).values())
    assert lines <= BUDGETS[package], f"{package} has {lines} lines: delete some, or raise its budget"


def test_few_modules_speak_fmi() -> None:
    speakers = {
        name.removeprefix("touchdown.master.")
        for name, path in modules("master").items()
        if any(within(other, {"fmpy"}) for other in imports(path))
    }
    loading = {"components.fmu", "components.fmu3", "components.description"}
    assert speakers == loading | {"interop.check"}


def test_only_the_twin_steps_models_in_the_master() -> None:
    users = set()
    for name, path in modules("master").items():
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and source(node, path) in STEPPED:
                # a model may be handed on, its declarations read, and its errors caught, anywhere
                users |= {name for one in node.names if one.name not in ("Model", "ModelError", "slots")}
            elif isinstance(node, ast.Import):
                users |= {name for one in node.names if one.name in STEPPED}
    assert users == {"touchdown.master.components.in_process"}
