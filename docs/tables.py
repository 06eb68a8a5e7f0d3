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
from touchdown.master.quantities import Quantity, quantities
from touchdown.master.scene.events import EventTable
from touchdown.master.scene.gaps import RotorGap
from touchdown.master.scene.requirements import KINDS, SIDES
from touchdown.master.scene.run_spec import RunSpec
from touchdown.master.scene.scene import ComponentSpec, Document, Scene
from touchdown.modelkit.kernel.writing import write
from touchdown.modelkit.reader import described_keys
from touchdown.rotor.beams.beam_body import PointMass
from touchdown.rotor.beams.shaft import Shaft, Support, Unbalance
from touchdown.rotor.file.parser import Blocks, Core, Disc, GapAt, Material, Sleeve

DOCS = Path(__file__).resolve().parent
BLOCK = re.compile(r"(<!-- table: (.+?) -->\n).*?(?=<!-- end -->)", re.DOTALL)
WORDY = (  # of what a value may be, with what a table says instead
    (re.compile(r"(?<=with a unit of )(\S+) \([^)]*\)"), r"\1"),  # all ways to write the unit
    (re.compile(r"^(?:text with a unit of|a number in) (\S+?)(?=,|$)"), r"\1"),
    (re.compile(r"(?<=\d) (?:m|s|rad|Pa|kg\S*|N\S*)(?=,| and|$)"), ""),
    (re.compile(r", such as '[^']*'"), ""),
)
DECLARED: dict[str, type] = {
    "the rotor": Shaft,
    "material": Material,
    "element": Core,
    "sleeve": Sleeve,
    "disc": Disc,
    "point_mass": PointMass,
    "unbalance": Unbalance,
    "support": Support,
    "gap of a rotor": GapAt,
    "superelement": Blocks,
    "the scene": Scene,
    "component": ComponentSpec,
    "run": RunSpec,
    "gap": RotorGap,
    "document": Document,
    "event": EventTable,
}


def of_keys(declared: type) -> list[str]:
    """Of the keys that a dataclass declares."""
    rows = (
        (f"`{name}`", shortly(meant), default, says)
        for name, meant, default, says in described_keys(declared)
    )
    return markdown(("key", "value", "default", "what"), rows)


def shortly(meant: str) -> str:
    """What a value may be, in few words.

    >>> shortly("text with a unit of m, above 0 m, such as '12.5 mm'")
    'm, above 0'
    """
    for pattern, short in WORDY:
        meant = pattern.sub(short, meant)
    return meant


def of_requirements() -> list[str]:
    """Of a scene's [requirements]."""
    rows = (
        (f"`{name}`", f"{SIDES[k.quantity.worse]}, such as {k.example}", f"`{k.quantity.key}`", k.says)
        for name, k in KINDS.items()
    )
    return markdown(("key", "limit", "quantity", "what"), rows)


def of_quantities() -> list[str]:
    """Of a summary's quantities, by groups."""
    found: list[str] = []
    every = {q.key for q in quantities()}
    told = [q for q in quantities() if not (q.key.endswith("_adiabatic") or peak_of(q.key) in every)]
    for group, members in groupby(told, lambda one: one.group):
        rows = ((f"`{q.key}`", OF.get(q.owner.value, q.owner.value), unit(q), words(q)) for q in members)
        found += [f"## {group[0].upper()}{group[1:]}", "", *markdown(HEAD, rows), ""]
    return found


HEAD = "key", "of", "unit", "words"


def peak_of(key: str) -> str:
    """The key of what a first impact has the value of, or ""; the page says it for all."""
    return key.replace("first_impact_", "peak_") if key.startswith("first_impact_") else ""


OF = {"": "run", "seats": ""}  # most are of a seat


def words(quantity: Quantity) -> str:
    """What it is, where its key does not say the same."""
    return "" if quantity.key.replace("_", " ") == quantity.words else quantity.words


def unit(quantity: Quantity) -> str:
    """In SI, and in which people read it, if that is another."""
    read_in = quantity.read_in
    return f"{quantity.unit} ({read_in})" if read_in not in ("", quantity.unit) else quantity.unit


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
