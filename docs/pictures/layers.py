"""Draw layers.svg: the packages, the subpackages of master/, and who may import whom.

    python docs/pictures/layers.py

Text stands on boxes of its own colour and lines are grey, so that it can be read on white and on black.
"""

from __future__ import annotations

from html import escape
from pathlib import Path

ABOVE = (  # master/, each importing only from those below it
    ("command/", "its verbs, and the public names of touchdown"),
    ("reports/", "a run as a page to hand on, and as a film"),
    ("studies/", "many runs, or none: sweeps, machines"),
    ("reports/figures/", "pictures of a run"),
)
SUBPACKAGES = (  # of master/, the same
    ("interop", "the contract, SSP, checks"),
    ("results", "summary, verdict, spectra, stresses"),
    ("coupling", "system, steppers, energy ledger, recorder"),
    ("components", "what is stepped: an FMU, or a model in process"),
    ("scene", "what to run: files, settings, schemes"),
    ("quantities", "what a run tells: words, units, the worst"),
    ("common", "errors, units, files, processes"),
)
MASTER = Path(__file__).resolve().parents[2] / "master"
WIDTH, HEIGHT = 900, 636
PITCH = 44  # from one to the next
TOP = 620 - 54 - PITCH * len(SUBPACKAGES)  # of the box of master/
LINE = "#8a8a8a"
FILLS = {"door": "#ffe3b3", "master": "#cfe3f5", "part": "#eef5fb", "fmus": "#d5efdd", "physics": "#f7d9d3"}
INK = "#1d2a35"


def box(x: float, y: float, w: float, h: float, kind: str) -> str:
    """A rounded box."""
    return f'<rect x="{x}" y="{y}" width="{w}" height="{h}" rx="7" fill="{FILLS[kind]}" stroke="{LINE}"/>'


def text(x: float, y: float, words: str, style: str = "note", anchor: str = "start") -> str:
    """A line of text from, or around, (x, y)."""
    return f'<text x="{x}" y="{y}" class="{style}" text-anchor="{anchor}">{escape(words)}</text>'


def arrow(*points: tuple[float, float], dashed: bool = False) -> str:
    """A line through the points with a head at its end."""
    path = " ".join(f"{x},{y}" for x, y in points)
    dash = ' stroke-dasharray="6 4"' if dashed else ""
    return f'<polyline points="{path}" class="arrow" marker-end="url(#head)"{dash}/>'


def package(x: float, y: float, w: float, name: str, lines: tuple[str, ...], kind: str) -> list[str]:
    """A box with a package's name and what is in it."""
    drawn = [box(x, y, w, 34 + 17 * len(lines), kind), text(x + 14, y + 24, name, "name")]
    return drawn + [text(x + 14, y + 44 + 17 * i, line) for i, line in enumerate(lines)]


def column() -> list[str]:
    """What is above master/, and master/ with its subpackages in their order."""
    drawn = [box(20, TOP, 480, 620 - TOP, "master"), text(36, TOP + 26, "master/", "name")]
    for i, (name, meaning) in enumerate(ABOVE):
        y = 100 + (TOP - 100) // len(ABOVE) * i
        drawn += [box(20, y, 480, 32, "master"), text(36, y + 21, name, "part"), text(186, y + 21, meaning)]
    for i, (name, meaning) in enumerate(SUBPACKAGES):
        y = TOP + 42 + PITCH * i
        drawn += [
            box(36, y, 426, PITCH - 12, "part"),
            text(48, y + PITCH / 2, name, "part"),
            text(138, y + PITCH / 2, meaning),
        ]
    return [*drawn, arrow((481, 146), (481, 604))]


def packages() -> list[str]:
    """The packages beside master/, and the ways to them."""
    x, w, half = 570, 310, 148
    right = x + w - half
    slaves = ("one slave class, a script of a few lines", "for each FMU; descriptions, the build")
    base = ("variables declared once, kernels,", "integrators, ports, a running instance")
    rotor = ("rigid, flexible:", "beams, modes,", "stresses")
    bearings = ("a module a model,", "of contact, rolling", "and seat")
    return [
        *package(x, 100, w, "fmus/", slaves, "fmus"),
        *package(x, 292, half, "rotor/", rotor, "physics"),
        *package(right, 292, half, "bearings/", bearings, "physics"),
        *package(x, 492, w, "modelkit/", base, "physics"),
        *(arrow((c, 168), (c, 290)) for c in (x + half / 2, right + half / 2)),
        *(arrow((c, 377), (c, 490)) for c in (x + half / 2, right + half / 2)),
        text(x + w / 2, 222, "physics that knows", "grey", "middle"),
        text(x + w / 2, 239, "nothing of FMI", "grey", "middle"),
        arrow((500, 474), (535, 474), (535, 134), (x - 2, 134)),
        arrow((500, 526), (x - 2, 526)),
    ]


def door() -> list[str]:
    """What a user meets."""
    return [
        box(20, 16, 230, 50, "door"),
        text(34, 38, "$ touchdown run ...", "part"),
        text(34, 56, "the command"),
        box(270, 16, 230, 50, "door"),
        text(284, 38, "import touchdown", "part"),
        text(284, 56, "the public names"),
        box(570, 16, 310, 50, "door"),
        text(584, 38, "any other FMI 2.0 tool", "part"),
        text(584, 56, "takes the built FMUs as they are"),
        arrow((135, 66), (135, 98)),
        arrow((385, 66), (385, 98)),
        arrow((725, 66), (725, 98), dashed=True),
    ]


def picture() -> str:
    """The SVG. Raises ValueError where master/ has other subpackages than it shows."""
    members = [path for path in MASTER.iterdir() if path.is_dir() or path.suffix == ".py"]
    entries = {path.stem for path in members if not path.name.startswith(("_", "."))}
    if entries != {name for name, _ in SUBPACKAGES}:
        raise ValueError(f"master/ has {sorted(entries)}")
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        'aria-label="Layers: arrows are imports and point one way">'
        "<style>text{font:13px sans-serif;fill:" + INK + "}"
        ".name{font:bold 16px monospace}.part{font:bold 13px monospace}"
        f".grey{{font-style:italic;fill:{LINE}}}"
        f".arrow{{fill:none;stroke:{LINE};stroke-width:2}}</style>"
        '<defs><marker id="head" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" markerHeight="7" '
        f'orient="auto"><path d="M0,0 L10,5 L0,10 z" fill="{LINE}"/></marker></defs>'
    )
    return "\n".join([head, *door(), *column(), *packages(), "</svg>", ""])


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(picture(), encoding="utf-8")
