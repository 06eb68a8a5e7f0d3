"""The public API: where files go, what it takes, what it says of mistakes."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hosting import COMPILER

import touchdown
from touchdown.master import quantities
from touchdown.master.coupling import steppers
from touchdown.master.coupling.steppers.carried import carrying
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel
from touchdown.master.scene import schemes
from touchdown.studies import comparison
from touchdown.studies.comparison.engine import Options
from touchdown.studies.loop import over_speed
from touchdown.studies.machine import rank as ranking

SCENE = touchdown.load("disk-caged-simplified").set({"run.duration": "1 ms"})


@pytest.fixture
def registries(monkeypatch: pytest.MonkeyPatch) -> None:
    """Schemes registered in a test go with it."""
    schemes_now, sequences_now = dict(schemes._schemes), dict(steppers._sequences)
    monkeypatch.setattr(schemes, "_schemes", schemes_now)
    monkeypatch.setattr(schemes, "SCHEMES", schemes_now)
    monkeypatch.setattr(steppers, "_sequences", sequences_now)
    monkeypatch.setattr(steppers, "SEQUENCES", sequences_now)
    monkeypatch.setattr(quantities, "_declared", dict(quantities._declared))


def test_importing_it_imports_nothing_heavy() -> None:
    script = (
        "import sys, touchdown\n"
        "print([m for m in ('numpy', 'numba', 'matplotlib', 'xarray', 'h5py') if m in sys.modules])"
    )
    made = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert made.stdout.strip() == "[]"


def test_without_a_folder_nothing_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    result = touchdown.run(SCENE, in_process=True, pictures=True)
    assert result.data["rotor.A.y"].size > 1
    result.plot.orbit()
    assert result.folder.parent == tmp_path
    del result
    touchdown.sweep(SCENE, {"rotor.speed": ["9000 rpm"]}, in_process=True, jobs=1)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", [str, Path])
def test_a_folder_is_text_or_a_path(kind: Callable[[Path], str | Path], tmp_path: Path) -> None:
    result = touchdown.run(SCENE, kind(tmp_path / "run"), in_process=True)
    assert result.folder == tmp_path / "run"
    files = {"ending.json", "result.h5", "scene.json", "state.npz", "summary.json"}
    assert {path.name for path in result.folder.iterdir()} == files


@pytest.mark.parametrize("kind", [str, Path])
def test_a_scene_is_a_name_a_path_or_itself(kind: Callable[[Path], str | Path], tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('extends = "disk-caged-simplified"\n[run]\nduration = 1e-3\n', encoding="utf-8")
    assert touchdown.load(kind(path)).run.duration == 1e-3
    assert touchdown.run(kind(path), in_process=True).summary["scene"] == "mine"
    assert set(touchdown.scenes()) >= {"rotor1-9000", "disk-caged-simplified"}


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: touchdown.load("nothing"), "unknown scene nothing; "),
        (lambda: SCENE.swap(bering="bushing"), "has no component bering; did you mean bearing"),
        (lambda: SCENE.set({"run.scheme": TWICE}), "twice is not registered; give it to register_scheme"),
        (lambda: touchdown.sweep(SCENE, {}), "nothing varies"),
        (lambda: touchdown.run(SCENE, native=True, in_process=True), "choose one"),
        (lambda: touchdown.check("bushin"), "did you mean bushing"),
        (lambda: touchdown.Rotor.load("rotor_III"), "did you mean rotor_II or rotor_I"),
    ],
)
def test_a_mistake_is_a_touchdown_error_of_one_line(call: Callable[[], object], says: str) -> None:
    with pytest.raises(touchdown.TouchdownError, match=says) as caught:
        call()
    assert "\n" not in str(caught.value)
    with pytest.raises(AttributeError, match="module 'touchdown' has no attribute 'ran'"):
        touchdown.ran  # noqa: B018 - asked for, to see what happens


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler (cc, gcc)")
@pytest.mark.native
def test_native_fmus_are_one_word_away() -> None:
    """With the same recording; what the scene says of them is kept with the results."""
    scene = SCENE.set({"run.duration": "1 ms"})
    native = touchdown.run(scene, native=True)
    assert all(component.native for component in native.scene.components.values())
    alone = touchdown.run(scene, in_process=True)
    assert np.array_equal(native.recording["rotor.A.y"], alone.recording["rotor.A.y"])


class Twice(GaussSeidel):
    """Takes each macro step in two, and tells how many it took."""

    quantities = (touchdown.Quantity.of_scheme("halves", "halves of macro steps"),)
    count = 0

    @property
    def figures(self) -> dict[str, float]:
        return {"halves": self.count}

    def step(self, number: int, time: float, step: float) -> None:
        for half in (0, 1):
            self.count += 1
            super().step(2 * number + half, time + 0.5 * half * step, 0.5 * step)


TWICE = touchdown.Scheme(
    name="twice", title="interface, every step in two", order=3, slopes=True, modes=True,
    error_order=3, angle_limit=1.0, sequence="twice",
)  # fmt: skip


@pytest.mark.usefixtures("registries")
def test_a_scheme_of_one_s_own_runs_a_scene() -> None:
    touchdown.register_scheme(TWICE, Twice)
    scene = SCENE.set({"run.duration": "10 ms", "run.scheme": "twice", "run.macro_step": "40 us"})
    result = touchdown.run(scene, in_process=True)
    assert result.summary["scheme"] == result.data.attrs["scheme"] == "twice"
    half = touchdown.run(scene.set({"run.scheme": "interface", "run.macro_step": "20 us"}), in_process=True)
    assert result.summary["halves"] == 2 * result.summary["macro_steps"]
    assert "halves of macro steps" in repr(result)
    assert result.flat["seats.A.first_contact_time"] is not None
    for path in ("seats.A.first_contact_time", "seats.A.peak_contact_force"):
        assert result.flat[path] == pytest.approx(half.flat[path], rel=1e-9)


@pytest.mark.usefixtures("registries")
def test_other_processes_know_what_a_scheme_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    touchdown.register_scheme(TWICE, Twice)
    carried = carrying(quantities.named)
    monkeypatch.setattr(quantities, "_declared", {})  # as another process begins
    assert [one.key for one in carried("halves")] == ["halves"]


@pytest.mark.usefixtures("registries")
def test_what_a_scheme_tells_is_declared_before_it_runs() -> None:
    silent = type("Silent", (Twice,), {"__module__": Twice.__module__, "quantities": ()})
    touchdown.register_scheme(replace(TWICE, name="silent", sequence="silent"), silent)
    with pytest.raises(touchdown.TouchdownError, match="figures has halves, which is not declared; add it"):
        touchdown.run(SCENE.set({"run.duration": "1 ms", "run.scheme": "silent"}), in_process=True)


@pytest.mark.usefixtures("registries")
@pytest.mark.parametrize(
    ("changed", "stepper", "says"),
    [
        ({"name": "interface"}, Twice, "there is a scheme interface already"),
        ({"sequence": "jacobi"}, Twice, "there is a sequence jacobi already"),
        ({"sequence": "jacoby"}, None, "there is no sequence jacoby; did you mean jacobi"),
        ({}, 5, "5 is not a subclass of Stepper"),
        ({"order": 7}, Twice, "order = 7 must be one of"),
        ({"angle_limit": 0.0}, Twice, "angle_limit = 0.0 must be above 0"),
    ],
)
def test_a_scheme_that_cannot_be_is_refused_whole(
    changed: dict[str, object], stepper: type[touchdown.Stepper] | None, says: str
) -> None:
    before = set(schemes.SCHEMES), set(steppers.SEQUENCES)
    with pytest.raises(touchdown.TouchdownError, match=says):
        touchdown.register_scheme(replace(TWICE, **changed), stepper)
    assert (set(schemes.SCHEMES), set(steppers.SEQUENCES)) == before


@pytest.mark.usefixtures("registries")
def test_a_scheme_may_be_registered_again_as_a_notebook_s_cell_does() -> None:
    touchdown.register_scheme(TWICE, Twice)
    again = type("Twice", (GaussSeidel,), {"__module__": Twice.__module__})
    touchdown.register_scheme(TWICE, again)
    assert steppers.SEQUENCES["twice"] is again
    with pytest.raises(touchdown.TouchdownError, match="there is a sequence twice already"):
        touchdown.register_scheme(TWICE, type("Other", (GaussSeidel,), {}))
    with pytest.raises(touchdown.TouchdownError, match="there is a scheme twice already"):
        touchdown.register_scheme(replace(TWICE, angle_limit=0.5), Twice)


@pytest.mark.slow
@pytest.mark.usefixtures("registries")
def test_processes_cannot_have_a_stepper_of_a_function() -> None:
    class Inner(GaussSeidel):
        """Of this test."""

    touchdown.register_scheme(TWICE, Inner)
    members = touchdown.sweep(SCENE, {"run.scheme": ["twice", "hold"]}, in_process=True)
    assert "put its stepper at the top of a module" in members[0].failed
    assert not members[1].failed


OWN_SCHEME = """
import sys
import touchdown
from touchdown.master.coupling.steppers.gauss_seidel import GaussSeidel

