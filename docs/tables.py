"""Write the tables of pages that are made of declarations: between the comments that name them.

    python docs/tables.py

A page has `<!-- table: NAME -->`, the table, and `<!-- end -->`. A test compares the pages with what this
would write.
"""

from __future__ import annotations

import re
from itertools import groupby
from pathlib import Path

from touchdown.master.common.text import markdown
from touchdown.master.quantities import Worse, quantities
from touchdown.master.scene.events import EventTable
from touchdown.master.scene.gaps import Gap
from touchdown.master.scene.requirements import KINDS
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Scene
from touchdown.modelkit.kernel.writing import write
from touchdown.modelkit.reader import described
from touchdown.rotor.beams.body import PointMass
from touchdown.rotor.beams.shaft import Shaft, Support, Unbalance
from touchdown.rotor.file.reader import Blocks, Core, Disc, GapAt, Layer, Material, Sleeve

DOCS = Path(__file__).resolve().parent
BLOCK = re.compile(r"(<!-- table: (.+?) -->\n).*?(?=<!-- end -->)", re.DOTALL)
UNITS = re.compile(r"(?<=with a unit of )(\S+) \([^)]*\)")  # all ways to write it
DECLARED: dict[str, type] = {
    "the rotor": Shaft,
    "material": Material,
    "element": Core,
    "sleeve": Sleeve,
    "layers": Layer,
    "disc": Disc,
    "point_mass": PointMass,
    "unbalance": Unbalance,
    "support": Support,
    "gap of a rotor": GapAt,
    "superelement": Blocks,
    "the scene": Scene,
    "component": ComponentSpec,
    "run": RunSpec,
    "gap": Gap,
    "event": EventTable,
}


def of_keys(declared: type) -> list[str]:
    """Of the keys that a dataclass declares."""
    rows = (
        (f"`{name}`", UNITS.sub(r"\1", meant), default, says)
        for name, meant, default, says in described(declared)
    )
    return markdown(("key", "value", "default", "what"), rows)


def of_requirements() -> list[str]:
    """Of a scene's [requirements]."""
    rows = (
        (f"`{name}`", BOUNDS[q.worse], q.words, q.unit, f"`{q.key}`")
        for name, q in ((name, kind.quantity) for name, kind in KINDS.items())
    )
    return markdown(("key", "limit", "what", "unit", "quantity"), rows)


BOUNDS = {Worse.SMALLER: "at least", Worse.LARGER: "at most"}


def of_quantities() -> list[str]:
    """Of a summary's quantities, by groups."""
    found: list[str] = []
    for group, members in groupby(quantities(), lambda one: one.group):
        rows = ((f"`{q.key}`", q.owner.value or "run", q.unit, q.read_in, q.words) for q in members)
        found += [f"## {group[0].upper()}{group[1:]}", "", *markdown(HEAD, rows), ""]
    return found


HEAD = "key", "of", "SI", "read in", "words"


def table(name: str) -> list[str]:
    """The table of that name."""
    if name == "quantities":
        return of_quantities()
    return of_requirements() if name == "requirements" else of_keys(DECLARED[name])


def filled(page: str) -> str:
    """A page with its tables as they are declared now."""
    return BLOCK.sub(lambda block: block[1] + "\n".join(["", *table(block[2]), "", ""]), page)


def pages() -> dict[Path, str]:
    """The pages that have such tables."""
    texts = {path: path.read_text(encoding="utf-8") for path in sorted(DOCS.glob("*.md"))}
    return {path: text for path, text in texts.items() if BLOCK.search(text)}


if __name__ == "__main__":
    for path, text in pages().items():
        write(path, filled(text))
