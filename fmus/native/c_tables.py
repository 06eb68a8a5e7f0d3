"""A model's declarations and messages as tables in C."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from string import Formatter
from typing import Any

import numpy as np

from ...modelkit import messages as steps
from ...modelkit import status
from ...modelkit.instance import FIRST_STEP, Instance
from ...modelkit.integrators.control import MAX_STEPS
from ...modelkit.model import Model, Slot, slots
from ...modelkit.variables import Causality, Scalar, as_tuple, layout
from .. import fmu_messages as calls
from ..slave import TIME_TOLERANCE
from .compiler import NativeError
from .kernels import PREFIX, scratch_words

OWN = {  # what only a native FMU has to say
    "NOT_HELD": "this FMU holds no constants for {chosen}; it was built for {held}; take the FMU in "
    "Python, or build it for other settings (a rotor's: touchdown build --native --modes)",
    "NO_MEMORY": "there is no memory left",
    "NO_MODEL_EXCHANGE": "it is an FMU for co-simulation only",
    "FOREIGN_GUID": "the GUID is not this FMU's; its description and its library do not belong together",
    "OLD_PROCESSOR": "this processor lacks AVX2, FMA or BMI2; build the FMU for a target that ends in -v2",
    "NOT_OFFERED": "the FMU does not offer this",
    "NO_ROOM": "there is too little room for the state",
    "NO_EVENT_MODE": "it has no event mode; instantiate it without",
    "NO_CATEGORY": "{name} is not a log category of this FMU",
    "OTHER_COUNT": "{given:d} values for variables that hold {held:d}",
}
_CONVERSIONS = {"": "s", "g": "g", ".9g": ".9g", "d": "u"}


def header(categories: Iterable[str]) -> str:
    """The file; categories: of what goes to the host's log."""
    lines = ["/* Written by touchdown.fmus.native.c_tables. */", *_numbers()]
    for name, template in {**_templates(steps), **_templates(calls), **OWN}.items():
        lines.append(f"#define SAY_{name} {quoted(printf(template)[0])}")
    lines.append(f"#define LOG_CATEGORIES {', '.join(map(quoted, categories))}")
    return "\n".join(lines) + "\n"


def printf(template: str) -> tuple[str, list[str]]:
    """printf's format for a template of `str.format`, and the names of its fields in order.

    Raises ValueError where C cannot say it.
    """
    text, names = "", []
    for plain, name, conversion, _ in Formatter().parse(template):
        if "%" in plain or (name is not None and conversion not in _CONVERSIONS):
            raise ValueError(f"C cannot print {template!r}")
        text += plain
        if name is not None:
            text += f"%{_CONVERSIONS[conversion or '']}"
            names.append(name)
    return text, names


def quoted(text: str) -> str:
    """A literal of C. Raises NativeError where it is not plain ASCII, which C can be sure to print."""
    if not text.isascii() or not text.isprintable():
        raise NativeError(f"{text!r} is not plain ASCII, which C can be sure to print; choose another word")
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def c_literal(text: str) -> str:
    """A literal of C for what goes into a text. Raises NativeError where a host's log would misread it."""
    if "%" in text:  # FMI's log takes a format
        raise NativeError(f"{text!r} has a percent sign, which begins a format in C; choose another word")
    return quoted(text)


def _templates(module: object) -> dict[str, str]:
    return {name: text for name, text in vars(module).items() if name.isupper() and isinstance(text, str)}


def _numbers() -> Iterator[str]:
    yield f"#define TIME_TOLERANCE {TIME_TOLERANCE!r} /* of a step, between begin and last end */"
    yield f"#define MAX_STEPS {MAX_STEPS}u"
    for name in (
        "BAD_INPUT",
        "BAD_LOAD",
        "ROW_OFF",
        "TOO_FAST",
        "TOO_HOT",
        "TOO_LONG_STEP",
        "TOO_MANY_STEPS",
    ):
        yield f"#define {name} {getattr(status, name)}"