class Mine(GaussSeidel):
    pass

if __name__ == "__main__":
    scheme = touchdown.Scheme(
        name="mine", title="own", order=3, slopes=True, modes=True, error_order=3, angle_limit=1.0,
        sequence="mine",
    )
    touchdown.register_scheme(scheme, Mine)
    scene = touchdown.load("disk-caged-simplified").set({"run.duration": "1 ms"})
    for member in touchdown.sweep(scene, {"run.scheme": "mine"}, in_process=True, jobs=1):
        print(member.failed, member.summary["scheme"])
"""


@pytest.mark.slow
def test_processes_of_a_sweep_know_schemes_of_one_s_own(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(OWN_SCHEME, encoding="utf-8")
    made = subprocess.run(
        [sys.executable, tmp_path / "own.py"], capture_output=True, text=True, check=False
    )
    assert made.stdout == " mine\n", made.stderr


UNGUARDED = """
import touchdown
scene = touchdown.load("disk-caged-simplified").set({"run.duration": "1 ms"})
members = touchdown.sweep(scene, {"rotor.speed": 900.0}, in_process=True, jobs=1)
print([member.failed for member in members])
"""


@pytest.mark.slow
def test_a_sweep_in_a_script_without_the_guard_says_so(tmp_path: Path) -> None:
    (tmp_path / "bare.py").write_text(UNGUARDED, encoding="utf-8")
    made = subprocess.run(
        [sys.executable, tmp_path / "bare.py"], capture_output=True, text=True, check=False
    )
    assert made.stdout == "['its process ended with status 1 before it began']\n"
    assert 'put what it does under if __name__ == "__main__":' in made.stderr
    assert "Traceback" not in made.stderr


def test_numbers_of_numpy_are_numbers() -> None:
    settings = {"rotor.speed": np.int64(900), "rotor.y": np.float32(1e-5), "run.record_every": np.int64(3)}
    scene = SCENE.set(settings)
    assert scene.run.record_every == 3
    kept = json.loads(json.dumps(scene.resolved(), default=str))
    assert kept["components"]["rotor"]["set"]["speed"] == 900
    points = {"rotor.speed": np.linspace(800.0, 900.0, 2), "run.scheme": "hold"}
    members = touchdown.sweep(scene, points, in_process=True, jobs=1)
    assert [member.settings["rotor.speed"] for member in members] == [800.0, 900.0]
    assert not any(member.failed for member in members)


@pytest.mark.parametrize("name", ["friction", "clearance"])
def test_fractions_and_speeds_are_numbers_or_texts(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As options of the command come, too."""
    found: list[Any] = []
    monkeypatch.setattr(over_speed, "loops_in", lambda scene, speeds, *_: found.extend(speeds))
    touchdown.amb_margins(SCENE, speeds=[100.0, "-60 rpm"])
    touchdown.amb_margins(SCENE, speeds="60 rpm")
    assert found == pytest.approx([100.0, -6.283, 6.283], abs=1e-3)
    found.clear()
    monkeypatch.setattr(ranking, "rank", lambda *given: found.append(given[3]))
    with pytest.raises(touchdown.TouchdownError, match=f"{name} = '30 mm' has the unit mm"):
        touchdown.rank(SCENE, "6014", **{name: "30 mm"})
    touchdown.rank(SCENE, "6014", **{name: "30 %"})
    assert [getattr(one, name) for one in found] == [pytest.approx(0.3)]


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Options]:
    """What comparisons are asked for, instead of being made."""
    found: list[Options] = []
    monkeypatch.setattr(comparison, "compare", lambda of, scene, asked, begin: found.append(asked))
    return found


