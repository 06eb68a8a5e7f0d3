"""Kernels that Python runs: what they leave is what machine code leaves, to the last bit."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ROOT
from slave_driver import TOUCHING

from touchdown.fmus.recipes import fmu_names, recipe
from touchdown.modelkit import instance as instances
from touchdown.modelkit.instance import Instance
from touchdown.modelkit.kernel import interpret, kernel
from touchdown.modelkit.model import Model, ModelError
from touchdown.modelkit.variables import Causality, MemoryRecord, Scalar

PHYSICS = ("modelkit", "rotor", "bearings")
QUICK = {
    *("amb", "amb_actuator", "amb_axial", "amb_controller", "bushing", "dc_link"),
    *("foundation", "housing", "mount", "rigid_rotor"),
}
TRIALS = 4
models = pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in fmu_names()]
)


def varied(model: Model, seed: int) -> Instance:
    """Every other parameter is up to 10 % off its default; a bearing's journal is in contact."""
    varied, rng = Instance(model), np.random.default_rng(seed)
    for slot in varied.slots:
        variable = slot.variable
        if variable.spec.kind is not Scalar.REAL:
            continue
        if slot.causality is Causality.INPUT:
            varied.reals[slot.index] = TOUCHING.get(variable.name, variable.default)
        elif slot.causality is Causality.PARAMETER and seed and rng.random() < 0.5:
            value = variable.default * rng.uniform(0.9, 1.1)
            if variable.problem(value) is None:
                varied.reals[slot.index] = value
    return varied


@models
def test_a_start_leaves_what_machine_code_leaves(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    model, equal = recipe(name).model, 0
    for seed in range(TRIALS):
        run, compiled = varied(model, seed), varied(model, seed)
        try:
            run.start(0.0)
        except ModelError:  # parameters that do not fit each other
            continue
        with monkeypatch.context() as patch:
            patch.setattr(instances, "interpret", lambda kernel, words: kernel(words))
            compiled.start(0.0)
        assert run.memory.tobytes() == compiled.memory.tobytes()
        equal += 1
    assert equal > TRIALS // 3


@kernel
def derive_a_root(words):
    root = math.sqrt(words[0] - 1.0)  # of the memory's first word, the time: 0 before a start
    return 1 if math.isnan(root) else 0


def test_what_python_refuses_is_left_to_machine_code() -> None:
    model = replace(recipe("housing").model, derive=derive_a_root, problems=("there is no such root",))
    with pytest.raises(ValueError, match="math domain error"):
        interpret(model.derive, Instance(model).words)
    with pytest.raises(ModelError, match="no such root"):
        Instance(model).start(0.0)


def kernels() -> Iterator[tuple[Path, ast.FunctionDef]]:
    for package in PHYSICS:
        for path in sorted((ROOT / package).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.FunctionDef):
                    marks = {ast.unparse(mark).partition("(")[0] for mark in node.decorator_list}
                    if marks & {"kernel", "inlined"}:
                        yield path, node


def test_no_kernel_raises_to_a_whole_power() -> None:
    """Machine code multiplies there, and Python calls the library's pow, which rounds differently.

    A cube that is written x**3.0 is left to the library by both.
    """
    powers = [
        f"{path.relative_to(ROOT)}:{node.lineno} {ast.unparse(node)}"
        for path, function in kernels()
        for node in ast.walk(function)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)
        if ast.unparse(node.right) in ("2", "2.0", "3", "4")
    ]
    assert not powers, "multiply, or call modelkit.numerics.squared"


def fields(kind: np.dtype) -> Iterator[str]:
    for name, (inner, *_) in (kind.fields or {}).items():
        yield name
        yield from fields(inner.subdtype[0] if inner.subdtype else inner)


@pytest.mark.parametrize("name", fmu_names())
def test_no_field_is_hidden_by_an_attribute_of_numpy(name: str) -> None:
    memory: Any = recipe(name).model.memory
    own = {name for name, value in vars(MemoryRecord).items() if isinstance(value, property)}
    hidden = {field for field in fields(memory) if hasattr(np.record, field)} - own
    assert not hidden, "give MemoryRecord a property of that name"