Choice = tuple[float, ...]  # values of the parameters that tables depend on
_CAUSES = {Causality.PARAMETER: "PARAMETER", Causality.INPUT: "INPUT", Causality.OUTPUT: "OUTPUT"}
_KINDS = {Scalar.REAL: "REAL", Scalar.INTEGER: "INTEGER"}
ENTRIES = f"""
/* numba's convention: 0, or the code gave up; what it returns goes to *result */
int {PREFIX}derive(int64_t *result, void **why, double *words);
int {PREFIX}start(int64_t *result, void **why, double *words);
int {PREFIX}advance(int64_t *result, void **why, double *words, double *scratch, double time, double step);

int64_t derive(double *words)
{{
    int64_t result = 0;
    void *why = NULL;
    return {PREFIX}derive(&result, &why, words) ? RAISED : result;
}}

int64_t start(double *words)
{{
    int64_t result = 0;
    void *why = NULL;
    return {PREFIX}start(&result, &why, words) ? RAISED : 0;
}}

int64_t advance(double *words, double *scratch, double time, double step)
{{
    int64_t result = 0;
    void *why = NULL;
    return {PREFIX}advance(&result, &why, words, scratch, time, step) ? RAISED : result;
}}
"""


@dataclass(frozen=True)
class HeldConstants:
    """For which values of the parameters that its tables depend on an FMU holds constants."""

    choices: tuple[Choice, ...] = ()

    def choices_in_words(self, model: Model) -> str:
        """In words."""
        columns = zip(model.tabulated, zip(*self.choices, strict=True), strict=False)
        return "; ".join(f"{name} = {', '.join(map(str, dict.fromkeys(c)))}" for name, c in columns)


ARRAYS = ("slots", "defaults", "begun", "problems", "keys", "tables")  # by their names in C
PARTS = {  # of the memory, by what the FMI side calls where they begin
    "parameters": "p",
    "inputs": "u",
    "outputs": "o",
    "hidden": "s",
    "weights": "weight",
    "derived": "d",
    "message_numbers": "message_numbers",
    "time": "time",
    "evaluations": "evaluations",
}


def source(
    model: Model, identity: str, held: HeldConstants, constants: Mapping[str, str], entries: str = ENTRIES
) -> str:
    """The file, of a model whose FMU has the GUID `identity` and holds tables for `held`.

    constants: tables that the interface adds, by members of MODEL (`interfaces.FmiVersion.tables`);
    entries: `derive`, `start` and `advance` of model.h in C, where its kernels are not numba's.
    """
    exposed = slots(model)
    begins, begun = Instance(model).words, _begun(model)
    keys = [next(s.index for s in exposed if s.variable.name == name) for name in model.tabulated]
    places = memory_places(model)
    sections = [
        '#include "model.h"\n\n#include <math.h>',
        entries,
        *_slots(exposed),
        *constants.values(),
        _words("DEFAULTS", begins),
        _words("BEGUN", begun),
        *_problems(model),
        *_tables(model, held),
        f"static const uint32_t KEYS[] = {{{_listed([*keys, 0])}}};",
    ]
    members = {
        "guid": quoted(identity),
        "held": quoted(held.choices_in_words(model)),
        **{name: name.upper() for name in (*ARRAYS, *constants)},
        "slot_count": len(exposed),
        "default_count": _filled(begins),
        "begun_count": _filled(begun),
        "problem_count": len(model.problems),
        "key_count": len(keys),
        "table_count": len(held.choices),
        "words": len(begins),
        "scratch": scratch_words(model),
        **places,
    }
    body = "".join(f"    .{name} = {value},\n" for name, value in members.items())
    return "\n".join([*sections, f"const Model MODEL = {{\n{body}}};\n"])


def by_word(kind: str, name: str, end: int, entries: Mapping[int, str]) -> str:
    """A table in C of what there is to say of each word before `end`."""
    listed = ", ".join(f"[{index}] = {text}" for index, text in entries.items())
    return f"static const {kind} {name}[{end}] = {{{listed}}};"


