"""Tables 5 and 6: what the bearing models count."""

from __future__ import annotations

from touchdown.master.coupling.simulation import opened
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.bearings import COUNTS, SCENES
from touchdown.master.studies.dissertation.exhibits.drops import Drops
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

CONTACTS = "contacts"
"""Titles of Table 6's rows begin so; the others are Table 5's."""


def table_5(drops: Drops) -> Exhibit:
    """Coordinates and constraints of each model."""
    return Exhibit(None, _rows(of_contacts=False))


def table_6(drops: Drops) -> Exhibit:
    """Elastic contacts of each model."""
    notes = ["one contact of both rings through a ball stands for two; the source: 'reduced to'"]
    return Exhibit(None, _rows(of_contacts=True), notes)


def _rows(of_contacts: bool) -> list[Row]:
    rows: list[Row] = []
    for model, scene in SCENES.items():
        with opened(load_scene(scene), in_process=True) as system:
            system.initialise()
            for title, variables, source in COUNTS:
                if title.startswith(CONTACTS) == of_contacts:
                    count = sum(system.value(f"bearing.size.{variable}") for variable in variables)
                    rows.append(Row(f"{model}: {title}", source[model], count, near=0.0))
    return rows
