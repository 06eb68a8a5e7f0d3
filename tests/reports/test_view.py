"""The viewer: one page of a whole run, as data and as a browser plays it."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import Command

import touchdown
from touchdown.reports.layout import rendered
from touchdown.reports.page import Page
from touchdown.reports.subject import Subject
from touchdown.reports.view import FRAMES, _frames, view_of

MEGABYTE = 1e6


class Tiled:
    """A recording that goes on as it began: its rows from the shutdown on, again and again."""

    def __init__(self, recording: Any, length: float) -> None:
        self._recording, time = recording, recording.time
        self._later = np.flatnonzero(time > 0.0)
        step = time[-1] - time[-2]
        self._times = int(length / (step * len(self._later)))
        self.time = time[0] + step * np.arange(len(time) + (self._times - 1) * len(self._later))

    def __contains__(self, name: str) -> bool:
        return name in self._recording

    def __getitem__(self, name: str) -> np.ndarray:
        found = self._recording[name]
        return np.concatenate([found, *[found[self._later]] * (self._times - 1)])


@pytest.fixture(scope="module")
def long(dropped: Path) -> touchdown.Result:
    """A drop of 5 s, made up of a short one."""
    result = touchdown.open_result(dropped)
    return replace(result, recording=Tiled(result.recording, 5.0))


def html_of(page: Page) -> str:
    """A page as written."""
    return rendered(page.template, {"page": page})


def unpacked(text: str, kind: str = "<f4") -> np.ndarray:
    """Numbers of a page."""
    return np.frombuffer(base64.b64decode(text), kind)


def told(page: Page) -> dict[str, Any]:
    """What the script that draws is told."""
    return json.loads(page.data["moving"]["data"])


def test_the_command_writes_one_page_that_asks_for_nothing(
    command: Command, dropped: Path, tmp_path: Path
) -> None:
    assert command("view", dropped).status == 0
    text = (dropped / "view.html").read_text(encoding="utf-8")
    outside = re.findall(
        r"""(?:src|href)\s*=\s*["'](?!#|data:)|@import|url\(\s*["']?http|fetch\(|XMLHttp""", text
    )
    assert not outside
    assert text.count("<html") == 1
    data = json.loads(re.findall(r'<script type="application/json">(.*?)</script>', text, re.DOTALL)[0])
    assert len(unpacked(data["time"], "<f8")) > 100
    assert "is a folder" in command("view", dropped, "-o", tmp_path).line
    assert "ends in .html" in command("view", dropped, "-o", tmp_path / "drop.pdf").line
    assert "no summary.json" in command("view", tmp_path).line


def test_the_page_has_what_was_recorded(dropped: Path) -> None:
    result = touchdown.open_result(dropped)
    page, recording = view_of(result), result.recording
    data = told(page)
    time, (seat,) = unpacked(data["time"], "<f8"), data["seats"]
    assert list(time) == list(recording.time)  # a short run is not thinned
    place = unpacked(seat["journal"]).reshape(-1, 3)
    y = recording["rotor.A.y"] - recording["housing.seat.y"]
    assert seat["bore"] == pytest.approx(1.16)
    assert place[:, 1] * 0.25e-3 / 0.16 == pytest.approx(y, abs=1e-10)
    force = unpacked(seat["force"]).reshape(-1, 2) * seat["largest"]
    assert force[:, 1] == pytest.approx(recording["bearing.journal.fy"], abs=1e-3)
    assert unpacked(seat["rpm"]).reshape(-1, 2)[0, 0] == pytest.approx(9000.0)
    assert [chart.name for chart in page.data["charts"]] == ["force", "displacement", "speeds"]


def test_a_long_run_keeps_its_peaks_in_few_frames(long: touchdown.Result) -> None:
    """No force is lost, impacts keep all of their rows, calm does not, and the page stays small."""
    subject, recording = Subject(long), long.recording
    rows = _frames(subject)
    assert len(rows) < FRAMES + 6_000 < len(recording.time)
    page = view_of(long)
    (seat,) = told(page)["seats"]
    force = np.hypot(*(recording[f"bearing.journal.f{axis}"] for axis in "xy"))
    drawn = np.hypot(*unpacked(seat["force"]).reshape(-1, 2).T) * seat["largest"]
    assert drawn.max() == pytest.approx(force.max(), rel=1e-6)
    hard = np.flatnonzero(force > 0.5 * force.max())
    assert len(hard) > 100
    assert np.isin(hard, rows).mean() > 0.9
    assert np.isin(np.flatnonzero(force == 0.0), rows).mean() < 0.7
    heights = {
        chart.name: max(np.nanmax(line.values) for line in chart.lines) for chart in page.data["charts"]
    }
    assert heights["force"] >= recording["bearing.contact.force"].max()
    assert len(html_of(page).encode()) < 10 * MEGABYTE