def test_a_single_one_is_one(asked: list[Options], tmp_path: Path) -> None:
    touchdown.compare(SCENE, schemes="hold", macro_steps=2e-5)
    touchdown.compare(SCENE, schemes=["hold", "hold"], macro_steps=np.array([2e-5, 1e-5]))
    assert [one.schemes for one in asked] == [("hold",), ("hold",)]
    assert [one.macro_steps for one in asked] == [(2e-5,), (2e-5, 1e-5)]
    touchdown.compare(of="stability", cases=["bounce", "bounce"])
    assert list(asked[-1].cases or ()) == ["bounce"]
    assert touchdown.build("bushing", tmp_path) == [tmp_path / "bushing.fmu"]
    assert touchdown.build([], tmp_path) == []


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"macro_steps": [0]}, "macro_steps = 0 must be above 0"),
        ({"macro_steps": -1e-5}, "macro_steps = -1e-05 must be above 0"),
        ({"macro_steps": []}, "a macro step at least"),
        ({"schemes": []}, "needs a scheme"),
        ({"duration": 0}, "duration = 0 must be above 0"),
        ({"of": "mode"}, "there is no comparison of mode; did you mean mode"),
        (
            {"of": "models", "wanted": 1e-6},
            "wanted does not go with of models, which takes duration, repeat",
        ),
        ({"of": "modes", "modes": 1}, "modes: 1 is less than 2"),
    ],
)
def test_a_comparison_that_cannot_be(given: dict[str, Any], says: str) -> None:
    with pytest.raises(touchdown.TouchdownError, match=says):
        touchdown.compare(SCENE, **given)


