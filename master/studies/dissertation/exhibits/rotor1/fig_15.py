"""Fig 15: spectra of rotor I while it runs down for 16 s."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from touchdown.master.results.figures.style import sheet
from touchdown.master.results.figures.waterfall import motion_waterfall
from touchdown.master.results.motion.spectra import lines, on_grid, waterfall
from touchdown.master.scene.file import load_scene
from touchdown.master.studies.dissertation.exhibits.drops import Drops, figure_of, finished, seats_of
from touchdown.master.studies.dissertation.exhibits.exhibit import Exhibit, Row

SWINGS = (30.0, 40.0)  # Hz, the source's
PENDULUM, BENDING = (20.0, 50.0, 4), (1300.0, 2000.0, 1)  # Hz, Hz, how many lines
HEIGHT = 0.05  # of the tallest line
NEAR_HZ = 2.0
FITTED = "the rolling resistance (0.011) is fitted to it; the stated models hardly slow down"
WHICH = "the source does not say of which part its lines are"
PARTS = (("first", 0), ("last", -1))


def fig_15(drops: Drops) -> Exhibit:
    """Velocity and displacement at bearing 1 in eight parts of 2 s."""
    (run,) = drops.of([load_scene("rotor1-waterfall")])
    figure, seat = sheet(), seats_of(run)[0]
    motion_waterfall(figure, finished(run), seat)
    rows = [
        Row("speed after 16 s [rpm]", 7780.0, figure_of(run, "rotor_speed_end_rpm"), near=0.016, why=FITTED)
    ]
    grid = on_grid(run.recording.time) & (run.recording.time >= -1e-9)
    frequency, _, x = waterfall(run.recording.time[grid], run.recording[seat.motion("x")][grid])
    _, _, vx = waterfall(run.recording.time[grid], run.recording[seat.motion("vx")][grid])
    for name, part in PARTS:
        for source, found in beside(SWINGS, lines(frequency, x[part], *PENDULUM)):
            rows.append(
                Row(
                    f"{name} 2 s: line of the displacement [Hz]",
                    source,
                    found,
                    near=NEAR_HZ / source,
                    why=WHICH if found is not None else f"no line near it; {WHICH}",
                )
            )
        ((bending, _),) = lines(frequency, vx[part], *BENDING)
        rows.append(Row(f"{name} 2 s: line of the velocity [Hz]", 1600.0, bending, near=0.02))
    return Exhibit(figure, rows)


def beside(
    sources: Sequence[float], found: Sequence[tuple[float, float]]
) -> Iterator[tuple[float, float | None]]:
    """Each of the source's lines (Hz), ascending, with the one of `found` (Hz, height) that belongs to it.

    A line belongs to the source's that is nearest to it; of several the tallest, None where there is none.
    Lower than HEIGHT of the tallest there is no line in a picture.
    """
    least = HEIGHT * max((height for _, height in found), default=0.0)
    for source in sources:
        near = [
            (height, hertz)
            for hertz, height in found
            if height >= least and min(sources, key=lambda other: abs(other - hertz)) == source
        ]
        yield source, max(near)[1] if near else None
