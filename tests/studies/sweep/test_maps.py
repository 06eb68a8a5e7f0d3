"""Maps: what each place stands for, and that each kind of picture is drawn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.capture import Fate, fate
from touchdown.master.results.whirl.verdict import WhirlKind, clopper_pearson
from touchdown.master.scene.file import load_scene
from touchdown.studies.sweep.definition import Definition, define
from touchdown.studies.sweep.design import Design
from touchdown.studies.sweep.maps import MapPlot
from touchdown.studies.sweep.members import Member
from touchdown.studies.sweep.parts import CAPTURE, WHIRL
from touchdown.studies.sweep.places import field
from touchdown.studies.sweep.report import capture_lines, verdict_lines

SPEEDS = {"rotor.speed": ["6000 rpm", "9000 rpm", "12000 rpm"]}
CLEARANCES = {"bearing_*.clearance": ["0.2 mm", "0.3 mm"]}
PHASES = {"rotor.unbalance_angle": ["0 deg", "90 deg", "180 deg", "270 deg"]}


def pretended(variations: dict[str, list[str]] | Design) -> tuple[Definition, list[Member]]:
    """Drops that whirl to the end from 12000 rpm on, at half of the phases; one has failed."""
    design = variations if isinstance(variations, Design) else Design.grid(variations)
    asked = define(load_scene("rotor1-9000"), design, in_process=True)
    members = []
    for number, settings in asked.by_number.items():
        fast = float(str(settings.get("rotor.speed", "0 rpm")).split()[0]) >= 12e3
        whirls = fast and settings.get("rotor.unbalance_angle", "0 deg") in ("0 deg", "90 deg")
        first = {
            "whirl": "backward whirl, at 0.5 s still whirling, steady" if whirls else "pendulum",
            "whirl_revolutions": 20.0 if whirls else 0.0,
            "whirl_trend": "steady" if whirls else None,
            "peak_contact_force": 100.0 * number,
        }
        summary = {"seats": {"A": first, "B": {"peak_contact_force": 1.0}}}
        members.append(Member(number, settings, summary, failed="it broke" if number == 1 else ""))
    return asked, members


def test_a_place_stands_for_all_phases() -> None:
    asked, members = pretended({**SPEEDS, **CLEARANCES, **PHASES})
    found = field(asked, members)
    assert found.labels == ("rotor.speed [rpm]", "bearing_*.clearance [mm]")
    assert found.together == "4 values of rotor.unbalance_angle"
    assert found.is_grid
    assert [len(there) for there in found.spots.values()] == [3, 4, 4, 4, 4, 4]
    assert field(asked, members, ["rotor.unbalance_angle"]).along(0) == [0.0, 90.0, 180.0, 270.0]
    with pytest.raises(TouchdownError, match=r"rotor\.mass: it does not vary; "):
        field(asked, members, ["rotor.mass"])
    with pytest.raises(TouchdownError, match="it has two axes"):
        field(asked, members, [*SPEEDS, *CLEARANCES, *PHASES])


def test_cells_are_filled_by_the_parts_of_their_verdicts() -> None:
    """Half of the phases whirl at 12000 rpm: half of the width, and 7 to 93 % by Clopper and Pearson."""
    axes = MapPlot(*pretended({**SPEEDS, **CLEARANCES, **PHASES})).whirl(Figure().add_subplot())
    whirl, settles = (
        [p for p in axes.patches if _colour(p) == WHIRL.looks[kind].colour and _width(p) > 0.0]
        for kind in (WhirlKind.SUSTAINED, WhirlKind.SETTLES)
    )
    assert len(whirl) == 2
    assert len(settles) == 6
    assert {round(_width(p) / _width(settles[0]), 6) for p in whirl} == {0.5}
    assert [text.get_text() for text in axes.texts].count("50 %\n7–93 %") == 2
    assert clopper_pearson(2, 4).low == pytest.approx(0.0676, abs=1e-4)  # of tables of the binomial
    axes = MapPlot(*pretended({**SPEEDS, **CLEARANCES, **PHASES})).force(Figure().add_subplot())
    shown = np.asarray(axes.images[0].get_array())  # the largest of a place
    np.testing.assert_allclose(shown, [[400.0, 1200.0, 2000.0], [800.0, 1600.0, 2400.0]])


def asked_for(members: list[Member], second: str = "") -> list[Member]:
    """The same drops, whose rotors are lost where they whirl; `second`: what is said of a second seat."""
    told = []
    for m in members:
        first = m.summary["seats"]["A"]
        lost = first["whirl_revolutions"] != 0.0
        seats = {"A": {**first, **captured("lost: whirl" if lost else "captured", None if lost else 0.02)}}
        seats |= {"B": captured(second)} if second else {}
        told.append(Member(m.number, m.settings, {"seats": seats}, m.failed))
    return told


def captured(words: str, after: float | None = None) -> dict[str, object]:
    """The verdict at a seat."""
    return {
        "capture": words,
        "capture_time": after,
        "capture_last_contact": None,
        "capture_peak_force": 0.0,
    }


def test_captured_parts_of_a_place_have_their_interval() -> None:
    """Of four phases at 12000 rpm two are captured, of others all; the failed drop is not counted."""
    asked, members = pretended({**SPEEDS, **CLEARANCES, **PHASES})
    members = asked_for(members)
    axes = MapPlot(asked, members).capture(Figure().add_subplot())
    told = [text.get_text() for text in axes.texts]
    assert sorted(told) == ["100 %\n29–100 %", *["100 %\n40–100 %"] * 3, *["50 %\n7–93 %"] * 2]
    lost = [p for p in axes.patches if _colour(p) == CAPTURE.looks[Fate.LOST].colour and _width(p) > 0.0]
    assert len(lost) == 2
    assert capture_lines(members) == ["  captured: 19 of 23 (82.6 %; 61.2 % to 95 % with 95% confidence)"]
    words = verdict_lines(members)
    assert [line.split(":")[0] for line in words] == ["  whirl, A", "  captured or lost, A"]
    assert words[1] == "  captured or lost, A: 20 x captured, 4 x lost: whirl"
    # the worst seat counts, and what is undecided is not captured
    asked, members = pretended(SPEEDS)
    told = asked_for(members, "undecided: the run ends too early")
    assert [fate(m.summary) for m in told] == [Fate.UNDECIDED, Fate.UNDECIDED, Fate.LOST]
    assert "0 of 2 (" in capture_lines(told)[0]
    assert "1 undecided, which count as not captured" in capture_lines(told)[0]
    assert fate(members[0].summary) is None
    assert capture_lines(members) == []
    with pytest.raises(TouchdownError, match="no rotor was asked for again"):
        MapPlot(asked, members).capture(Figure().add_subplot())


def _colour(patch: object) -> str:
    assert isinstance(patch, Rectangle)
    return "#" + "".join(f"{round(255 * part):02x}" for part in patch.get_facecolor()[:3])


def _width(patch: object) -> float:
    assert isinstance(patch, Rectangle)
    return patch.get_width()


@pytest.mark.parametrize(
    "variations",
    [
        {**SPEEDS, **CLEARANCES},  # a drop per cell
        {**SPEEDS, **PHASES},  # one setting: parts as lines
        SPEEDS,  # one drop per value
        PHASES,  # nothing but phases
        {"run.scheme": ["hold", "interface"], **SPEEDS},  # words
        Design.sobol({"rotor.speed": "6000:12000 rpm", "bearing_*.clearance": "0.2:0.3 mm"}, 8),
    ],
    ids=["grid", "lines", "marks", "phases", "words", "sample"],
)
def test_every_kind_of_sweep_has_maps(variations: dict[str, list[str]] | Design, tmp_path: Path) -> None:
    """No stress: no drop has one. Drops that all failed have none."""
    asked, members = pretended(variations)
    broken = MapPlot(asked, [Member(m.number, m.settings, {}, "it broke") for m in members])
    assert broken.save(tmp_path) == []
    with pytest.raises(TouchdownError, match="no drop has a whirl verdict"):
        broken.whirl(Figure().add_subplot())
    drawn = MapPlot(asked, members).save(tmp_path)
    assert [path.name for path in drawn] == ["whirl-map.png", "force-map.png"]
    assert all(path.stat().st_size > 10_000 for path in drawn)


def test_over_one_setting_all_marks_lie_inside_and_all_that_is_drawn_is_named() -> None:
    """Also where no drop whirls, whose interval is wide; the largest force is below the frame."""
    asked, members = pretended({**SPEEDS, **PHASES})
    still = []
    for m in members:
        first = {**m.summary["seats"]["A"], "whirl": "pendulum", "whirl_revolutions": 0.0}
        still.append(Member(m.number, m.settings, {"seats": {"A": first}}))
    axes = MapPlot(asked, still).whirl(Figure().add_subplot())
    low, high = axes.get_ylim()
    assert low < 0.0
    assert high > 100.0
    assert not [filled for filled in axes.collections if isinstance(filled, PolyCollection)]
    _, labels = axes.get_legend_handles_labels()
    assert all("95 % interval as a bar" in label for label in labels)
    forces = MapPlot(asked, still).force(Figure().add_subplot())
    assert forces.get_ylim()[1] > 1.05 * 100.0 * len(members)