def test_pace_and_moments(dropped: Path) -> None:
    result = touchdown.open_result(dropped)
    page, first = view_of(result), result.summary["seats"]["A"]["first_contact_time"]
    data = told(page)
    factors, ends = zip(*data["pace"], strict=True)
    assert max(factors) == factors[2] == 850.0
    assert ends[1] < first < ends[2]
    assert list(ends) == sorted(ends)
    assert (first, "A: first contact", False) in page.data["moments"]


def test_states_of_a_seat_are_moments_and_stages(dropped: Path) -> None:
    """As the summary has them; a whirl that ends is over."""
    result = touchdown.open_result(dropped)
    whirl = {"direction": "backward", "start": 0.012, "end": 0.02, "goes_on": False}
    whirl |= {"revolutions": 3.0, "frequency": 400.0}
    states = {"ring_sync_time": 0.03, "seized_time": 0.04, "settling_time": None, "whirl_episodes": [whirl]}
    seats = {"A": result.summary["seats"]["A"] | states}
    gaps = {"seal": {"least": -1e-6, "least_time": 0.05, "closed_time": 0.045}}
    page = view_of(replace(result, summary=result.summary | {"seats": seats, "gaps": gaps}))
    (seat,) = told(page)["seats"]
    assert [words for _, words in seat["stages"]] == [
        *("backward whirl", "whirl over", "ring as fast as the rotor", "ring seizes"),
    ]
    assert [time for time, _ in seat["stages"]] == [0.012, 0.02, 0.03, 0.04]
    late = [moment for moment in page.data["moments"] if moment[0] >= 0.04]
    assert late[:2] == [(0.04, "A: ring seizes", True), (0.045, "gaps: seal closed", True)]


def test_a_run_without_contact_is_shown_too(tmp_path: Path) -> None:
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "4 ms"})
    result = touchdown.run(scene, in_process=True)
    assert touchdown.view(result, tmp_path / "calm.html").stat().st_size > 50_000
    moments = [words.partition(" 9000")[0] for _, words, _ in view_of(result).data["moments"]]
    assert moments == ["rotor: shutdown", "rotor: end"]


def test_what_cannot_be_shown_is_one_line(command: Command, tmp_path: Path) -> None:
    arguments = ("--duration", "8 ms", "--set", "run.record=bearing", "--no-pictures", "--in-process")
    assert command("run", "disk-caged-simplified", *arguments, "-o", tmp_path / "few").status == 0
    assert "there is no drop to show: " in command("view", tmp_path / "few").line


# -- in a browser -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def seen(driver: Any, dropped: Path) -> Iterator[Any]:
    """The browser with the viewer open, in a window of 1280 x 1000."""
    driver.get(touchdown.view(dropped, dropped / "seen.html").as_uri())
    yield driver
    driver.set_window_size(1280, 1000)


HOME, END, LEFT, UP, RIGHT, DOWN = "\ue011", "\ue010", "\ue012", "\ue013", "\ue014", "\ue015"


def keys(seen: Any, pressed: str = "") -> tuple[str, int]:
    """The clock and the frame after keys."""
    seen.find_element("tag name", "body").send_keys(pressed)
    slider, output = (seen.find_element("css selector", f".player {tag}") for tag in ("input", "output"))
    return output.text, int(slider.get_property("value"))


def cursor(seen: Any) -> list[float]:
    """The moments (s) at which the cursors of the curves are."""
    of_each = "({ plot }) => plot.posToVal(plot.cursor.left, 'x')"
    return seen.execute_script(f"return touchdown.curves.charts.map({of_each})")


@pytest.mark.slow
def test_keys_go_from_frame_to_frame(seen: Any, dropped: Path) -> None:
    time = touchdown.open_result(dropped).recording.time
    assert keys(seen, HOME) == (f"{1e3 * time[0]:.2f} ms after the shutdown, 100 times slower", 0)
    assert keys(seen, RIGHT + RIGHT)[1] == 2
    assert keys(seen, LEFT)[1] == 1
    assert keys(seen, END) == (
        f"{1e3 * time[-1]:.2f} ms after the shutdown, 18 times slower",
        len(time) - 1,
    )
    assert keys(seen, DOWN)[0].endswith("1000 times slower")
    assert keys(seen, UP)[0].endswith("18 times slower")


