"""The folder of a run's results, written and read back."""

from __future__ import annotations

import json
import os
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from ...modelkit.kernel.writing import make_folder, open_in_place, remove_file, unfinished, write
from ...modelkit.reader import (
    FIGURE,
    TABLE,
    TEXT,
    Table,
    instance,
    json_of,
    listed,
    maybe,
    row,
    text_of,
    whole,
    word,
)
from ...modelkit.variables import Causality, Variability
from ..common.errors import Ended, TouchdownError
from ..common.files import writing_to
from ..components.component import FmiType, ScalarVariable
from ..coupling.connections import Attachment, Connection
from ..quantities import checked
from ..scene.file import SCENE_FILE, restored
from ..scene.tables import is_scene_file
from .final_state import FinalState, FinalValues
from .recording import Recording
from .result import RECORDING, Result
from .resume import STATE_FILE

try:
    import fcntl
except ImportError:  # Windows: two runs into one folder are not noticed
    fcntl = None

LOCK_FILE = ".touchdown.lock"
SUMMARY_FILE, SCENE = "summary.json", "scene.json"
ENDING_FILE = "ending.json"  # the components as they ended
DERIVED_FILES = (  # by other commands, as they name it
    *("report.html", "report.pdf", "report-short.html", "report-short.pdf"),
    *("view.html", "drop.gif", "drop.mp4"),
    *("result.csv", "result.xlsx", "result.mat", "result.parquet"),
)
PICTURES = (  # of a run, before the component that some have at the end
    *("orbit", "along", "force", "speeds", "distance", "slowing", "contacts", "spectrum", "waterfall"),
    *("held", "orbits", "gaps", "stress", "energy"),
)
RESERVED_BYTES = 2**14  # bytes kept for the summary of a run that fills the disk


class ResultsFolder:
    """The folder at `path`, this run's alone."""

    def __init__(self, path: Path, lock: int) -> None:
        self.path = path
        self._lock = lock

    def begin(self, scene: Mapping[str, object], kept: Sequence[str] = ()) -> None:
        """Remove what an earlier run left but for `kept`, write the scene that is run. Raises OSError."""
        for path in _earlier_files(self.path):
            if path.name not in kept:
                remove_file(path)
        write(self.path / SCENE, json.dumps(scene, indent=2, default=str) + "\n")

    def finish(self, summary: Mapping[str, object]) -> None:
        """Write the summary, which says that all else is there. Raises OSError."""
        os.ftruncate(self._lock, 0)
        write(self.path / SUMMARY_FILE, json.dumps(summary, indent=2) + "\n")


@contextmanager
def claimed(path: Path) -> Generator[ResultsFolder]:
    """The folder at `path`, made where there is none, for one run.

    Raises TouchdownError where it cannot be written, or another run that lives writes it; one that was
    killed holds nothing.
    """
    with writing_to(path):
        make_folder(path)
        lock = _locked(path / LOCK_FILE)
    try:
        with writing_to(path):
            os.write(lock, bytes(RESERVED_BYTES))
        yield ResultsFolder(path, lock)
    finally:
        with suppress(OSError):
            remove_file(path / LOCK_FILE)
        os.close(lock)


def _locked(path: Path) -> int:
    """Descriptor of the file at `path`, locked. Raises OSError, or TouchdownError where it is already."""
    while True:
        lock = open_in_place(path, os.O_RDWR | os.O_CREAT)
        if fcntl is None:
            return lock
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with suppress(FileNotFoundError):  # removed meanwhile by the run that had it
                if os.path.samestat(os.fstat(lock), os.stat(path)):
                    return lock
        except BlockingIOError:
            os.close(lock)
            raise TouchdownError(
                f"another run is writing to {path.parent}; wait for it, or choose another folder with -o"
            ) from None
        except OSError:  # a file system without locks
            return lock
        os.close(lock)


def derived_files(folder: Path) -> list[str]:
    """Pages and films of the earlier run in a folder. Without a run's ending they are the user's own."""
    if not (folder / ENDING_FILE).is_file():
        return []
    return [name for name in DERIVED_FILES if (folder / name).is_file()]


def _earlier_files(folder: Path) -> Iterator[Path]:
    """Files that a run may have left, the summary first: without it the others do not count as whole."""
    pictures = list(_pictures(folder))
    files = [folder / name for name in (SUMMARY_FILE, ENDING_FILE, STATE_FILE, RECORDING)]
    yield from (files[0], *pictures, *files[1:], *(folder / name for name in derived_files(folder)))
    for path in (*files, folder / SCENE, *pictures):
        yield from unfinished(path)


def _pictures(folder: Path) -> Iterator[Path]:
    """The pictures that an earlier run may have drawn of its scene; others' pictures stay.

    Only files of the folder, with any names in its scene.json.
    """
    if not (there := list(folder.glob("*.png"))):
        return
    try:
        components = Table("", json_of(text_of(folder / SCENE), SCENE)).table("components").values
    except TouchdownError:
        return
    drawn = {f"{name}{tail}.png" for name in PICTURES for tail in ("", *(f"-{c}" for c in components))}
    yield from (path for path in there if path.name in drawn)


COLUMNS = (
    *("name", "reference", "kind", "causality", "variability", "unit", "minimum", "maximum", "start"),
    *("description", "element", "choices", "value"),
)
"""Of a variable, in the order of its row in the file; unit and value in SI."""


