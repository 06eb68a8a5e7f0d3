"""FMUs of others, made of body.c, scenes of them, and what these would do without any coupling error."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..fmus.build import write_zip
from ..master.scene.file import parse_scene
from ..master.scene.scene import Scene

COMPILER = shutil.which("cc") or shutil.which("gcc")
PLATFORM = "linux64"  # as FMI names it
SOURCE = Path(__file__).with_name("body.c")
VARIABLES = (  # in the order of body.c
    *((name, "parameter", "") for name in ("m", "k", "d", "kc", "dc", "rest", "gravity", "x0", "v0")),
    *((name, "parameter", "") for name in ("clamped", "one_sided", "follows", "x2_0")),
    *(("x2", "input", "m"), ("v2", "input", "m/s"), ("f_in", "input", "N")),
    *(("x", "output", "m"), ("v", "output", "m/s"), ("f", "output", "N")),
    *(("lost", "output", ""), ("elapsed", "output", "")),
)
STARTS = {"m": 1.0}
UNITS = {"m": 'm="1"', "m/s": 'm="1" s="-1"', "N": 'kg="1" m="1" s="-2"'}  # by name, for any factor


@dataclass(frozen=True)
class Kind:
    """The kind of an FMU, by its description."""

    states: bool = True  # it can be taken back
    any_step: bool = True  # it takes steps of any length
    units: bool = True
    newton: float = 1.0  # N in its unit of force
    metre: float = 1.0  # m in its unit of length


def _description(kind: Kind) -> str:
    """Its modelDescription.xml."""
    flags = {"canHandleVariableCommunicationStepSize": kind.any_step, "canGetAndSetFMUstate": kind.states}
    attributes = " ".join(f'{name}="{str(value).lower()}"' for name, value in flags.items())
    factors = {"m": kind.metre, "m/s": kind.metre, "N": kind.newton}
    units = [
        f'<Unit name="{unit}"><BaseUnit {base} factor="{factors[unit]}"/></Unit>'
        for unit, base in UNITS.items()
    ]
    outputs = [k for k, (_, causality, _) in enumerate(VARIABLES, 1) if causality == "output"]
    unknowns = "".join(f'<Unknown index="{k}"/>' for k in outputs)
    return (
        '<fmiModelDescription fmiVersion="2.0" modelName="body" guid="0">'
        f'<CoSimulation modelIdentifier="body" {attributes}/>'
        f"{'<UnitDefinitions>' + ''.join(units) + '</UnitDefinitions>' if kind.units else ''}"
        f"<ModelVariables>{''.join(_variable(k, kind) for k in range(len(VARIABLES)))}</ModelVariables>"
        f"<ModelStructure><Outputs>{unknowns}</Outputs><InitialUnknowns>{unknowns}</InitialUnknowns>"
        "</ModelStructure></fmiModelDescription>"
    )


def _variable(reference: int, kind: Kind) -> str:
    name, causality, unit = VARIABLES[reference]
    start = "" if causality == "output" else f' start="{STARTS.get(name, 0.0)}"'
    fixed = ' variability="fixed"' if causality == "parameter" else ""
    measured = f' unit="{unit}"' if unit and kind.units else ""
    return (
        f'<ScalarVariable name="{name}" valueReference="{reference}" causality="{causality}"{fixed}>'
        f"<Real{measured}{start}/></ScalarVariable>"
    )


def compiled(folder: Path) -> Path:
    """The library."""
    assert COMPILER is not None
    path = folder / "body.so"
    options = ("-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-fvisibility=hidden")
    subprocess.run([COMPILER, *options, "-o", path, SOURCE, "-lm"], check=True)
    return path


def fmu(library: Path, name: str = "body", kind: Kind = Kind()) -> Path:
    """An FMU beside the library."""
    path = library.with_name(f"{name}.fmu")
    binary = {f"binaries/{PLATFORM}/body.so": library.read_bytes()}
    return write_zip(path, {"modelDescription.xml": _description(kind).encode(), **binary})


Settings = Mapping[str, float]
TWO = (["s1.f", "s2.f_in"], ["s2.x", "s1.x2"], ["s2.v", "s1.v2"])  # force there, motion back


def scene(
    path: Path, bodies: Mapping[str, Settings], wires: Sequence[object] = TWO, **tables: object
) -> Scene:
    """Bodies of one FMU, wired; `run` and other tables of a scene's file as they stand there."""
    components = {name: {"fmu": str(path), "set": dict(values)} for name, values in bodies.items()}
    return parse_scene({"components": components, "connect": list(wires), **tables}, "bodies", path.parent)


