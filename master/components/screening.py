"""Checks of an FMU before it is loaded: its description, and its library.

A damaged library may end the process that loads it, as the loader takes an ELF file's tables as they are.
So its header, segments, sections, and the addresses in its tables are checked to lie in the file and in
what is loaded of it (System V ABI, chapters 4 and 5). Damage inside the code itself cannot be found.
"""

from __future__ import annotations

import platform
import re
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from ...modelkit.variables import Causality, Variability
from ..common.errors import TouchdownError
from .component import Kind

STRUCTURAL = "structuralParameter"  # FMI 3.0's: sizes of arrays
KINDS_2 = (Kind.REAL, Kind.INTEGER, Kind.BOOLEAN, Kind.STRING, Kind.ENUMERATION)
KINDS_3 = {  # FMI 3.0's types, and what they are here
    **dict.fromkeys(("Float64", "Float32"), Kind.REAL),
    **dict.fromkeys(("Int8", "Int16", "Int32", "Int64"), Kind.INTEGER),
    **dict.fromkeys(("UInt8", "UInt16", "UInt32", "UInt64"), Kind.INTEGER),
    **{kind.value: kind for kind in (Kind.BOOLEAN, Kind.STRING, Kind.ENUMERATION, Kind.BINARY, Kind.CLOCK)},
}


class DocumentTypeError(ValueError):
    """An XML file that declares a document type."""


def refuse_definitions(path: Path) -> None:
    """Raise DocumentTypeError where an XML file could define entities: they read files or never end.

    Found by a parser, in whatever encoding it stands. Raises ExpatError, ValueError or LookupError for what
    is no XML, OSError for what cannot be read.
    """

    def refuse(*_: Any) -> None:
        raise DocumentTypeError("it declares a document type, which FMI and SSP have no use for")

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    parser.Parse(path.read_bytes(), True)


def refuse_lies(path: Path, description: Any) -> None:
    """Raise TouchdownError where names or value references cannot be what they are for.

    `description` is fmpy's, `path` that of the FMU.
    """
    identifier = description.coSimulation.modelIdentifier or ""
    if not re.fullmatch(r"[A-Za-z_]\w*", identifier, re.ASCII):
        raise TouchdownError(f"{path}: the modelIdentifier {identifier!r} is no name of a library")
    third = description.fmiVersion.startswith("3.")
    names: set[str] = set()
    owners: dict[tuple[str, int], str] = {}
    for v in description.modelVariables:
        what = f"{path}: variable {v.name}"
        if v.name in names:
            raise TouchdownError(f"{what} is declared twice")
        names.add(v.name)
        if not 0 <= v.valueReference < 2**32:
            raise TouchdownError(f"{what} has the value reference {v.valueReference}; it must fit 32 bits")
        _refuse_unknown(what, v, third)
        if v.causality in (Causality.PARAMETER, Causality.INPUT):
            other = owners.setdefault((v.type, v.valueReference), v.name)
            if other != v.name:
                raise TouchdownError(
                    f"{what} and {other} can both be set and share the value reference {v.valueReference}"
                )


def _refuse_unknown(what: str, variable: Any, third: bool) -> None:
    """Raise TouchdownError where a variable is of a type, causality or variability that FMI lacks."""
    for title, stated, known in (
        ("type", variable.type, KINDS_3 if third else KINDS_2),
        ("causality", variable.causality, [*Causality, STRUCTURAL] if third else Causality),
        ("variability", variable.variability, Variability),
    ):
        if stated is not None and stated not in list(map(str, known)):
            version = "3.0" if third else "2.0"
            raise TouchdownError(f"{what} has the {title} {stated}; FMI {version} has {', '.join(known)}")


MACHINES = {"x86_64": 62, "aarch64": 183}  # e_machine by platform.machine()
_HEAD = np.dtype(
    [
        *[("ident", "u1", 16), ("type", "<u2"), ("machine", "<u2"), ("version", "<u4"), ("entry", "<u8")],
        *[("phoff", "<u8"), ("shoff", "<u8"), ("flags", "<u4"), ("ehsize", "<u2")],
        *[("phentsize", "<u2"), ("phnum", "<u2"), ("shentsize", "<u2"), ("shnum", "<u2"), ("names", "<u2")],
    ]
)
_SEGMENT = np.dtype(
    [
        *[("type", "<u4"), ("flags", "<u4"), ("offset", "<u8"), ("address", "<u8"), ("paddr", "<u8")],
        *[("filesz", "<u8"), ("memsz", "<u8"), ("align", "<u8")],
    ]
)
_SECTION = np.dtype(
    [
        *[("name", "<u4"), ("type", "<u4"), ("flags", "<u8"), ("address", "<u8"), ("offset", "<u8")],
        *[("size", "<u8"), ("link", "<u4"), ("info", "<u4"), ("align", "<u8"), ("entsize", "<u8")],
    ]
)
_ENTRY = np.dtype([("tag", "<i8"), ("value", "<u8")])
_SYMBOL = np.dtype(
    [("name", "<u4"), ("info", "u1"), ("other", "u1"), ("index", "<u2"), ("value", "<u8"), ("size", "<u8")]
)
_RELOCATION = np.dtype([("offset", "<u8"), ("type", "<u4"), ("symbol", "<u4"), ("addend", "<i8")])

