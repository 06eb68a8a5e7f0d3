"""Models whose kernels are written in C: the declarations as a struct, and entries that hand it over."""

from __future__ import annotations

import hashlib
import re
import runpy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...modelkit import status
from ...modelkit.model import Model, memory_layout, slots
from ...modelkit.variables import Nothing
from ..description.described_variables import base_unit
from ..recipes import Recipe
from .compiler import NativeError

ENTRIES = """
#include "memory.h"

int64_t derive(double *words)
{
    return model_derive((Memory *)words);
}

int64_t start(double *words)
{
    model_start((Memory *)words);
    return 0;
}

int64_t advance(double *words, double *scratch, double time, double step)
{
    (void)scratch;
    return model_advance((Memory *)words, time, step);
}
"""


OTHER_SOURCES = ("fmi2.c", "fmi3.c", "model.c", "numba.c")  # names of the other sources


class InC:
    """Stands for kernels that are not here but in a source in C."""

    def __init__(self, source: Path) -> None:
        self.source = source

    def __call__(self, *_: object) -> Any:
        """Refuse: NativeError."""
        raise NativeError(f"{self.source.name} is C; build the model with touchdown build --native")


def in_c(
    name: str,
    title: str,
    about: str,
    parameters: type,
    inputs: type,
    outputs: type,
    source: Path,
    hidden: type = Nothing,
    state: int = 1,
    problems: tuple[str, ...] = (),
) -> Model:
    """A model with declarations as any other's, and its kernels in the C file `source`.

    That defines `model_derive`, `model_start` and `model_advance` on a `Memory` (docs/native.md); `state`
    is how many numbers m->q holds, `problems` as in `modelkit.model.Model`.
    """
    kernels = InC(source)
    return Model(
        name=name,
        title=title,
        about=about,
        parameters=parameters,
        inputs=inputs,
        outputs=outputs,
        hidden=hidden,
        memory=memory_layout(parameters, inputs, outputs, state, hidden=hidden),
        derive=kernels,
        start=kernels,
        advance=kernels,
        problems=problems,
    )


def recipe_in_c(path: Path) -> Recipe:
    """The recipe of a model in C, from the Python file that declares it as MODEL; the file is run.

    Raises NativeError where it cannot be run or declares none.
    """
    try:
        model = runpy.run_path(str(path)).get("MODEL")
    except Exception as error:
        raise NativeError(f"cannot read {path}: {type(error).__name__}: {error}") from None
    if not isinstance(model, Model) or not isinstance(model.advance, InC):
        raise NativeError(f"{path} declares no MODEL made by in_c")
    _check_declarations(path, model)
    identifier = "".join(part.capitalize() for part in re.split(r"\W|_", model.name))
    if not re.fullmatch(r"[A-Za-z]\w*", identifier, re.ASCII):
        raise NativeError(
            f"{path}: {model.name!r} cannot name an FMU; begin with a letter, go on with a-z, 0-9, _"
        )
    text = _text(model.advance.source)
    content = hashlib.sha256(f"{path.read_text(encoding='utf-8')}\0{text}".encode()).hexdigest()[:16]
    return Recipe(model.name, identifier, "", content, replace(model, content=content))


def _check_declarations(path: Path, model: Model) -> None:
    """Raise NativeError where a variable is in no unit of SI, or its default is out of its own bounds."""
    for variable in (slot.variable for slot in slots(model)):
        problem = variable.problem(variable.default)
        if problem:
            raise NativeError(f"{path}: {problem}, and this is its default")
        try:
            base_unit(variable.spec.unit)
        except ValueError:
            raise NativeError(
                f"{path}: {variable.name} is in {variable.spec.unit!r}; units are m, kg, s, rad, N, J, W, "
                "Pa, 1 and what is made of them, such as N.s/m2"
            ) from None


def sources(model: Model) -> dict[str, str]:
    """The C files of a model in C: its own, and the header that declares its memory."""
    assert isinstance(model.advance, InC)
    source = model.advance.source
    name = source.name if source.suffix == ".c" and source.name not in OTHER_SOURCES else "kernels.c"
    return {name: _text(source), "memory.h": _header(model.memory)}


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise NativeError(f"cannot read {path}: {error}") from None


def _header(memory: np.dtype) -> str:
    """memory.h: the record that kernels see, and what they return."""
    statuses = ", ".join(f"{name} = {value}" for name, value in vars(status).items() if name.isupper())
    lines = [
        "/* Written by touchdown build from a model's declarations. */",
        "#ifndef MEMORY_H\n#define MEMORY_H\n\n#include <stdint.h>\n",
        "typedef struct {",
        *_members(memory, "    "),
        "} Memory;",
        f'_Static_assert(sizeof(Memory) == {memory.itemsize}, "words of 8 bytes without gaps");\n',
        f"enum {{ {statuses} }}; /* how a macro step ended */\n",
        "int64_t model_derive(Memory *m);",
        "void model_start(Memory *m);",
        "int64_t model_advance(Memory *m, double time, double step);\n",
        "#endif\n",
    ]
    return "\n".join(lines)


def _members(record: np.dtype, indent: str) -> list[str]:
    """Declarations of a record's fields, groups as structs."""
    lines: list[str] = []
    fields: Any = record.fields
    for name in record.names or ():
        kind = fields[name][0]
        size = "".join(f"[{count}]" for count in kind.shape)
        base = kind.base
        if not kind.itemsize:
            continue  # nothing is declared
        if base.fields is not None:
            lines += [f"{indent}struct {{", *_members(base, f"{indent}    "), f"{indent}}} {name}{size};"]
        else:
            lines.append(f"{indent}{'double' if base.kind == 'f' else 'int64_t'} {name}{size};")
    return lines