STIFFNESS = (10.0, 100.0, 1000.0)  # N/m: wall, coupling, wall


def oscillator(damping: float = 0.0) -> dict[str, Settings]:
    """Two masses of 1 kg on three springs, each with a damper of `damping` (N s/m), shot at each other."""
    k1, kc, k2 = STIFFNESS
    first = {"k": k1, "d": damping, "kc": kc, "dc": damping, "v0": 100.0}
    return {"s1": first, "s2": {"k": k2, "d": damping, "v0": -100.0}}


def exact_oscillator(times: np.ndarray, damping: float = 0.0) -> np.ndarray:
    """(x1, v1, x2, v2) at `times` (s), a row each."""
    k1, kc, k2 = STIFFNESS
    d = damping
    rates = np.array([
        [0.0, 1.0, 0.0, 0.0],
        [-k1 - kc, -2.0 * d, kc, d],
        [0.0, 0.0, 0.0, 1.0],
        [kc, d, -kc - k2, -2.0 * d],
    ])  # fmt: skip
    return _moved(rates, np.array([0.0, 100.0, 0.0, -100.0]), times)


def _moved(rates: np.ndarray, start: np.ndarray, times: np.ndarray) -> np.ndarray:
    """States at `times`, a row each, of what changes by rates @ state."""
    values, vectors = np.linalg.eig(rates)
    return ((vectors * np.linalg.solve(vectors, start)) @ np.exp(np.outer(values, times))).real.T


def energy(states: np.ndarray) -> np.ndarray:
    """Of the oscillator (J), a value for each row (x1, v1, x2, v2)."""
    x1, v1, x2, v2 = states.T
    k1, kc, k2 = STIFFNESS
    return 0.5 * (v1**2 + v2**2 + k1 * x1**2 + kc * (x1 - x2) ** 2 + k2 * x2**2)


CAR = {  # a chassis on a wheel, which a step of the road (0.1 m) lifts
    "chassis": {"m": 400.0, "kc": 15000.0, "dc": 1000.0},
    "wheel": {"m": 40.0, "k": 150000.0, "rest": 0.1},
}
CAR_WIRES = (["chassis.f", "wheel.f_in"], ["wheel.x", "chassis.x2"], ["wheel.v", "chassis.v2"])


def exact_car(times: np.ndarray) -> np.ndarray:
    """(x, v) of chassis and wheel at `times` (s), a row each."""
    k, d, tyre = 15000.0, 1000.0, 150000.0
    rates = np.array([
        [0.0, 1.0, 0.0, 0.0, 0.0],
        [-k / 400.0, -d / 400.0, k / 400.0, d / 400.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0],
        [k / 40.0, d / 40.0, -(k + tyre) / 40.0, -d / 40.0, tyre / 40.0],
        [0.0, 0.0, 0.0, 0.0, 0.0],
    ])  # fmt: skip
    return _moved(rates, np.array([0.0, 0.0, 0.0, 0.0, 0.1]), times)[:, :4]


def bounce(rate: float = 1000.0) -> dict[str, Settings]:
    """A ball of 1 kg dropped by 1 mm on a one-sided spring, on which it would swing at `rate` (rad/s)."""
    ground = {"clamped": 1.0, "one_sided": 1.0, "kc": rate**2}
    return {"s1": ground, "s2": {"gravity": 9.81, "x0": 1e-3}}
