"""How a run's components ended, as a file beside its recording: what pictures and reports read later."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from touchdown.master.common.files import replace_text
from touchdown.master.components.component import Kind, Variable
from touchdown.master.coupling.connections import Attachment, Connection
from touchdown.master.results.ending import Ending, LastValues
from touchdown.master.results.folder import ENDING
from touchdown.modelkit.variables import Causality, Variability

COLUMNS = (
    *("name", "reference", "kind", "causality", "variability", "unit", "minimum", "maximum", "start"),
    *("description", "element", "choices", "value"),
)
"""Of a variable, in the order of its row in the file; unit and value in SI."""


def write_ending(folder: Path, ending: Ending, warnings: Iterable[str]) -> None:
    """Write what `read_ending` reads. Raises OSError."""
    values = {
        "columns": COLUMNS,
        "components": {name: _rows(component) for name, component in ending.components.items()},
        "attachments": [list(vars(a).values()) for a in ending.attachments],
        "connections": [list(vars(c).values()) for c in ending.connections],
        "warnings": list(warnings),
    }
    replace_text(folder / ENDING, json.dumps(values, separators=(",", ":")) + "\n")


def _rows(component: LastValues) -> list[list[object]]:
    return [
        [*(getattr(variable, column) for column in COLUMNS[:-1]), component.values[name]]
        for name, variable in component.variables.items()
    ]


def read_ending(values: Mapping[str, Any]) -> tuple[Ending, list[str]]:
    """The ending and the warnings in the file's `values`. Raises ValueError, KeyError or TypeError."""
    return (
        Ending(
            {name: _last_values(rows) for name, rows in values["components"].items()},
            tuple(Attachment(*parts) for parts in values["attachments"]),
            tuple(_connection(*parts) for parts in values["connections"]),
        ),
        [str(warning) for warning in values["warnings"]],
    )


def _last_values(rows: Iterable[Iterable[Any]]) -> LastValues:
    told = [_variable(*row) for row in rows]
    return LastValues({v.name: v for v, _ in told}, {v.name: value for v, value in told})


def _variable(
    name: str, reference: int, kind: str, causality: str, variability: str, *others: Any
) -> tuple[Variable, float]:
    *about, value = others
    kinds = Kind(kind), Causality(causality), Variability(variability)
    return Variable(name, reference, *kinds, *about), value


def _connection(*parts: Any) -> Connection:
    source, output, target, given, scale = parts
    return Connection(source, output, target, given, scale and (scale[0], scale[1]))