def write_final_state(folder: Path, ending: FinalState, warnings: Iterable[str]) -> None:
    """Write what `_read_final_state` reads. Raises OSError."""
    values = {
        "columns": COLUMNS,
        "components": {name: _rows(component) for name, component in ending.components.items()},
        "attachments": [list(vars(a).values()) for a in ending.attachments],
        "connections": [list(vars(c).values()) for c in ending.connections],
        "warnings": list(warnings),
    }
    write(folder / ENDING_FILE, json.dumps(values, separators=(",", ":")) + "\n")


def _rows(component: FinalValues) -> list[list[object]]:
    return [
        [*(getattr(variable, column) for column in COLUMNS[:-1]), component.values[name]]
        for name, variable in component.variables.items()
    ]


VALUE = maybe(instance((bool, int, float), "a number"))  # one that is not finite is what its FMU gave
ROW = row(
    *(TEXT, whole(0), *(word(list(one)) for one in (FmiType, Causality, Variability)), maybe(TEXT)),
    *(VALUE, VALUE, VALUE, TEXT, whole(0), TABLE, VALUE),
)


def _read_final_state(values: Mapping[str, Any]) -> tuple[FinalState, list[str]]:
    """The ending and the warnings in the file's `values`. Raises TouchdownError, or ValueError."""
    top = Table(f"{ENDING_FILE}: ", values)
    components = top.table("components")
    known = {name: _last_values(components.get(name, listed(ROW))) for name in components.values}
    attachments = [Attachment(*parts) for parts in top.get("attachments", listed(row(*[TEXT] * 4)))]
    ends = [(a.bearing, a.body) for a in attachments]
    connections: list[Connection] = []
    for parts in top.get("connections", listed(row(*[TEXT] * 4, maybe(row(FIGURE, FIGURE))))):
        connections.append(Connection(*parts))
        ends.append((connections[-1].source, connections[-1].target))
    if unknown := [name for pair in ends for name in pair if name not in known]:
        raise ValueError(f"{ENDING_FILE} connects {unknown[0]}, of which it has no values")
    return FinalState(known, tuple(attachments), tuple(connections)), [*top.get("warnings", listed(TEXT))]


def _last_values(rows: Iterable[tuple[Any, ...]]) -> FinalValues:
    variables: dict[str, ScalarVariable] = {}
    values: dict[str, float] = {}
    for name, reference, kind, causality, variability, *about, value in rows:
        kinds = FmiType(kind), Causality(causality), Variability(variability)
        variables[name] = ScalarVariable(name, reference, *kinds, *about)
        values[name] = value
    return FinalValues(variables, values)


def reopened(folder: Path) -> Result:
    """The result in `folder`, as `run_scene` returned it, without its pictures.

    Raises TouchdownError where there is no run, it was killed or goes on, or another version left it.
    """
    if os.path.isfile(folder):
        if is_scene_file(folder) and not (folder.parent / SUMMARY_FILE).exists():
            raise TouchdownError(
                f"{folder} is a scene; `touchdown run {folder}` first, and give the folder it names"
            )
        raise TouchdownError(f"{folder} is a file; give the folder that it lies in, {folder.parent}")
    if not os.path.isdir(folder):
        raise TouchdownError(f"there is no folder {folder}; give the one that `touchdown run` wrote to")
    if (folder / SCENE_FILE).is_file() and not (folder / SUMMARY_FILE).exists():
        raise TouchdownError(
            f"{folder} is a machine's folder; `touchdown run {folder}` first, and give the folder it names"
        )
    runs = sorted(path.parent for path in folder.glob(f"*/{SUMMARY_FILE}"))
    if runs and not (folder / SUMMARY_FILE).exists():
        raise TouchdownError(
            f"{folder} is not a run's folder, it holds {len(runs)} of them; give one, such as {runs[0]}"
        )
    summary = _values(folder, SUMMARY_FILE, "a study left it, or its run was killed or goes on")
    final = _values(folder, ENDING_FILE, "an earlier version left it; run the scene again")
    scene = _values(folder, SCENE, "run the scene again")
    if not (folder / RECORDING).is_file():
        raise TouchdownError(f"{folder / RECORDING} is missing; run the scene again")
    if not {"end_time", "ended"} <= summary.keys():
        raise TouchdownError(f"{folder / SUMMARY_FILE}: an earlier version left it; run the scene again")
    try:
        summary = checked(summary, SUMMARY_FILE)
        ending, warnings = _read_final_state(final)
        ran = restored(scene)
        if ran.components.keys() != ending.components.keys():
            raise ValueError(f"{SCENE} has other components than {ENDING_FILE}")
        return Result(
            ran,
            Recording(folder / RECORDING),
            folder,
            summary,
            ending,
            Ended(summary["ended"]),
            str(summary.get("stopped_because", "")),
            warnings,
        )
    except TouchdownError as error:
        raise TouchdownError(f"{folder}: {error}") from None
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise TouchdownError(
            f"{folder} is not as a run leaves it ({type(error).__name__}: {error}); run the scene again"
        ) from None


def _values(folder: Path, name: str, lacking: str) -> dict[str, Any]:
    """Of a file of the folder; `lacking`: why there may be none. Raises TouchdownError."""
    if not os.path.lexists(folder / name):
        raise TouchdownError(f"{folder} has no {name}: {lacking}")
    return json_of(text_of(folder / name), str(folder / name))
