"""The report and the film of a rotor that is levitated again, or not."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import touchdown
from touchdown.master.quantities import summary_items
from touchdown.master.results.capture import captured_words
from touchdown.reports.chapters.levitation import levitation
from touchdown.reports.contents import CHAPTERS, section
from touchdown.reports.motion import motions
from touchdown.reports.numbers import head, quantity
from touchdown.reports.subject import Subject


@pytest.fixture(scope="module")
def caught(tmp_path_factory: pytest.TempPathFactory) -> touchdown.Result:
    """A disk that is asked for 40 ms after it was dropped."""
    changes = {"controller.event[2].time": "45 ms", "run.duration": "0.15 s"}
    scene = touchdown.load("disk-caged-relevitated").set(changes)
    return touchdown.run(scene, tmp_path_factory.mktemp("caught") / "run", in_process=True)


def plain(text: str) -> str:
    """With plain spaces."""
    return text.replace("\N{NO-BREAK SPACE}", " ")


def said(result: touchdown.Result) -> str:
    """The chapter on it."""
    chapter = next(c for c in CHAPTERS if c.name == "levitation")
    return section(chapter, Subject(result)).html


def test_the_chapter_says_what_became_of_rotor_controller_and_coils(caught: touchdown.Result) -> None:
    subject = Subject(caught)
    told = levitation(subject)
    (row,) = told["fates"]
    after = quantity(caught.summary["seats"]["A"]["capture_time"], "s", 3)
    assert row[:3] == ["A", "captured", after]
    (row,) = told["controllers"]
    assert [plain(cell) for cell in row[:2]] == ["controller", "40 ms"]
    assert row[3] == "0"
    (row,) = told["limits"]
    assert plain(row[1]) == f"{caught.summary['largest_coil_current']:.3g} A"
    assert row[0] == "amb"
    page = said(caught)
    for caption in (
        "Captured or lost; times count from the command",
        "What controllers say, after the shutdown",
        "Limits that were reached",
    ):
        assert f"<caption>{caption}</caption>" in page
    charts = [told["states"].chart, *(coil["curves"].chart for coil in told["coils"])]
    assert re.findall('<figure class="series" id="chart-(.*)">', page) == [chart.name for chart in charts]
    assert [chart.name for chart in charts] == ["controllers", "current-amb", "voltage-amb"]
    assert [len(chart.lines) for chart in charts] == [1, 4, 4]
    assert {0.0, 1.0, 2.0} >= set(charts[0].lines[0].values.tolist())
    model = section(next(c for c in CHAPTERS if c.name == "model"), subject).html
    assert "Forces of the process and the motor, but for" in model
    when = f"{caught.summary['seats']['A']['capture_time']:.3g} s after the command"
    assert caught.headline.startswith(f"Asked for again, the rotor is captured at A, {when}. ")


def test_what_is_lost_is_said_with_its_reason(caught: touchdown.Result) -> None:
    lost = {"capture": "lost: not lifted", "capture_time": None}
    seats = {"A": {**caught.summary["seats"]["A"], **lost}}
    subject = Subject(replace(caught, summary={**caught.summary, "seats": seats}))
    assert captured_words(subject.summary) == "Asked for again, the rotor is lost at A (not lifted)."
    page = said(replace(caught, summary={"scene": "x"}))
    assert "<p>No controller was asked to levitate the rotor again.</p>" in page
    assert 'class="remark' not in page
    keys = ("capture", "capture_time", "capture_command_time")
    assert [head(item) for item in summary_items(caught.summary) if item.quantity.key in keys] == [
        *("Captured or lost, A", "Captured, after the command, A [s]"),
        "Asked for again, after the shutdown [s]",
    ]


def test_the_film_says_when_it_is_asked_for_and_captured(caught: touchdown.Result) -> None:
    ((motion,), _) = motions(Subject(caught))
    after = caught.summary["seats"]["A"]["capture_time"]
    assert [since for since, _ in motion.stages] == pytest.approx([0.04, 0.04 + after])
    words = [motion.stage(frame) for frame in range(len(motion.time))]
    assert list(dict.fromkeys(words)) == ["", "to be levitated", "captured"]
    first = words.index("captured")
    assert motion.time[first - 1] < 0.04 + after <= motion.time[first]


def test_scenes_without_a_controller_have_no_such_chapter(dropped: Path) -> None:
    subject = Subject(touchdown.open_result(dropped))
    chapter = next(c for c in CHAPTERS if c.name == "levitation")
    assert "no magnetic bearing of this scene has a controller" in section(chapter, subject).lacking
    assert captured_words(subject.summary) == ""
