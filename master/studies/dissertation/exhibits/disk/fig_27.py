"""Fig 27: which balls are pressed after 5 s."""

from __future__ import annotations

from touchdown.master.results.figures.contacts import draw_contacts
from touchdown.master.results.figures.style import sheet
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.bearings import SCENES
from touchdown.master.studies.dissertation.exhibits.drops import Drops, figure_of, finished, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

SOURCE = {"cageless detailed": 7, "caged detailed": 2}
ONE = "a ball at the edge of the loaded arc comes and goes with the pendulum"


def fig_27(drops: Drops) -> Exhibit:
    """Balls between the races at the end, and those that both of them press."""
    runs = dict(zip(SOURCE, drops.of([load_scene(SCENES[model]) for model in SOURCE]), strict=True))
    figure = sheet(16.4, 8.8)
    rows: list[Row] = []
    for axes, (model, run) in zip(figure.subplots(1, 2), runs.items(), strict=True):
        draw_contacts(axes, finished(run), seats_of(run)[0])
        source = SOURCE[model]
        within_one = (source - 1.0, source + 1.0)
        rows += [
            Row(
                f"{model}: loaded balls after 5 s",
                source,
                figure_of(run, "loaded_balls_end"),
                near=1.0 / source,
                why=ONE,
            ),
            Row(
                f"{model}: loaded balls, mean of the last second",
                within_one,
                figure_of(run, "loaded_balls_mean"),
                why="the source's count, more or less one",
            ),
        ]
    return Exhibit(figure, rows)
