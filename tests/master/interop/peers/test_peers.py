"""The project's FMUs in other co-simulation tools: same drop, same numbers.

They come from PyPI, so these tests run only when asked for: pytest -m peers.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import product
from pathlib import Path

import pytest
from drops import FALLS, FREE, STEP, Error, Fall
from environments import INSTALLED, REQUIREMENTS, Found, UnavailableError, interpreter, run
from fmpy import simulate_fmu
from systems import AT, LEVITATED

from touchdown.master.scene.file import load_scene

pytestmark = pytest.mark.peers

HELD = [peer for peer in REQUIREMENTS if peer != "fmpy"]
LEAD = [(peer, fall, "jacobi-lead") for peer in HELD for fall in FALLS]
LEAD += [("fmpy", fall, "jacobi-lead") for fall in FREE]  # its first step has no loads
PLAIN = [("ecos", fall, "jacobi-interface") for fall in FALLS]
ORDERED = [("cofmupy", "disk", "interface")]
BEARINGS_FIRST = "amb,bearing;rotor,housing"
PEAK = {"fmpy": 4e-3}  # the first step leaves the rings unsupported, and rotor I's peaks are momentary
Key = tuple[str, str, str]  # peer, fall, scheme


@pytest.fixture(scope="session")
def falls() -> dict[str, Fall]:
    return {name: make() for name, make in (FALLS | FREE).items()}


@pytest.fixture(scope="session")
def ours(falls: dict[str, Fall]) -> dict[str, dict[str, float]]:
    """What is exact, and that something happened."""
    found = {name: fall.ours()[0] for name, fall in falls.items()}
    for name, fall in falls.items():
        for bearing in fall.bearings:
            assert found[name][f"{bearing}.contact.peak_force"] > 300.0
            assert found[name][f"{bearing}.contact.first_time"] > 5e-3
    return found


@pytest.fixture(scope="session")
def runs(falls: dict[str, Fall], tmp_path_factory: pytest.TempPathFactory) -> dict[Key, Future[Found]]:
    """All runs, two at a time."""
    folders = {fall: tmp_path_factory.mktemp("peers") for fall in falls}  # packages bear their scene's name
    keys = [*LEAD, *PLAIN, *ORDERED]
    packages = {
        (fall, scheme): falls[fall].package(scheme, folders[fall])
        for fall, scheme in dict.fromkeys((fall, scheme) for _, fall, scheme in keys)
    }
    with ThreadPoolExecutor(2) as pool:
        made = {"ssp": pool.submit(interpreter, "fmpy"), "cofmupy": pool.submit(interpreter, "cofmupy")}

        def one(key: Key) -> Found:
            peer, fall, scheme = key
            made[REQUIREMENTS[peer]].result()
            order = {"ORDER": BEARINGS_FIRST} if key in ORDERED else {}
            return run(peer, packages[fall, scheme], falls[fall].wanted, **order)

        return {key: pool.submit(one, key) for key in keys}


@pytest.fixture(scope="session")
def error(
    runs: dict[Key, Future[Found]], falls: dict[str, Fall], ours: dict[str, dict[str, float]]
) -> Callable[..., Error]:
    """Of a run; skips where its tool cannot be had."""

    def of(peer: str, fall: str, scheme: str) -> Error:
        try:
            found = runs[peer, fall, scheme].result()
        except UnavailableError as reason:
            pytest.skip(str(reason))
        return falls[fall].error(found.values, ours[fall])

    return of


@pytest.mark.parametrize(("peer", "fall", "scheme"), LEAD)
def test_a_tool_that_steps_all_fmus_in_parallel(
    peer: str, fall: str, scheme: str, error: Callable[..., Error]
) -> None:
    """With loads predicted one macro step ahead."""
    found = error(peer, fall, scheme)
    assert found.peak < PEAK.get(peer, 2e-3)
    assert found.journal < 0.05
    assert found.impact < 5.0


@pytest.mark.parametrize(("peer", "native"), [*product(HELD, (False, True)), *product(INSTALLED, (True,))])
def test_one_package_gives_the_same_numbers_everywhere(
    peer: str, native: bool, falls: dict[str, Fall], tmp_path: Path
) -> None:
    """As the project's own master, where it steps all FMUs in parallel, too; the package is not edited.

    A program has no Python in it, so it takes native FMUs.
    """
    fall = falls["disk"]
    package = fall.package("jacobi-lead", tmp_path, native)
    try:
        found = run(peer, package, fall.crossing).values
    except UnavailableError as reason:
        pytest.skip(str(reason))
    own, _ = fall.ours(scheme="jacobi-lead")
    assert found == pytest.approx({name: own[name] for name in fall.crossing}, rel=1e-9)


@pytest.mark.parametrize(("peer", "fall", "scheme"), PLAIN)
def test_without_the_prediction_it_errs_more(
    peer: str, fall: str, scheme: str, error: Callable[..., Error]
) -> None:
    plain, led = error(peer, fall, scheme), error(peer, fall, "jacobi-lead")
    assert plain.peak > 0.01
    assert plain.journal > 20.0 * led.journal


@pytest.mark.parametrize(("peer", "fall", "scheme"), ORDERED)
def test_a_tool_that_can_be_told_the_order(
    peer: str, fall: str, scheme: str, error: Callable[..., Error]
) -> None:
    """Bearings first, as the project's own master: the same numbers but for the clock's rounding."""
    found = error(peer, fall, scheme)
    assert found.peak < 1e-9
    assert found.journal < 1e-7


def test_a_loop_with_its_controller_and_events_is_the_same_in_libcosim(tmp_path: Path):
    """Off at 2 ms, down at 10.6 ms, asked for again at 14 ms; by the same scheme, sums in another order."""
    events = {"controller.event[1].time": 2e-3, "controller.event[2].time": 14e-3}
    scene = load_scene("disk-caged-relevitated").set({**events, "run.duration": 30e-3})
    loop = Fall(scene.set({"run.macro_step": 2e-5, "rotor.eccentricity": 5e-6}), ("rotor.A",), ("bearing",))
    expected, _ = loop.ours(scheme="jacobi-lead")
    assert expected["bearing.contact.peak_force"] > 300.0
    try:
        found = run("libcosim", loop.package("jacobi-lead", tmp_path), loop.wanted).values
    except UnavailableError as reason:
        pytest.skip(str(reason))
    for name in ("rotor.A.x", "rotor.A.y"):
        assert abs(found[name] - expected[name]) < 1e-12
    assert found["bearing.contact.peak_force"] == pytest.approx(
        expected["bearing.contact.peak_force"], rel=1e-9
    )


def test_a_package_becomes_one_fmu_by_fmucontainer(falls: dict[str, Fall], tmp_path: Path) -> None:
    """By the recipe of docs/systems.md; its native runtime gives the numbers of `jacobi-lead`."""
    fall = falls["disk"]
    package = fall.package("jacobi-lead", tmp_path)
    dump = package.with_name(f"{package.stem}-dump.json")

    def contain(*arguments: str) -> None:
        command = [Path(sys.executable).with_name("fmucontainer"), "-container", *arguments]
        subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)

    contain(f"{package.name}:{STEP}", "-dump-json")
    dump.write_text(dump.read_text().replace('"auto_local": false', '"auto_local": true'))
    contain(dump.name)
    names = {
        name: name.replace("rotor.", "rigid_rotor.").replace("bearing.", "simplified_caged.")
        for name in (*fall.wanted, *fall.crossing)
    }
    found = simulate_fmu(
        str(package.with_suffix(".fmu")),
        validate=False,  # locals are among its outputs
        stop_time=LEVITATED + AT,
        output_interval=20 * STEP,
        output=list(names.values()),
    )
    own, _ = fall.ours(scheme="jacobi-lead")
    assert own["bearing.contact.peak_force"] > 300.0
    assert {name: found[theirs][-1] for name, theirs in names.items()} == pytest.approx(
        {name: own[name] for name in names}, rel=1e-9
    )