_SHARED, _LOAD, _TABLE, _EXECUTABLE, _WRITABLE = 3, 1, 2, 1, 2
_NO_BITS, _SYMBOLS = 8, 11  # sections without content in the file; of the dynamic symbols
_STRINGS, _SYMBOL_TABLE, _STRING_SIZE, _SYMBOL_SIZE = 5, 6, 10, 11
_NAMES = (1, 14, 15, 29)  # DT_NEEDED, SONAME, RPATH, RUNPATH: places in the strings
_CODE = (12, 13)  # DT_INIT, FINI
_SIZED = {7: 8, 23: 2, 25: 27, 26: 28, 32: 33}  # DT_RELA, JMPREL, ..._ARRAY: the tag of their size
_TABLES = (3, 4, 0x6FFFFEF5, 0x6FFFFFF0, 0x6FFFFFFC, 0x6FFFFFFE)  # PLTGOT, HASH, GNU_HASH, versions
_COMMON = 0xFFF1  # section indices from here on are no sections
_THREAD = 6  # type of symbols that are offsets
_RELATIVE = {62: 8, 183: 1027}  # type of relocations whose addend is an address


class _DamageError(Exception):
    """Damage that was found."""


def refuse_damaged(path: Path, binary: Path) -> None:
    """Raise TouchdownError where the library `binary` in the FMU at `path` is none, or is damaged."""
    if not sys.platform.startswith("linux"):
        return
    try:
        if not binary.stat().st_size:
            raise _DamageError("it is empty")
        _Library(np.memmap(binary, np.uint8, "r")).check()
    except _DamageError as damage:
        raise TouchdownError(
            f"cannot load {path}: its library {binary.name} is damaged or none ({damage}); "
            "build or download it again"
        ) from None


