"""Libraries in FMUs: what is damaged is told before it is loaded, what is not is left alone."""

from __future__ import annotations

import platform
import struct
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
from commands import SCENE, Command

from touchdown.master.common.errors import TouchdownError
from touchdown.master.components.screening import refuse_damaged


@pytest.fixture
def library(unpacked: Mapping[str, Path], tmp_path: Path) -> Path:
    """A copy of an FMU's library."""
    (whole,) = (unpacked["housing"] / "binaries" / "linux64").iterdir()
    copy = tmp_path / whole.name
    copy.write_bytes(whole.read_bytes())
    return copy


def at(place: int, kind: str, value: int) -> Callable[[bytes], bytes]:
    """A number of struct's `kind` written over what stands at `place`."""

    def change(content: bytes) -> bytes:
        written = struct.pack(kind, value)
        return content[:place] + written + content[place + len(written) :]

    return change


def in_segment(wanted: int, member: int, value: int) -> Callable[[bytes], bytes]:
    """A member (bytes from its begin) of the first segment of a type changed."""

    def change(content: bytes) -> bytes:
        (table,) = struct.unpack_from("<Q", content, 32)
        number = next(k for k in range(99) if content[table + 56 * k] == wanted)
        return at(table + 56 * number + member, "<Q", value)(content)

    return change


def in_dynamic(tag: int, value: int) -> Callable[[bytes], bytes]:
    """A value of the dynamic table changed."""

    def change(content: bytes) -> bytes:
        (table,) = struct.unpack_from("<Q", content, 32)
        number = next(k for k in range(99) if content[table + 56 * k] == 2)
        (place,) = struct.unpack_from("<Q", content, table + 56 * number + 8)
        while struct.unpack_from("<q", content, place)[0] != tag:
            place += 16
        return at(place + 8, "<Q", value)(content)

    return change


DAMAGES: dict[str, tuple[Callable[[bytes], bytes], str]] = {
    "empty": (lambda content: b"", "it is empty"),
    "text": (lambda content: b"no library", "header"),
    "a script": (lambda content: b"#!/bin/sh\n" + bytes(200), "no 64-bit ELF"),
    "32 bit": (at(4, "B", 1), "no 64-bit ELF"),
    "other byte order": (at(5, "B", 2), "no 64-bit ELF"),
    "another machine": (at(18, "<H", 40), f"no shared library for {platform.machine()}"),
    "a program": (at(16, "<H", 2), "no shared library"),
    "cut in the header": (lambda content: content[:40], "header"),
    "cut in the segments": (lambda content: content[:100], "segments end behind"),
    "cut in half": (lambda content: content[: len(content) // 2], "behind"),
    "last byte missing": (lambda content: content[:-1], "behind"),
    "segments elsewhere": (at(32, "<Q", 2**40), "segments end behind"),
    "sections elsewhere": (at(40, "<Q", 2**63), "sections end behind"),
    "a segment too long": (in_segment(1, 32, 2**33), "behind"),
    "a segment out of place": (in_segment(1, 16, 12345), "do not fit"),
    "too much memory": (in_segment(1, 40, 2**50), "do not fit"),
    "first function elsewhere": (in_dynamic(12, 2**40), "first and last functions"),
    "symbols elsewhere": (in_dynamic(6, 2**40), "tables lead out"),
    "strings elsewhere": (in_dynamic(5, 2**40), "strings lead out"),
    "relocations elsewhere": (in_dynamic(7, 2**40), "tables lead out"),
    "relocations too many": (in_dynamic(8, 2**40), "tables lead out"),
    "strings too short": (in_dynamic(10, 8), "none of its strings"),
}


@pytest.mark.parametrize(("harm", "why"), DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_library(harm: Callable[[bytes], bytes], why: str, library: Path) -> None:
    library.write_bytes(harm(library.read_bytes()))
    with pytest.raises(TouchdownError, match=r"cannot load own\.fmu: .* is damaged or none") as error:
        refuse_damaged(Path("own.fmu"), library)
    assert why in str(error.value)


def test_no_flipped_bit_of_the_tables_brings_a_traceback(library: Path) -> None:
    whole = library.read_bytes()
    generator = np.random.default_rng(5)
    refused = 0
    for place in generator.integers(0, 4096, 200):
        library.unlink()
        library.write_bytes(at(int(place), "B", whole[place] ^ (1 << int(generator.integers(8))))(whole))
        try:
            refuse_damaged(Path("own.fmu"), library)
        except TouchdownError:
            refused += 1
    assert refused > 10


def test_whole_libraries_are_left_alone(built: Mapping[str, Path], library: Path) -> None:
    """Ours, and those that Python brings, from other compilers and linkers."""
    found = [library, *Path(np.__file__).parent.rglob("*.so")]
    assert len(found) > 10
    for path in found:
        refuse_damaged(Path("own.fmu"), path)


def test_a_run_and_a_check_refuse_it_in_one_line(
    command: Command, built: Mapping[str, Path], own_cache: Path, tmp_path: Path
) -> None:
    """In a whole archive: checksums tell nothing."""
    path = tmp_path / "cut.fmu"
    with zipfile.ZipFile(built["housing"]) as source, zipfile.ZipFile(path, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            target.writestr(name, content[: len(content) // 2] if name.endswith(".so") else content)
    swap = ("run", SCENE, "--swap", f"housing={path}", "--in-process", "--quiet")
    for line in (command("check", path).line, command(*swap).line):
        assert f"cannot load {path}: its library Housing.so is damaged" in line
