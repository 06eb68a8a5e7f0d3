"""Members of a sweep as they end: a line each in members.jsonl, on the disk before the next is taken.

What is killed leaves a line half written at most, which counts for nothing and is cut off when the sweep
goes on. A member that was run twice has two lines, of which the last counts. What changes from machine to
machine, the wall time, stands apart from the summary.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...master.common.errors import Ended, TouchdownError
from ...master.common.files import writing_to
from ...master.quantities import checked, quantities
from ...modelkit.kernel.writing import open_in_place
from ...modelkit.reader import FIGURE, TABLE, TEXT, Table, json_of, listed, maybe, whole

MEMBERS_FILE = "members.jsonl"


@dataclass(frozen=True)
class Member:
    """One run of a sweep."""

    number: int  # from 1
    settings: Mapping[str, object]
    summary: Mapping[str, Any]
    failed: str = ""  # why, or ""
    ended: Ended = Ended.COMPLETED
    kept: bool = False  # whether it had ended before, and was not run again
    seconds: float | None = None  # wall time of its run
    warnings: Sequence[str] = ()  # what is to be said beside its figures

    @property
    def meets(self) -> bool:
        """Whether it came to its end and met all that its scene requires."""
        return not self.failed and self.summary.get("requirements_met") is True


def without_costs(summary: Mapping[str, Any]) -> dict[str, Any]:
    """A summary without what differs from computer to computer."""
    costs = {one.key for one in quantities() if one.machine}
    return {key: value for key, value in summary.items() if key not in costs}


@dataclass(frozen=True)
class Journal:
    """Members in the file at `path` by number, and a place for more."""

    path: Path
    members: dict[int, Member] = field(default_factory=dict[int, Member])

    def add(self, member: Member) -> Member:
        """Write a member that ended, and return it as read again; an interrupted one is not kept.

        Raises TouchdownError where it cannot be written.
        """
        finite = replace(member, summary=without_costs(member.summary))
        if member.ended is Ended.INTERRUPTED:
            return finite
        with writing_to(self.path.parent):
            _append(self.path, _line(finite))
        self.members[finite.number] = finite
        return finite


def read_journal(path: Path, settings: Mapping[int, Mapping[str, object]]) -> Journal:
    """Members in the file at `path` whose `settings` are given; it need not be there.

    Lines that cannot be read are left out. Raises TouchdownError where the file cannot be, and where it is
    of an earlier version.
    """
    journal = Journal(path)
    if not path.is_file():
        return journal
    try:
        lines = path.read_bytes().split(b"\n")[:-1]  # behind the last end of a line: half a line, or none
    except OSError as error:
        raise TouchdownError(f"cannot read {path}: {error.strerror}") from None
    for line in lines:
        member = _member(line, settings, path)
        if member is not None:
            journal.members[member.number] = member
    return journal


def cut_torn_line(path: Path) -> None:
    """Remove a line that is not whole from the end of a file, where there is one. Raises OSError."""
    if not os.path.lexists(path):
        return
    with os.fdopen(open_in_place(path, os.O_RDWR), "r+b") as file:
        file.truncate(file.read().rfind(b"\n") + 1)


def _line(member: Member) -> bytes:
    record = {
        "member": member.number,
        "ended": member.ended.value,
        "failed": member.failed,
        "summary": dict(member.summary),
        "seconds": member.seconds,
        "warnings": list(member.warnings),
    }
    return (json.dumps(record) + "\n").encode()


def _append(path: Path, line: bytes) -> None:
    """Put a line on the disk, whole or not at all. Raises OSError."""
    with os.fdopen(open_in_place(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND), "ab", 0) as file:
        before = os.fstat(file.fileno()).st_size
        try:
            while line:
                line = line[file.write(line) :]
            os.fsync(file.fileno())
        except BaseException:  # a signal's, too
            file.truncate(before)
            raise


def _member(line: bytes, settings: Mapping[int, Mapping[str, object]], path: Path) -> Member | None:
    try:
        record = Table("", json_of(line, str(path)))
        number = record.get("member", whole(1))
        if "figures" not in record.values:
            return Member(
                number,
                settings[number],
                checked(record.get("summary", TABLE), str(path)),
                record.get("failed", TEXT),
                Ended(record.get("ended", TEXT)),
                kept=True,
                seconds=record.get("seconds", maybe(FIGURE)),
                warnings=record.get("warnings", listed(TEXT), ()),  # earlier versions did not write them
            )
    except (TouchdownError, ValueError, KeyError):
        return None
    raise TouchdownError(
        f"{path} is of an earlier version; run the sweep again in another folder, or with --anew"
    )