class _Library:
    """An ELF file and its tables."""

    def __init__(self, content: np.ndarray) -> None:
        self._content = content
        self._head = self._array(_HEAD, 0, 1, "header")[0]
        if bytes(self._head["ident"][:6]) != b"\x7fELF\x02\x01":
            raise _DamageError("it is no 64-bit ELF file")
        machine = MACHINES.get(platform.machine())
        if int(self._head["type"]) != _SHARED or machine not in (None, int(self._head["machine"])):
            raise _DamageError(f"it is no shared library for {platform.machine()}")
        self._segments = self._table(_SEGMENT, "ph", "segments")
        self._sections = self._table(_SECTION, "sh", "sections")
        self._loads = self._segments[self._segments["type"] == _LOAD]

    def check(self) -> None:
        """Raises _DamageError for the first thing that cannot be."""
        self._check_extents()
        dynamic = self._dynamic()
        self._check_dynamic(dynamic)
        symbols = self._symbols()
        self._check_symbols(symbols, dynamic[_STRING_SIZE])
        for tag in (7, 23):
            if tag in dynamic:
                self._check_relocations(dynamic[tag], dynamic.get(_SIZED[tag], 0), len(symbols))

    def _array(self, kind: np.dtype, offset: int, count: int, what: str) -> np.ndarray:
        if offset + count * kind.itemsize > len(self._content):
            raise _DamageError(f"its {what} end behind the file's end")
        return np.frombuffer(self._content, kind, count, offset)

    def _table(self, kind: np.dtype, prefix: str, what: str) -> np.ndarray:
        count, size = int(self._head[f"{prefix}num"]), int(self._head[f"{prefix}entsize"])
        if count and size != kind.itemsize:
            raise _DamageError(f"its {what} are described by {size} bytes each, not {kind.itemsize}")
        return self._array(kind, int(self._head[f"{prefix}off"]), count, what)

    def _check_extents(self) -> None:
        """Segments and sections lie in the file, and segments one after the other in memory."""
        solid = self._sections[self._sections["type"] != _NO_BITS]
        for offset, size in (
            *zip(self._segments["offset"], self._segments["filesz"], strict=True),
            *zip(solid["offset"], solid["size"], strict=True),
        ):
            if int(offset) + int(size) > len(self._content):
                raise _DamageError(
                    f"{size} bytes from {offset} on are behind its end at {len(self._content)}"
                )
        end = 0
        for load in self._loads:
            start, size = int(load["address"]), int(load["memsz"])
            if start < end or size < int(load["filesz"]) or (start - int(load["offset"])) % 4096:
                raise _DamageError("its segments do not fit each other")
            end = start + size
        if not 0 < end < 2**40:
            raise _DamageError("its segments do not fit into memory")

    def _dynamic(self) -> dict[int, int]:
        """The dynamic table by tag, the last of each; names are checked here, since there are several."""
        tables = self._segments[self._segments["type"] == _TABLE]
        if len(tables) != 1:
            raise _DamageError(f"it has {len(tables)} dynamic tables")
        table = tables[0]
        count = int(table["filesz"]) // _ENTRY.itemsize
        entries = self._array(_ENTRY, int(table["offset"]), count, "dynamic entries")
        ends = np.flatnonzero(entries["tag"] == 0)
        if not len(ends):
            raise _DamageError("its dynamic table has no end")
        entries = entries[: ends[0]]
        found = dict(zip(entries["tag"].tolist(), entries["value"].tolist(), strict=True))
        if not {_STRINGS, _SYMBOL_TABLE, _STRING_SIZE, _SYMBOL_SIZE} <= found.keys():
            raise _DamageError("its dynamic table lacks strings or symbols")
        for place in entries["value"][np.isin(entries["tag"], _NAMES)]:
            if place >= found[_STRING_SIZE]:
                raise _DamageError("a name of its dynamic table is none of its strings")
        return found

    def _check_dynamic(self, dynamic: dict[int, int]) -> None:
        """Addresses in the dynamic table are loaded ones."""
        if dynamic[_SYMBOL_SIZE] != _SYMBOL.itemsize:
            raise _DamageError("its symbols are of another size")
        self._require_loaded([dynamic[_STRINGS]], dynamic[_STRING_SIZE], "strings")
        for tag in (_SYMBOL_TABLE, *_TABLES):
            if tag in dynamic:
                self._require_loaded([dynamic[tag]], 8, "tables")
        for tag, size in _SIZED.items():
            if tag in dynamic:
                self._require_loaded([dynamic[tag]], dynamic.get(size, 0), "tables")
        for tag in _CODE:
            if tag in dynamic:
                self._require_loaded([dynamic[tag]], 1, "first and last functions", _EXECUTABLE)

    def _symbols(self) -> np.ndarray:
        """The dynamic symbols; how many there are, only the sections say."""
        for section in self._sections[self._sections["type"] == _SYMBOLS]:
            count = int(section["size"]) // _SYMBOL.itemsize
            return self._array(_SYMBOL, int(section["offset"]), count, "symbols")
        return np.zeros(0, _SYMBOL)

    def _check_symbols(self, symbols: np.ndarray, strings: int) -> None:
        if np.any(symbols["name"] >= strings):
            raise _DamageError("a symbol's name is none of its strings")
        defined = symbols[(symbols["index"] > 0) & (symbols["index"] < _COMMON)]
        defined = defined[defined["info"] & 15 != _THREAD]
        self._require_loaded(defined["value"], 0, "symbols")

    def _check_relocations(self, address: int, size: int, symbols: int) -> None:
        """Places that the loader writes are writable, and the symbols and addresses it takes are there."""
        load = next(s for s in self._loads if s["address"] <= address < s["address"] + s["memsz"])
        offset = address - int(load["address"]) + int(load["offset"])
        found = self._array(_RELOCATION, offset, size // _RELOCATION.itemsize, "relocations")
        self._require_loaded(found["offset"], 8, "relocations", _WRITABLE)
        if symbols and np.any(found["symbol"] >= symbols):
            raise _DamageError("a relocation is for a symbol that it does not have")
        relative = found[found["type"] == _RELATIVE.get(int(self._head["machine"]), 0)]
        self._require_loaded(relative["addend"].astype(np.uint64), 0, "relocations")

    def _require_loaded(self, addresses: Any, size: int, what: str, flag: int = 0) -> None:
        """Raise _DamageError where `size` bytes from one of the addresses on are not loaded with `flag`."""
        loads: Iterable[Any] = self._loads if not flag else self._loads[self._loads["flags"] & flag != 0]
        starts = np.asarray(addresses, np.uint64)
        inside = np.zeros(len(starts), bool)
        for load in loads:
            first, length = int(load["address"]), int(load["memsz"])
            if size <= length:
                inside |= (starts >= first) & (starts <= first + length - size)
        if not inside.all():
            raise _DamageError(f"its {what} lead out of what is loaded")