def test_a_rotor_shows_itself_without_its_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("touchdown.command.api.rotor.described", None)
    steel = touchdown.Element(length=0.1, outer_diameter=0.04, modulus=0.0, density=7830.0, poisson=0.3)
    shaft = touchdown.Rotor("bad", (steel, steel), stations=(touchdown.Station("A", 7),))
    assert repr(shaft) == "<Rotor bad: 2 elements, 3 nodes, 1.9679 kg, 0.2 m, stations: A at node 7>"


def test_a_rotor_from_python_runs_in_a_scene(tmp_path: Path) -> None:
    """Rotor I, saved and loaded: the drop is the shipped rotor's to the bit."""
    scene = touchdown.load("rotor1-9000").set({"run.duration": "1 ms"})
    rotor = touchdown.Rotor.load(touchdown.Rotor.load("rotor_I").save(tmp_path / "again.toml"))
    assert rotor == touchdown.Rotor.load("rotor_I")
    own, shipped = (touchdown.run(s, in_process=True) for s in (scene.swap(rotor=rotor), scene))
    for name in ("rotor.A.x", "rotor.B.y"):
        np.testing.assert_array_equal(own.data[name], shipped.data[name])


def test_a_rotor_a_file_cannot_hold_is_refused(tmp_path: Path) -> None:
    steel = {"modulus": 207e9, "density": 7830.0, "poisson": 0.3}
    huge = touchdown.Element(length=1e3, outer_diameter=0.04, **steel)
    with pytest.raises(touchdown.TouchdownError, match="out of proportion"):
        touchdown.Rotor("huge", (huge,)).save(tmp_path / "huge.toml")
    assert list(tmp_path.iterdir()) == []
