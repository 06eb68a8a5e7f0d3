"""Many runs of a scene that differ in some settings, beside each other in processes of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import overload

from ...master.common.files import writing_to
from ...master.common.pool import executor
from ...master.common.progress import SILENT_PROGRESS, Progress
from ...master.results.folder import claimed
from ...master.results.result import RECORDING
from ...master.results.resume import Earlier
from ...master.scene.scene import Scene
from ...modelkit.kernel.writing import discard, remove_file
from . import definition
from .definition import Definition, define, read_definition, refuse_other
from .design import Design
from .members import MEMBERS_FILE, Journal, Member, cut_torn_line, read_journal
from .results import DATASET, TABLE, Sweep, write_results
from .tasks import TWO_JOBS, Running, Task, run_tasks

DERIVED_FILES = (  # what an earlier sweep may have left, beside its journal
    *(DATASET, TABLE, "whirl-map.png", "capture-map.png", "force-map.png", "stress-map.png"),
    *("report.html", "report.pdf"),
)
SCRATCH_FOLDER = ".under-way"  # where members run whose recordings are not kept


def sweep(
    scene: Scene,
    design: Design,
    folder: Path,
    running: Running = TWO_JOBS,
    progress: Progress = SILENT_PROGRESS,
) -> Sweep:
    """Run `scene` at every point of `design`; `progress` is planned when nothing is refused any more.

    Each member that ends is a line of members.jsonl in `folder`; at the end all stand in sweep.nc and
    sweep.csv. Members that `folder` has already are `kept`, not run again, unless they failed.
    A member that fails says so and the others go on. After Ctrl-C those that have not run are INTERRUPTED.
    With `running.earlier` all start at the end of that run. One sweep at a time has the folder. Raises
    TouchdownError where a setting cannot be, and where `folder` holds another sweep. A script that calls it
    needs `if __name__ == "__main__":`, as all do that start processes.
    """
    scene, folder = replace(scene, folder=scene.folder.absolute()), folder.absolute()
    earlier = None if running.earlier is None else Earlier(running.earlier.absolute())
    if earlier:
        scene = earlier.onward(scene)
        running = replace(running, earlier=earlier.folder, in_process=earlier.in_process)
    asked = define(scene, design, running.in_process, earlier)
    if running.cluster:  # before there is anything of the sweep in its folder
        with executor(running.jobs, running.cluster):
            pass
    with claimed(folder):
        lines = _opened(folder, asked, running)
        progress.planned(len(asked.numbers))
        tasks = _Tasks(asked, scene, folder, running, [])
        left = [n for n in asked.numbers if not _is_there(lines.members.get(n), tasks.kept_in(n))]
        for _ in range(len(asked.numbers) - len(left)):
            progress.done()
        finished = _run(replace(tasks, numbers=left), lines, running, progress.done)
        members = [finished[n] if n in finished else lines.members[n] for n in asked.numbers]
        found = Sweep(asked, tuple(members), folder)
        with writing_to(folder):
            discard(folder / SCRATCH_FOLDER)
            write_results(found, folder)
    return found


def _opened(folder: Path, asked: Definition, running: Running) -> Journal:
    """The journal of the sweep in `folder`, which is begun or goes on. Raises TouchdownError."""
    path = folder / MEMBERS_FILE
    begun = (folder / definition.DEFINITION_FILE).exists()
    if begun and not running.anew:
        refuse_other(folder, read_definition(folder), asked)
    with writing_to(folder):
        discard(folder / SCRATCH_FOLDER)
        if not begun or running.anew:
            for left in (MEMBERS_FILE, *DERIVED_FILES):
                remove_file(folder / left)
            asked.write(folder)
        cut_torn_line(path)
    return read_journal(path, asked.by_number)


def _is_there(member: Member | None, kept_in: Path | None) -> bool:
    """Whether a member need not be run; its recording must be `kept_in` a folder, if in any."""
    if member is None or member.failed:  # of what may have changed: a full disk
        return False
    return kept_in is None or (kept_in / RECORDING).is_file()


@dataclass(frozen=True)
class _Tasks(Sequence[Task]):
    """Members that are to run, each made when it is looked at: a scene's copies take room."""

    asked: Definition
    scene: Scene
    folder: Path
    running: Running
    numbers: Sequence[int]

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, place: int) -> Task: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[Task]: ...
    def __getitem__(self, place: int | slice) -> Task | Sequence[Task]:
        if isinstance(place, slice):
            return replace(self, numbers=self.numbers[place])
        number, running = self.numbers[place], self.running
        where = self.kept_in(number)
        if where is None and not running.cluster:  # whose workers may be anywhere, and find a place there
            where = self.folder / SCRATCH_FOLDER / str(number)
        scene = self.asked.at(self.scene, number)
        settings, keep = self.asked.settings(number), running.keep
        return Task(number, settings, scene, where, running.in_process, keep, not keep, running.earlier)

    def kept_in(self, number: int) -> Path | None:
        """The folder of a member that is kept whole; None where none is."""
        name = f"{number:0{max(3, len(str(len(self.asked.points))))}}"
        return self.folder / name if self.running.keep else None


def _run(
    tasks: Sequence[Task], lines: Journal, running: Running, done: Callable[[], object]
) -> dict[int, Member]:
    """Members by number, as the journal has them."""
    members: dict[int, Member] = {}

    def keep(member: Member) -> None:
        kept = lines.add(member)
        members[kept.number] = kept

    run_tasks(tasks, running, done, keep)
    return members
