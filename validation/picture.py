"""Pictures of cases."""

from __future__ import annotations

from pathlib import Path

from .case import Case, Curves

FOLDER = Path("pictures", "validation")  # beside the page


def path(one: Case) -> Path:
    """Where the picture of a case is, from the page's folder."""
    return FOLDER / f"{one.name}.png"


def draw(curves: Curves, target: Path) -> None:
    """Their figures as points, ours as lines, as a PNG file; makes its folder."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    axes = figure.subplots()
    for label, line in curves.ours.items():
        axes.plot(*line, lw=1.2, label=label)
    axes.plot(*curves.theirs, "k.", ms=5, label=curves.points)
    axes.set(xlabel=curves.x, ylabel=curves.y)
    if curves.equal:
        axes.set_aspect("equal")
    figure.legend(fontsize=8, loc="outside lower center", ncols=2)
    target.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(target, dpi=100)