def hidden(model: Model) -> int:
    """The word behind those of variables."""
    return memory_places(model)["hidden"]


def memory_places(model: Model) -> dict[str, int]:
    """Where the parts of the memory begin that the FMI side knows, in words."""
    fields: Any = model.memory.fields
    return {name: fields[part][1] // 8 for name, part in PARTS.items()}


def tabulated_constants(model: Model, choice: Choice) -> np.ndarray:
    """Words of m.d for values of the parameters that a model's tables depend on."""
    assert model.tables is not None
    parameters = replace(model.parameters(), **dict(zip(model.tabulated, choice, strict=True)))
    return model.tables(parameters).view("f8").ravel()


def _slots(exposed: Sequence[Slot]) -> Iterator[str]:
    """The variables."""
    yield "static const Slot SLOTS[] = {"
    for slot in exposed:
        spec = slot.variable.spec
        unit = "" if spec.unit == "1" else f" {spec.unit}"
        bounds = (
            _number(spec.above, "-INFINITY"),
            _number(spec.minimum, "-INFINITY"),
            _number(spec.maximum, "INFINITY"),
        )
        yield (
            f"    {{{c_literal(slot.variable.name)}, {c_literal(unit)}, {', '.join(bounds)}, {slot.index}, "
            f"{access(slot)}}},"
        )
    yield "};"


def access(slot: Slot) -> str:
    """The access to a variable, in C."""
    tunable = " | TUNABLE" if slot.variable.spec.tunable else ""
    return f"{_KINDS[slot.variable.spec.kind]} | {_CAUSES[slot.causality]}{tunable}"


def _begun(model: Model) -> np.ndarray:
    """Words that an instance has at its start, with any parameters; the others of these parts are 0."""
    begun = np.zeros(1, model.memory)
    begun["h"] = FIRST_STEP
    for part, declaration in (("o", model.outputs), ("s", model.hidden)):
        begun[part] = np.array([as_tuple(declaration())], layout(declaration))
    return begun.view("f8")


def _problems(model: Model) -> Iterator[str]:
    yield "static const Problem PROBLEMS[] = {"
    for text in model.problems:
        form, names = printf(text)
        numbers = [int(name) for name in names]
        yield f"    {{{quoted(form)}, {{{_listed([*numbers, *[0] * (4 - len(numbers))])}}}}},"
    yield "    {0}};"


def _tables(model: Model, held: HeldConstants) -> Iterator[str]:
    """Constants for each choice that is held; their words count from the beginning of the memory."""
    fields: Any = model.memory.fields
    rows: list[str] = []
    for number, choice in enumerate(held.choices):
        words = tabulated_constants(model, choice)
        bits = (value if isinstance(value, int) else np.float64(value).view("i8") for value in choice)
        yield f"static const int64_t VALUES_{number}[] = {{{_listed([*bits, 0])}}};"
        yield _words(f"CONSTANTS_{number}", words, fields["d"][1] // 8)
        rows.append(f"    {{VALUES_{number}, CONSTANTS_{number}, {_filled(words)}}},")
    yield "\n".join(["static const Table TABLES[] = {", *rows, "    {0}};"])


def _words(name: str, values: np.ndarray, first: int = 0) -> str:
    """The words of `values` that are not zero, and one more that is."""
    bits = np.ascontiguousarray(values).view("u8")
    rows = [f"    {{{first + i}, 0x{int(bits[i]):x}u}}," for i in np.flatnonzero(bits)]
    return "\n".join([f"static const Word {name}[] = {{", *rows, "    {0}};"])


def _filled(values: np.ndarray) -> int:
    return int(np.count_nonzero(np.ascontiguousarray(values).view("u8")))


def _listed(values: Iterable[int]) -> str:
    return ", ".join(map(str, values))


def _number(value: float | None, nothing: str) -> str:
    return nothing if value is None else repr(float(value))
