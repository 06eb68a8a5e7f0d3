"""The report as a browser shows it: nothing broken, nothing inaccessible, curves that zoom."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from touchdown.reports.contents import CHAPTERS
from touchdown.reports.page import print_page

pytestmark = pytest.mark.slow


@pytest.fixture
def opened(driver: Any, page: Path) -> Any:
    """The browser with the report open."""
    driver.get(page.as_uri())
    return driver


def test_every_section_is_shown_and_nothing_complains(opened: Any) -> None:
    for chapter in CHAPTERS:
        section = opened.find_element("id", chapter.name)
        assert section.size["height"] > 40
        assert section.text.strip()
    assert not [entry for entry in opened.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]


def test_curves_are_zoomed_all_together(opened: Any) -> None:
    spans = "return touchdown.curves.charts.map((c) => [c.plot.scales.x.min, c.plot.scales.x.max])"
    whole = opened.execute_script(spans)
    assert len(whole) >= 4
    assert len({tuple(span) for span in whole}) == 1
    opened.find_element("css selector", "#chart-force button[aria-label='Zoom in']").click()
    zoomed = opened.execute_script(spans)
    assert len({tuple(span) for span in zoomed}) == 1
    assert zoomed[0][1] - zoomed[0][0] == pytest.approx(0.5 * (whole[0][1] - whole[0][0]))
    opened.find_element("xpath", "//figure[@id='chart-run-up']//button[.='Whole run']").click()
    assert opened.execute_script(spans) == whole
    opened.find_element("xpath", "//figure[@id='chart-force']//button[.='First impact']").click()
    impact = opened.execute_script(spans)[0]
    assert impact[1] - impact[0] == pytest.approx(0.02)


def test_curves_are_drawn(opened: Any) -> None:
    ink = """
        const canvas = document.querySelector('#chart-force canvas');
        const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        return pixels.filter((v, i) => i % 4 === 3 && v > 0).length / (canvas.width * canvas.height);"""
    assert 0.002 < opened.execute_script(ink) < 0.5


def test_the_drop_moves(opened: Any) -> None:
    told = "return document.querySelector('.motion output').textContent"
    before = opened.execute_script(told)
    slider = opened.find_element("css selector", ".motion input[type=range]")
    slider.send_keys("\ue014" * 5)  # arrow to the right
    assert opened.execute_script(told) != before
    picture = "return document.querySelector('.motion canvas').toDataURL().length"
    assert opened.execute_script(picture) > 5_000


@pytest.mark.parametrize("dark", [False, True])
def test_no_accessibility_error(opened: Any, dark: bool) -> None:
    axe = Path(pytest.importorskip("axe_core_python").__file__).with_name("axe.min.js")
    if dark:
        opened.find_element("id", "theme").click()
    opened.execute_script(axe.read_text(encoding="utf-8"))
    found = opened.execute_async_script("axe.run().then(arguments[0])")
    assert not [(v["id"], [node["html"] for node in v["nodes"]]) for v in found["violations"]]
    assert len(found["passes"]) > 30


def test_it_is_printed(driver: Any, page: Path, tmp_path: Path) -> None:
    printed = print_page(page, tmp_path / "page.pdf").read_bytes()
    assert printed.startswith(b"%PDF")
    assert len(printed) > 50_000
