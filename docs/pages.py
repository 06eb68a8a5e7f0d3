"""Build the pages of the documentation: README, docs/, notebooks, public names, a page of theory per model.

    pip install -e '.[docs]'
    python docs/pages.py            # into build/docs; a warning is an error

Pages are gathered in build/docs-source and handed to Sphinx. Those of the models are made of the
docstrings and the declared variables, as the documentation inside the FMUs is; those of the public names
of their docstrings. Notebooks are executed; a cell that fails is an error. A link to a file of the
repository that is no page takes the file along. A link or a path in `code` to what is not there is an
error, and so is a picture of the layers or a table of quantities that is out of date.
"""

from __future__ import annotations

import inspect
import os
import re
import shutil
import sys
from collections.abc import Iterable, Iterator
from enum import EnumType
from html import unescape
from pathlib import Path

import tables
from pictures import layers
from sphinx.cmd.build import main as sphinx

import touchdown
from touchdown.fmus.model_names import models
from touchdown.fmus.presentation.documentation import article
from touchdown.fmus.recipes import Recipe, recipe

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "build" / "docs-source"
OUTPUT = ROOT / "build" / "docs"
NAMED = {  # files whose pages have other names
    "README.md": "index.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "docs/README.md": "start.md",
}
NOTEBOOKS = ROOT / "docs" / "notebooks"
FLEXIBLE = "rotor_I"  # any rotor file: their models are one
PATH = re.compile(
    r"`((?:modelkit|rotor|bearings|fmus|master|studies|reports|command|validation|src|docs|tests|benchmarks|examples)/[\w./-]*)`"
)
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)#\s]+)(#[^)\s]*)?\)")
CONTENTS = {  # pages in the order of the site
    "Learn": (
        *("start", "first-drop", "own-bearing", "wanted-error", "whirl-map", "rotor-to-report"),
        *("how-it-works", "glossary"),
    ),
    "Use": (
        *("own-machine", "bearings", "levitation", "studies", "results"),
        *("quantities", "reports", "systems", "elsewhere"),
        *(
            "native",
            "windows",
            "rotors",
            "rotor-file",
            "scene-file",
            "mounts",
            "axial",
            "friction",
            "coupling",
            "bonds",
            "api",
        ),
    ),
    "Background": ("physics", "validation", "reproduction", "stability", "speed", "peers"),
    "Theory": (),  # of the models
    "Development": ("architecture", "contract", "contributing", "changelog"),
}


def main() -> int:
    """Gather the pages and build them; returns the exit status."""
    for folder in (SOURCE, OUTPUT):
        shutil.rmtree(folder, ignore_errors=True)
    for path in written():
        write(page_of(path), with_links(path))
    if layers.picture() != (ROOT / "docs" / "pictures" / "layers.svg").read_text(encoding="utf-8"):
        sys.exit("docs/pictures/layers.svg is out of date; run docs/pictures/layers.py")
    if stale := [path.name for path, text in tables.pages().items() if tables.filled(text) != text]:
        sys.exit(f"{', '.join(stale)}: tables are out of date; run docs/tables.py")
    theories = {f"theory-{name}": recipe(name) for name in models()}
    theories["theory-flexible_rotor"] = recipe(FLEXIBLE)
    for name, model in theories.items():
        write(f"{name}.md", theory(model))
    write("api.md", api())
    index = SOURCE / "index.md"
    index.write_text(index.read_text(encoding="utf-8") + contents(theories), encoding="utf-8")
    return sphinx(["-W", "--keep-going", "-q", "-E", "-c", str(ROOT / "docs"), str(SOURCE), str(OUTPUT)])


def written() -> list[Path]:
    """The files of all pages that are written by hand."""
    docs = ROOT / "docs"
    return sorted({*(ROOT / name for name in NAMED), *docs.glob("*.md"), *NOTEBOOKS.glob("*.md")})


def page_of(path: Path) -> str:
    """The name of a file's page: all of them lie in one folder."""
    return NAMED.get(path.relative_to(ROOT).as_posix(), path.name)


def write(name: str, text: str) -> None:
    """Write a page."""
    SOURCE.mkdir(parents=True, exist_ok=True)
    (SOURCE / name).write_text(text, encoding="utf-8")


# -- pages that are written by hand ------------------------------------------------------------------


def with_links(path: Path) -> str:
    """Text of a Markdown file, its links to other files turned to what they are on the site."""
    pages = set(written())

    def turned(match: re.Match[str]) -> str:
        label, target, place = match[1], match[2], match[3] or ""
        if "://" in target:
            return match[0]
        file = Path(os.path.normpath(path.parent / target))
        if not file.is_file():
            sys.exit(f"{path.relative_to(ROOT)}: there is no {target}")
        if file in pages:
            return f"{label}({page_of(file)}{place})"
        along = Path("files") / file.relative_to(ROOT)
        (SOURCE / along).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, SOURCE / along)
        return f"{label}({along.as_posix()})"

    text = path.read_text(encoding="utf-8")
    if path.parent == NOTEBOOKS:
        text = with_download(text, path)
    for named in PATH.findall(text):
        if not (ROOT / named).exists():
            sys.exit(f"{path.relative_to(ROOT)}: there is no {named}")
    return LINK.sub(turned, text)


def with_download(text: str, path: Path) -> str:
    """Text of a notebook with a line below its title that offers it as .ipynb, executed."""
    title = re.search(r"^# .*\n", text, flags=re.MULTILINE)
    assert title, f"{path.name} has no title"
    offer = f"\n*This page is a notebook: {{nb-download}}`{path.stem}.ipynb`.*\n"
    return text[: title.end()] + offer + text[title.end() :]


def contents(models: Iterable[str]) -> str:
    """The tables of contents below the README."""
    text = ""
    for heading, names in CONTENTS.items():
        pages = names or models
        text += f"\n```{{toctree}}\n:hidden:\n:caption: {heading}\n\n" + "\n".join(pages) + "\n```\n"
    return text


# -- pages that are made -----------------------------------------------------------------------------


def theory(model: Recipe) -> str:
    """A model's equations and variables: the documentation inside its FMU, with headings of Markdown's."""
    body = "\n\n".join(article(model)).replace("<table>", '<table class="docutils">')
    body = re.sub(r"^<h2>(.*)</h2>$", lambda m: f"\n## {unescape(m[1])}\n", body, flags=re.MULTILINE)
    body = re.sub(r"^<h3>(.*)</h3>$", lambda m: f"\n### {unescape(m[1])}\n", body, flags=re.MULTILINE)
    return f"# {model.model.title}\n\n{body}\n"


def api() -> str:
    """The public names of `touchdown`, each with its docstring."""
    return "# From Python\n\n" + "\n".join(directives())


def directives() -> Iterator[str]:
    """What Sphinx puts the docstrings of the public names into, in their order."""
    yield directive("automodule", "touchdown")
    for name in getattr(touchdown, "__all__", ()):
        value = getattr(touchdown, name)
        if name.startswith("_"):
            continue
        kind = "autoclass" if inspect.isclass(value) else "autofunction" if callable(value) else "autodata"
        options = ("members",) if kind == "autoclass" else ()
        if isinstance(value, EnumType):
            options = ("members", "undoc-members")  # their values tell what they mean
        yield directive(kind, f"touchdown.{name}", *options)


def directive(kind: str, name: str, *options: str) -> str:
    """One of autodoc's directives, in Markdown."""
    lines = "".join(f"   :{option}:\n" for option in options)
    return f"```{{eval-rst}}\n.. {kind}:: {name}\n{lines}```\n"


if __name__ == "__main__":
    sys.exit(main())
