"""The machine to scale with its gaps, and what happened in a run as a strip."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer
from matplotlib.text import Annotation, Text

import touchdown
from touchdown.reports.charts import _curves, inline
from touchdown.reports.drawings import SideView, Support, draw_side
from touchdown.reports.figures.style import BLUE, GREEN, ORANGE, RED, apart, sheet
from touchdown.reports.series import Chart, Line
from touchdown.reports.subject import Subject
from touchdown.reports.timeline import Event, Lane, lanes, timeline

GAPS = (
    Support(0.05, "gap", "seal A", gap=250e-6, left=100e-6, late=True),
    Support(0.05, "gap", "impeller", gap=300e-6, left=-10e-6, axial=True),
    Support(0.07, "touchdown", "bearing_A", gap=120e-6, left=-1e-6),
    Support(0.20, "magnetic", "amb_A", gap=400e-6, left=390e-6),
    Support(0.25, "gap", "lost", gap=200e-6),
)


def texts(axes: Axes) -> dict[str, Annotation]:
    return {text.get_text(): text for text in axes.texts if isinstance(text, Annotation)}


def test_a_bar_for_each_gap_at_its_place() -> None:
    """As tall as the gap, filled as far as it was closed; red where the rotor hit what it should not."""
    figure = sheet()
    draw_side(figure, SideView(touchdown.Rotor.load("rotor_I"), GAPS))
    view, bars = figure.axes
    drawn = {str(bar.get_label()): bar for bar in bars.containers if isinstance(bar, BarContainer)}
    heights = {label: bar.patches[0].get_height() for label, bar in drawn.items()}
    assert heights == pytest.approx(
        {"_seal A": 250.0, "_impeller": 300.0, "_bearing_A": 120.0, "_amb_A": 400.0, "_lost": 200.0,
         "_seal A, used": 150.0, "_impeller, used": 300.0, "_bearing_A, used": 120.0,
         "_amb_A, used": 10.0, "_lost, used": 0.0}
    )  # fmt: skip
    colours = [to_hex(drawn[f"_{s.label}"].patches[0].get_edgecolor()) for s in GAPS]
    assert colours == [GREEN, RED, BLUE, ORANGE, GREEN]
    found = texts(bars)
    assert list(found) == [
        "seal A\n250 µm\n100 µm left,\nnot valid",
        "impeller\n300 µm along\nclosed, 10 µm beyond",
        "bearing_A\n120 µm\ntouched",
        "amb_A\n400 µm\n390 µm left",
        "lost\n200 µm\nnot recorded",
    ]
    assert [one.xy[0] for one in found.values()] == pytest.approx([50.0, 50.0, 70.0, 200.0, 250.0])
    assert view.get_xlim() == bars.get_xlim()
    assert {"seal A\nimpeller", "bearing_A", "amb_A", "lost"} <= set(texts(view))


def test_no_label_stands_on_another() -> None:
    figure = sheet()
    draw_side(figure, SideView(touchdown.Rotor.load("rotor_I"), GAPS))
    figure.draw_without_rendering()
    for axes in figure.axes:
        boxes = [Text.get_window_extent(text) for text in axes.texts if text.get_text()]  # without its line
        assert len(boxes) > 3
        assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_places_are_moved_apart_and_no_further() -> None:
    np.testing.assert_allclose(apart([1.0, 5.0], [2.0, 2.0], 0.0, 10.0), [1.0, 5.0])
    np.testing.assert_allclose(apart([5.0, 5.0, 5.0], [2.0, 2.0, 4.0], 0.0, 10.0), [2.5, 4.5, 7.5])
    np.testing.assert_allclose(apart([0.0, 9.9], [2.0, 2.0], 0.0, 10.0), [1.0, 9.0])
    assert len(apart([], [], 0.0, 1.0)) == 0


def test_a_run_s_events_stand_in_their_order(dropped: Path) -> None:
    """From the shutdown to the end, contacts as recorded, a fault in red, whirls as bars."""
    result = touchdown.open_result(dropped)
    subject = Subject(result)
    rotor, seat = lanes(subject)
    assert [e.words.split("\n")[0] for e in rotor.events] == ["shutdown", "end"]
    assert rotor.events[-1].time == pytest.approx(0.06)
    assert seat.events[0] == Event(subject.summary["seats"]["A"]["first_contact_time"], "first contact")
    assert seat.contacts is not None
    force, time = result.recording["bearing.contact.force"], result.recording.time
    inside = (time[:, None] >= seat.contacts[:, 0]) & (time[:, None] < seat.contacts[:, 1])
    np.testing.assert_array_equal(inside.any(axis=1), force > 0.0)
    assert seat.name == f"A (bearing)\n{len(seat.contacts)} contacts"
    one = {"direction": "backward", "start": 0.02, "end": 0.05, "revolutions": 3.0, "frequency": 90.0}
    told = {
        **subject.summary["seats"]["A"],
        "seized_time": 0.03,
        "whirl_episodes": [one | {"goes_on": False}],
    }
    made = {**subject.summary, "seats": {"A": told}, "valid_until": 0.03}
    made["gaps"] = {"seal": {"least": -2e-6, "least_time": 0.02, "closed_time": 0.01}}
    rotor, seat, gaps = lanes(Subject(replace(result, summary=made)))
    assert [(e.time, e.grave) for e in rotor.events[1:2]] == [(0.03, True)]
    assert "backward whirl until 50 ms, 90 Hz" in [" ".join(e.words.split()) for e in seat.events]
    assert gaps == Lane("gaps", [Event(0.01, "seal closed", True)])
    (axes,) = timeline(sheet(), [rotor, seat, gaps], 0.06)
    assert [to_hex(t.get_color()) for t in axes.texts if "seizes" in t.get_text()] == [RED]
    bars = {b.get_label(): b for b in axes.collections}
    (whirl,) = bars["_backward"].get_paths()
    times = np.asarray(whirl.vertices)[:, 0]
    assert (times.min(), times.max()) == pytest.approx((0.02, 0.05))
    whirled, touched = (np.asarray(bars[name].get_facecolor())[0] for name in ("_backward", "_contacts"))
    assert not np.allclose(whirled, touched)


@pytest.mark.parametrize("end", [0.06, 60.0])
def test_a_strip_of_any_length_can_be_read(end: float) -> None:
    """No words over others, though events crowd at the landing and at the end."""
    times = [0.0047, 0.0049, 0.3 * end, 0.98 * end, 0.99 * end]
    crowd = [Event(time, f"what happens {k}") for k, time in enumerate(times)]
    figure = sheet()
    (axes,) = timeline(figure, [Lane("rotor", crowd), Lane("A", crowd)], end)
    figure.draw_without_rendering()
    boxes = [Text.get_window_extent(text) for text in axes.texts]
    assert len(boxes) == 10
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert len(axes.get_xticks()) >= 4
    assert "what happens 3" in inline(lambda f: timeline(f, [Lane("A", crowd)], end), "strip", "a strip")


def test_events_stand_above_the_panel() -> None:
    """None over a curve or over another."""
    time = np.linspace(0.0, 30.0, 100)
    events = [(4.0, "A seizes"), (4.1, "B has no play left"), (29.0, "B seizes")]
    figure = sheet()
    line = Line("ring", "blue", time)
    _curves(figure, Chart("heat", "Temperatures", "rise [K]", time, [line], None, events))
    figure.draw_without_rendering()
    (axes,) = figure.axes
    boxes = [Text.get_window_extent(text) for text in axes.texts]
    assert [text.get_text() for text in axes.texts] == ["A seizes", "B has no\nplay left", "B seizes"]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert all(box.y0 > axes.get_window_extent().y1 for box in boxes)