@pytest.mark.slow
def test_curves_and_picture_show_one_moment(seen: Any, dropped: Path) -> None:
    """By keys, by a click in a curve, by dragging there, and by the slider."""
    from selenium.webdriver import ActionChains

    time = touchdown.open_result(dropped).recording.time
    keys(seen, HOME)
    assert cursor(seen) == pytest.approx([time[0]] * 3, abs=1e-4)
    over = seen.find_element("css selector", "#chart-displacement .u-over")
    spans = "return touchdown.curves.charts.map(({ plot }) => [plot.scales.x.min, plot.scales.x.max])"
    whole = seen.execute_script(spans)
    ActionChains(seen).move_to_element(over).click().perform()
    middle = 0.5 * (time[0] + time[-1])
    assert cursor(seen) == pytest.approx([middle] * 3, abs=2e-4)
    _, frame = keys(seen)
    assert time[frame] == pytest.approx(middle, abs=2e-4)
    picture = "return document.querySelector('.seats canvas').toDataURL()"
    before = seen.execute_script(picture)
    ActionChains(seen).move_to_element(over).click_and_hold().move_by_offset(-100, 0).release().perform()
    assert cursor(seen)[0] < middle - 0.005
    assert seen.execute_script(picture) != before
    assert seen.execute_script(spans) == whole  # a drag here is no zoom
    slider = seen.find_element("css selector", ".player input")
    seen.execute_script("arguments[0].value = 7; arguments[0].dispatchEvent(new Event('input'))", slider)
    assert cursor(seen) == pytest.approx([time[7]] * 3, abs=1e-5)
    read = seen.find_element("css selector", "#chart-speeds .u-legend .u-series:nth-child(2) .u-value")
    assert read.text == "9000"


@pytest.mark.slow
def test_curves_are_zoomed_about_the_moment_and_follow_it(seen: Any) -> None:
    span = "return touchdown.curves.span()"
    keys(seen, HOME)
    whole = seen.execute_script(span)
    keys(seen, "++")
    near = seen.execute_script(span)
    assert near == pytest.approx([whole[0], whole[0] + 0.25 * (whole[1] - whole[0])])
    keys(seen, END)
    later = seen.execute_script(span)
    assert later[0] > near[1]
    assert later[1] == pytest.approx(whole[1])
    keys(seen, "--")
    seen.find_element("xpath", "//button[.='Whole run']").click()
    assert seen.execute_script(span) == whole
    seen.find_element("xpath", "//button[.='A: first contact']").click()
    assert seen.find_element("css selector", ".moments [aria-current=true]").text == "A: first contact"


@pytest.mark.slow
def test_it_plays_by_the_clock_of_the_screen(seen: Any) -> None:
    """Slower through the impact; the page's own clock is wound by the test."""
    keys(seen, HOME)
    wound = """
        const [pace] = arguments, at = [], kept = window.requestAnimationFrame;
        const select = document.querySelector("select"), output = document.querySelector("output");
        select.value = pace;
        let next = null, now = performance.now();
        window.requestAnimationFrame = (call) => { next = call; };
        const play = document.querySelector(".player button");
        play.click();
        for (let k = 0; k < 50; k += 1) { now += 20; next(now); at.push(parseFloat(output.textContent)); }
        play.click();
        window.requestAnimationFrame = kept;
        select.value = "";
        return [at[9], at[49], play.textContent];"""
    early, late, button = seen.execute_script(wound, "100")
    assert button == "Play"
    keys(seen, " ")
    assert seen.find_element("css selector", ".player button").text == "Pause"
    keys(seen, " ")
    assert late - early == pytest.approx(40 * 20 / 100, abs=0.011)  # ms
    seen.find_element("xpath", "//button[.='A: first contact']").click()
    early, late, _ = seen.execute_script(wound, "")
    assert late - early == pytest.approx(40 * 20 / 850, abs=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_overflows_complains_or_is_asked_for(seen: Any, width: int) -> None:
    seen.set_window_size(width, 800)
    root = seen.find_element("tag name", "html")
    assert root.get_property("scrollWidth") <= root.get_property("clientWidth") <= width
    assert not seen.get_log("browser")
    asked = "return performance.getEntriesByType('resource').map((entry) => entry.name)"
    assert seen.execute_script(asked) == []


@pytest.mark.slow
@pytest.mark.parametrize("dark", [False, True])
def test_no_accessibility_error(seen: Any, dark: bool) -> None:
    axe = Path(pytest.importorskip("axe_core_python").__file__).with_name("axe.min.js")
    if dark:
        seen.find_element("id", "theme").click()
    seen.execute_script(axe.read_text(encoding="utf-8"))
    found = seen.execute_async_script("axe.run().then(arguments[0])")
    assert not [(v["id"], [node["html"] for node in v["nodes"]]) for v in found["violations"]]
