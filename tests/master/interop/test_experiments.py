"""Experiments that FMUs bring along: ours pass, spoiled ones fail and say where, others' are read."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest

from touchdown.master.cli import main
from touchdown.master.common.errors import FAILED, TouchdownError
from touchdown.master.components.loading import load_component
from touchdown.master.interop.check import check_fmu
from touchdown.master.interop.experiments import FOLDER, Experiment, Table, experiments, largest_deviation

pytestmark = pytest.mark.slow

RESULTS, EXPERIMENT = f"{FOLDER}/results.csv", f"{FOLDER}/smoke-test.exp"
Change = Callable[[str], str]


def spoiled(fmu: Path, folder: Path, changes: Mapping[str, Change]) -> Path:
    """A copy of an FMU with some of its files changed."""
    path = folder / "spoiled.fmu"
    with zipfile.ZipFile(fmu) as archive, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as copy:
        for name in archive.namelist():
            content = archive.read(name)
            if name in changes:
                content = changes[name](content.decode()).encode()
            copy.writestr(name, content)
    return path


def fifth_force_doubled(text: str) -> str:
    """The largest force of the housing, in one row, is twice what it was."""
    head, *rows = text.splitlines()
    column = head.split(",").index("journal.fy")
    cells = [row.split(",") for row in rows]
    largest = max(cells, key=lambda row: abs(float(row[column])))
    largest[column] = repr(2.0 * float(largest[column]))
    return "\n".join([head, *(",".join(row) for row in cells)])


def test_a_wrong_result_is_found(built: Mapping[str, Path], tmp_path: Path, capsys):
    """By the command: where, how far off, in which unit, and what is allowed."""
    path = spoiled(built["bushing"], tmp_path, {RESULTS: fifth_force_doubled})
    assert main(["check", str(path)]) == FAILED
    (line,) = (text for text in capsys.readouterr().out.splitlines() if text.startswith("  problem"))
    assert re.search(
        r"experiment press \(50 steps of 2e-05 s\): journal.fy is \S+ N at t = 0.000\d+ s, not", line
    )
    assert line.endswith("0.5 of the largest; 1e-06 is allowed")


def test_a_changed_model_is_found(built: Mapping[str, Path], tmp_path: Path):
    """One whose description starts from another clearance than the parameter set of its experiment."""
    parameters = f"{FOLDER}/default.ssv"
    changed = {
        parameters: lambda text: text.replace('<ssv:Real value="0.0003" />', '<ssv:Real value="0.00031" />')
    }
    (problem,) = check_fmu(str(spoiled(built["bushing"], tmp_path, changed))).problems
    assert "experiment press" in problem
    assert "1e-06 is allowed" in problem


@pytest.mark.parametrize(("word", "said"), [("makkar", ""), ("dry", "none of its choices: coulomb (0)")])
def test_enumerations_are_set_by_their_words(
    word: str, said: str, built: Mapping[str, Path], tmp_path: Path
) -> None:
    law = r'(<ssv:Parameter name="friction.kind">\s*)<ssv:Integer value="2" />'

    def worded(text: str) -> str:
        changed, count = re.subn(law, rf'\g<1><ssv:Enumeration value="{word}" />', text)
        assert count == 1
        return changed

    path = spoiled(built["bushing"], tmp_path, {f"{FOLDER}/default.ssv": worded})
    problems = check_fmu(str(path)).problems
    assert bool(problems) == bool(said)
    assert said in "".join(problems)


@pytest.mark.parametrize(
    ("file", "change", "said"),
    [
        (RESULTS, lambda text: "time,journal.fy\n1,0\n0,0\n", "no table with a time that rises"),
        (RESULTS, lambda text: "time,nothing\n0,0\n", "has no variable nothing"),
        (EXPERIMENT, lambda text: text.replace("results.csv", "../../../a"), "not a file inside"),
        (EXPERIMENT, lambda text: text.replace('"2e-05"', '"-1"'), "in steps of -1 s"),
        (EXPERIMENT, lambda text: text[:100], "not valid XML"),
    ],
)
def test_what_cannot_be_run_is_said(
    file: str, change: Change, said: str, built: Mapping[str, Path], tmp_path: Path
):
    (problem,) = check_fmu(str(spoiled(built["housing"], tmp_path, {file: change}))).problems
    assert said in problem


def test_none_is_no_problem(tmp_path: Path):
    assert list(experiments(tmp_path)) == []


OTHERS = {
    "fmi-ls-manifest.xml": """<fmiReferences xmlns:fmi-ls="http://fmi-standard.org/fmi-ls-manifest"
      fmi-ls:fmi-ls-name="org.fmi-standard.fmi-ls-ref" fmi-ls:fmi-ls-version="1.0.0-beta.1"
      fmi-ls:fmi-ls-description="">
      <Related type="text/plain" source="notes.txt" role="document"/>
      <Related type="application/x-ma-hs-experiments" source="tests/all.exp" role="experiment"/>
      <Related type="application/x-ma-hs-experiments" source="no.exp"
        role="experiment/uncertainty-analysis"/>
      </fmiReferences>""",
    "tests/all.exp": """<Experiments name="a">
      <Experiment name="one" stopTime="0.1"><References source="../out.csv"/></Experiment>
      <Experiment name="two"><Stimuli source="in.csv"/><References source="../out.csv"/></Experiment>
      </Experiments>""",
    "tests/in.csv": '"time","u"\n0,1\n1,3\n',
    "out.csv": "time,y\n0.0,1\n0.1,2\n0.2,3\n",
}


def test_those_of_others_are_read(tmp_path: Path):
    """What is left out follows from the tables; other roles are none of ours."""
    for name, text in OTHERS.items():
        path = tmp_path / FOLDER / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    one, two = experiments(tmp_path)
    assert (one.name, one.start, one.stop, one.step, one.tolerance) == ("one", 0.0, 0.1, 0.1, 1e-3)
    assert (one.steps, two.steps) == (1, 2)
    assert one.stimuli.at(0.0) == {}
    assert two.stimuli.at(0.5) == {"u": 2.0}


def at_rest(names: tuple[str, ...], values: list[list[float]]) -> Experiment:
    """A housing that is left alone, and what is said to come out."""
    references = Table(np.array([0.0, 1e-4]), names, np.array(values))
    nothing = Table(np.zeros(1), (), np.zeros((1, 0)))
    return Experiment("rest", 0.0, 1e-4, 1e-4, 1e-6, {}, nothing, references)


def test_components_of_one_unit_share_their_scale():
    """Rounding errors of what should be nothing are held against the motion beside it, not themselves."""
    sag = twin_at_rest("seat.y")  # m
    noise = 1e-15
    alone = largest_deviation(twin(), at_rest(("seat.x",), [[0.0], [noise]]))
    assert (alone.name, alone.unit, alone.share) == ("seat.x", "m", 1.0)
    other = largest_deviation(twin(), at_rest(("seat.x", "mass"), [[0.0, 4.0], [noise, 4.0]]))
    assert other.share >= 1.0
    beside = largest_deviation(twin(), at_rest(("seat.x", "seat.y"), [[0.0, sag], [noise, sag]]))
    assert (beside.name, beside.share) == ("seat.x", pytest.approx(noise / abs(sag)))


def test_something_where_nothing_was_expected_is_infinitely_far():
    pushed = Experiment(
        "pushed", 0.0, 1e-4, 1e-4, 1e-6, {}, Table(np.zeros(1), ("seat.fx",), np.ones((1, 1))),
        Table(np.array([0.0, 1e-4]), ("seat.vx",), np.zeros((2, 1))),
    )  # fmt: skip
    assert largest_deviation(twin(), pushed).share == np.inf


def test_a_parameter_out_of_bounds_is_refused():
    bad = Experiment(
        "bad", 0.0, 1e-4, 1e-4, 1e-6, {"mass": -1.0}, *[Table(np.zeros(1), (), np.zeros((1, 0)))] * 2
    )
    with pytest.raises(TouchdownError, match="mass = -1 kg must be at least 0"):
        largest_deviation(twin(), bad)


def twin_at_rest(name: str) -> float:
    """What one says at the start."""
    component = twin()
    component.bind([], np.zeros(0), [])
    component.enter(0.0)
    component.exit()
    return component.read([name])[0]


def twin():
    """A housing, in process."""
    from touchdown.master.components.loading import Stepping

    return load_component("checked", "housing", stepping=Stepping(in_process=True))
