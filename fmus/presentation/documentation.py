"""documentation/index.html of an FMU, derived from its model's declarations and docstrings."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from inspect import cleandoc
from itertools import groupby
from pathlib import Path

from ...modelkit.model import Model, Slot, slots
from ...modelkit.variables import Causality
from ..description.described_variables import causality
from ..python.host import NEEDED
from ..python.packed_sources import ROOT
from ..recipes import Recipe
from ..version import VERSION

SOURCE = "O. Halminen, Multibody models for examination of touchdown bearing systems (LUT, 2016)"
PHYSICS = ("touchdown.bearings.", "touchdown.rotor.")
HEADINGS = {
    Causality.PARAMETER: "Parameters",
    Causality.INPUT: "Inputs",
    Causality.OUTPUT: "Outputs",
    Causality.CALCULATED_PARAMETER: "Constants, known after initialisation",
    Causality.LOCAL: "Diagnostics",
}
STYLE = """
body { font: 15px/1.45 sans-serif; max-width: 60em; margin: 2em auto; padding: 0 1em; color: #222 }
h1 img { vertical-align: middle; margin-right: .4em }
pre { background: #f4f5f7; padding: .6em 1em; overflow-x: auto }
table { border-collapse: collapse; width: 100% }
td, th { text-align: left; vertical-align: top; padding: .15em .8em .15em 0; border-bottom: 1px solid #ddd }
td:first-child { font-family: monospace }
"""


def page(
    recipe: Recipe,
    needs: str = "",
    exposed: Sequence[Slot] | None = None,
) -> str:
    """HTML for the FMU of `recipe`.

    needs: what it needs in a host without Python; exposed: its variables as they are named, where
    they are not the model's own.
    """
    title = _plain(recipe.model.title)
    body = [
        f'<h1><img src="../terminalsAndIcons/icon.png" alt="">{title}</h1>',
        *article(recipe, needs, exposed),
    ]
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        + "\n".join(body)
        + f"\n<p>touchdown-cosim {VERSION}</p>\n</body>\n</html>\n"
    )


def article(
    recipe: Recipe,
    needs: str = "",
    exposed: Sequence[Slot] | None = None,
) -> list[str]:
    """The text below the title: pieces of HTML, headings at the beginnings of lines."""
    model = recipe.model
    introduction, *parts = _documented(recipe.model)
    body = [
        f"<p>{_plain(model.about)}.</p>",
        *_physics(introduction),
        *_validity(slots(model)),
        "<h2>What it needs</h2>",
        *([f"<p>{_plain(needs)}</p>"] if needs else _host()),
        *_example(recipe),
        *_tables(exposed or slots(model)),
    ]
    if parts:
        body.append("<h2>The equations of its parts</h2>")
    for text in parts:
        body += _prose(text, heading="h3")
    return body


# -- prose -------------------------------------------------------------------------------------------


def _documented(model: Model) -> list[str]:
    """Docstrings of the module that declares the model's kernels, and of the parts that one imports.

    Of a model that is not the project's: one that is empty.
    """
    if not model.advance.__module__.startswith(PHYSICS):
        return [""]
    text = _source(model.advance.__module__)
    parts = (name for name in _imports(text, model.advance.__module__) if name.startswith(PHYSICS))
    return [_docstring(text), *(_docstring(_source(name)) for name in parts)]


def _imports(text: str, importer: str) -> Iterator[str]:
    """Modules of the project that `text`, the source of `importer`, imports, in order, each once."""
    seen: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        package = importer.split(".")[: -node.level]
        source = ".".join((*package, *filter(None, [node.module])))
        for name in node.names:
            whole = f"{source}.{name.name}"
            module = whole if _path(whole).is_file() else source
            if module not in seen:
                seen.add(module)
                yield module


def _path(module: str) -> Path:
    _, *inside = module.split(".")  # ROOT is the folder of the whole package
    place = ROOT.joinpath(*inside)
    return place / "__init__.py" if place.is_dir() else place.with_suffix(".py")


def _source(module: str) -> str:
    return _path(module).read_text(encoding="utf-8")


def _docstring(text: str) -> str:
    return cleandoc(ast.get_docstring(ast.parse(text)) or "")


def _prose(text: str, heading: str = "") -> Iterator[str]:
    """HTML of a docstring: paragraphs, lists, and formulas, which are indented or in columns."""
    for number, block in enumerate(re.split(r"\n\s*\n", text)):
        if number == 0 and heading:
            yield f"<{heading}>{_words(block.rstrip('.'))}</{heading}>"
        elif block.startswith("    ") or re.search(r"\S {2,}\S", block):
            yield f"<pre>{_plain(cleandoc(block))}</pre>"
        elif block.startswith("- "):
            points = re.split(r"\n?^- ", block, flags=re.MULTILINE)[1:]
            yield "<ul>" + "".join(f"<li>{_words(point)}</li>" for point in points) + "</ul>"
        else:
            yield f"<p>{_words(block)}</p>"


def _physics(theory: str) -> Iterator[str]:
    """The theory that a model of the project follows."""
    if theory:
        yield from _prose(theory)
        yield (
            "<p>Numbers in parentheses are equations, tables, figures and sections of "
            f"{SOURCE}, with its errata corrected.</p>"
        )


def _words(text: str) -> str:
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", _plain(" ".join(text.split())))


def _plain(text: str) -> str:
    return escape(text, quote=False)


# -- what a host must know ---------------------------------------------------------------------------


def _validity(exposed: Sequence[Slot]) -> Iterator[str]:
    names = {slot.variable.name for slot in exposed}
    yield "<h2>Validity</h2>\n<ul>"
    yield "<li>SI units; x horizontal, y up, z along the shaft; angles and speeds counter-clockwise.</li>"
    yield (
        "<li>Parameters and inputs are checked against the bounds below at initialisation. A parameter out "
        "of bounds, an input that is not a finite number, a step that does not follow the last one: the "
        "call is refused, and a line in the log names the variable and the value.</li>"
    )
    if "journal.x" in names:
        yield (
            "<li>It is stepped before the bodies it carries, from their motion at the step's beginning; "
            "loads are means over the step, and their slopes. <code>*_free</code>, <code>inv_m</code> and "
            "the like let it carry copies of the bodies through the step; left at 0 the motion is taken as "
            "given and extrapolated, and the step must be short beside the contact.</li>"
        )
    else:
        yield (
            "<li>Loads are means over the macro step, with their slopes; they are taken as linear in time "
            "within it.</li>"
        )
    yield "</ul>"


def _host() -> Iterator[str]:
    yield (
        f"<p>Python 3.11 or later with {', '.join(NEEDED)}, as the program that loads it. A host "
        "without Python needs libpython loaded before; <code>touchdown check</code> prints the "
        "command line. <code>touchdown build --native</code> makes an FMU that needs no Python.</p>"
    )
    yield (
        "<p>It holds pythonfmu's libraries for 64-bit Linux and Windows. That for Windows was not run: it "
        "takes the Python whose <code>python3.dll</code> the host finds on its <code>PATH</code>, and "
        "needs the Visual C++ runtime. There is none for macOS.</p>"
    )
    yield (
        "<p>The first step on a machine compiles; the machine code is kept in "
        "<code>~/.cache/touchdown-cosim</code> or <code>$TOUCHDOWN_CACHE</code>. The path of the unpacked "
        "FMU must be plain letters, digits, spaces and <code>/ - _ . ~</code>: pythonfmu's library reads "
        "no other in a file URI.</p>"
    )


def _example(recipe: Recipe) -> Iterator[str]:
    exposed = slots(recipe.model)
    parameter = next(s for s in exposed if causality(s)[0] is Causality.PARAMETER and s.variable.default)
    shown = [s.variable.name for s in exposed if causality(s)[0] is Causality.OUTPUT][:2]
    name, value = parameter.variable.name, parameter.variable.default
    yield "<h2>Example</h2>"
    yield (
        "<pre>"
        + _plain(
            "from fmpy import simulate_fmu\n\n"
            "result = simulate_fmu(\n"
            f'    "{recipe.name}.fmu", stop_time=1e-3, step_size=2e-5, output_interval=2e-5,\n'
            f'    start_values={{"{name}": {value!r}}}, output={shown!r},\n'
            ")\n"
            "print(result[-1])\n"
        )
        + "</pre>"
    )


# -- variables ---------------------------------------------------------------------------------------


def _tables(exposed: Sequence[Slot]) -> Iterator[str]:
    for role, heading in HEADINGS.items():
        rows = list(_rows(slot for slot in exposed if causality(slot)[0] is role))
        if not rows:
            continue
        yield f"<h2>{heading}</h2>\n<table>"
        yield "<tr><th>name</th><th>start</th><th>unit</th><th>bounds</th><th>meaning</th></tr>"
        yield from rows
        yield "</table>"


def _rows(chosen: Iterable[Slot]) -> Iterator[str]:
    """A row for each variable; neighbours in a group that are alike share one."""
    groups: dict[str, list[Slot]] = {}
    for slot in chosen:
        groups.setdefault(re.sub(r"\[\d+\]", "[k]", slot.variable.name), []).append(slot)
    for group in groups.values():
        for cells, alike in groupby(group, _row_cells):
            first, *others = (slot.variable.name for slot in alike)
            name = f"{first}<br>… {others[-1]}" if others else first
            yield "<tr>" + "".join(f"<td>{cell}</td>" for cell in (name, *cells)) + "</tr>"


def _row_cells(slot: Slot) -> tuple[str, ...]:
    """The cells of a variable's row beside its name."""
    spec = slot.variable.spec
    return _start(slot), _plain(spec.unit), _bounds(slot), _plain(spec.meaning)


def _start(slot: Slot) -> str:
    settable = causality(slot)[0] in (Causality.PARAMETER, Causality.INPUT)
    return f"{slot.variable.default:g}" if settable else ""


def _bounds(slot: Slot) -> str:
    spec = slot.variable.spec
    bounds = []
    if spec.above is not None:
        bounds.append(f"&gt; {spec.above:g}")
    if spec.minimum is not None:
        bounds.append(f"≥ {spec.minimum:g}")
    if spec.maximum is not None:
        bounds.append(f"≤ {spec.maximum:g}")
    return ", ".join(bounds)
