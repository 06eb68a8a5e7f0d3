"""The folder of a run's results: one run at a time writes it, and nothing in it is another run's."""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from touchdown.master.common.errors import TouchdownError
from touchdown.master.common.files import partial, replace_text, writing_to
from touchdown.master.results.result import RECORDING

LOCK = ".touchdown.lock"
SUMMARY, SCENE, TABLE = "summary.json", "scene.json", "result.csv"
ENDING = "ending.json"  # the components as they ended
MADE_OF_IT = ("report.html", "report.pdf", "drop.gif", "drop.mp4")  # by other commands, as they name it
RESERVE = 2**14  # bytes kept for the summary of a run that fills the disk


class ResultsFolder:
    """The folder at `path`, this run's alone."""

    def __init__(self, path: Path, lock: int) -> None:
        self.path = path
        self._lock = lock

    def begin(self, scene: Mapping[str, object]) -> None:
        """Remove what an earlier run left, and write the scene as it is run. Raises OSError."""
        for path in _left(self.path):
            path.unlink(missing_ok=True)
        replace_text(self.path / SCENE, json.dumps(scene, indent=2, default=str) + "\n")

    def finish(self, summary: Mapping[str, object]) -> None:
        """Write the summary, which says that all else is there. Raises OSError."""
        os.ftruncate(self._lock, 0)
        replace_text(self.path / SUMMARY, json.dumps(summary, indent=2) + "\n")


@contextmanager
def claimed(path: Path) -> Generator[ResultsFolder]:
    """The folder at `path`, made where there is none, for one run.

    Raises TouchdownError where it cannot be written, or another run that lives writes it; one that was
    killed holds nothing.
    """
    with writing_to(path):
        path.mkdir(parents=True, exist_ok=True)
        lock = _locked(path / LOCK)
    try:
        with writing_to(path):
            os.pwrite(lock, bytes(RESERVE), 0)
        yield ResultsFolder(path, lock)
    finally:
        with suppress(OSError):
            (path / LOCK).unlink()
        os.close(lock)


def _locked(path: Path) -> int:
    """Descriptor of the file at `path`, locked. Raises OSError, or TouchdownError where it is already."""
    while True:
        lock = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
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


def _left(folder: Path) -> Iterator[Path]:
    """Files that a run may have left, the summary first: without it nobody takes the others for whole."""
    made_of_it = MADE_OF_IT if (folder / ENDING).is_file() else ()  # else such pages are somebody's
    pictures = list(_pictures(folder))
    yield folder / SUMMARY
    yield from pictures
    yield from (folder / name for name in (TABLE, ENDING, *made_of_it))
    recording = (folder / RECORDING).resolve()  # a link stays
    yield recording
    for path in (*(folder / name for name in (SUMMARY, SCENE, TABLE, ENDING)), recording, *pictures):
        yield partial(path)


def _pictures(folder: Path) -> Iterator[Path]:
    """Those that an earlier run may have drawn of its scene; others' pictures are none of it."""
    if not any(folder.glob("*.png")):
        return
    try:
        components = list(json.loads((folder / SCENE).read_text(encoding="utf-8"))["components"])
    except (OSError, ValueError, TypeError, KeyError):
        return
    from touchdown.master.results.figures.drawing import NAMES  # matplotlib is slow to import

    for name in NAMES:
        yield from (folder / f"{name}{tail}.png" for tail in ("", *(f"-{c}" for c in components)))
