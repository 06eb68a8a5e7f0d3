"""A short drop and its report, made once; a browser that looks at it, where there is one."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

import touchdown
from touchdown.reports.page import BROWSER_FLAGS, BROWSERS, alone


@pytest.fixture(scope="session")
def dropped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run."""
    folder = tmp_path_factory.mktemp("dropped") / "run"
    scene = touchdown.load("disk-caged-simplified")
    changes = {"run.duration": "60 ms", "bearing.clearance": "0.25 mm", "rotor.eccentricity": "5 um"}
    touchdown.run(scene.set(changes), folder, in_process=True)
    return folder


@pytest.fixture(scope="session")
def page(dropped: Path) -> Path:
    """Its report."""
    return touchdown.report(dropped)[0]


@pytest.fixture(scope="session")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[object]:
    """A headless Chromium; tests that need it are skipped where there is none."""
    webdriver = pytest.importorskip("selenium.webdriver")
    chromium = next(filter(None, map(shutil.which, BROWSERS)), None)
    chromedriver = shutil.which("chromedriver")
    if chromium is None or chromedriver is None:
        pytest.skip("no Chromium with its chromedriver on the PATH")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    profile = tmp_path_factory.mktemp("profile")
    for argument in (*BROWSER_FLAGS, *alone(), f"--user-data-dir={profile}", "--window-size=1280,1000"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(chromedriver))
    yield browser
    browser.quit()
