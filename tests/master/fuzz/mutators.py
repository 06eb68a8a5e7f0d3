"""Seeded damage to texts and archives: what people mistype, what disks break, what is hostile."""

from __future__ import annotations

import io
import json
import re
import struct
import zipfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np

Rng = np.random.Generator

DEEP = 3000  # brackets within each other; more than Python's stack takes
NUMBERS = (
    *("0", "-0.0", "-1", "1", "3", "0.5", "1e-300", "5e-324", "1e9", "1e18", "1e308", "-1e308"),
    *("nan", "inf", "-inf", "1" + 400 * "0", "1" + 5000 * "0", "9223372036854775808"),
)
WORDS = (
    *(
        "", " ", "wide", "true", "None", "%s{0}", "$(id)", "é µ 零", "a\tb", "\U0001f600", "-", "--",
        "x" * 9999,
    ),
    *("time", "at_end", "run", "interface", "hold", "6004", "9000 rpm", "0.3 mm", "1 furlong", "1e400 mm"),
    *("/dev/full", "/dev/zero", "/dev/null", "/", "..", "../../etc/passwd", "nosuch.fmu", "nosuch.toml"),
)  # fmt: skip
UNPRINTED = ("a\0b", "\0", "a\0b.fmu", "a\0b.toml", "\x7f\x1b[31m", "\u202e", "\ud800")
"""Texts that reach a program from a file or another program rather than from a shell."""


def pick(rng: Rng, given: Sequence[str]) -> str:
    """One of them."""
    return given[int(rng.integers(len(given)))]


def value(rng: Rng) -> str:
    """What stands for a setting on a command line: half of the time a number of any size."""
    if rng.random() < 0.5:
        return _any_size(rng)
    return pick(rng, NUMBERS if rng.random() < 0.6 else WORDS)


def _any_size(rng: Rng) -> str:
    """A number that may be right, too."""
    return f"{rng.choice((-1, 1), p=(0.1, 0.9)) * 10.0 ** rng.uniform(-9.0, 9.0):.{rng.integers(1, 6)}g}"


# -- TOML ---------------------------------------------------------------------------------------------


def _literal(rng: Rng) -> str:
    """A value of TOML, of any kind, not always valid."""
    chosen = int(rng.integers(10))
    if chosen > 7:
        return _any_size(rng)
    if chosen < 2:
        return pick(rng, NUMBERS)
    if chosen < 5:
        return _quoted(pick(rng, (*WORDS, *UNPRINTED[:-1], *(f"{n} mm" for n in NUMBERS))))
    if chosen == 5:
        return pick(rng, (DEEP * "[" + DEEP * "]", DEEP * "{a=" + "1" + DEEP * "}", "[[[]]]", "{}", "[]"))
    if chosen == 6:
        return pick(rng, ('["a", "b"]', '[["a.b", "c.d"]]', '[["a.b", 1]]', "{a = {b = 1}}", "[1, nan]"))
    return pick(rng, ("true", "1979-05-27T07:32:00Z", "07:32:00", "0x10", "'''", '"""', "=", ""))


def _quoted(text: str) -> str:
    special = {"\\": "\\\\", '"': '\\"'}
    return '"' + "".join(special.get(c, c if c.isprintable() else f"\\u{ord(c):04x}") for c in text) + '"'


def _scaled(rng: Rng, lines: list[str]) -> None:
    """One of the numbers is larger or smaller."""
    at = _one_with(rng, lines, " = ")
    key, _, rest = lines[at].partition(" = ")
    scale = 10.0 ** rng.uniform(-6.0, 6.0)
    lines[at] = f"{key} = " + re.sub(
        r"\d+(\.\d+)?", lambda found: f"{scale * float(found[0]):.6g}", rest, count=1
    )


def _another_value(rng: Rng, lines: list[str]) -> None:
    at = _one_with(rng, lines, " = ")
    key = lines[at].partition(" = ")[0]
    lines[at] = f"{key} = {_literal(rng)}"


def _another_key(rng: Rng, lines: list[str]) -> None:
    at = _one_with(rng, lines, " = ")
    name = _quoted(pick(rng, (*WORDS, *UNPRINTED[:-1])))
    lines[at] = f"{name} = {lines[at].partition(' = ')[2]}"


def _another_table(rng: Rng, lines: list[str]) -> None:
    at = _one_with(rng, lines, "[")
    names = (
        "time", "at_end", "run", "components", "a.b", '"a\\u0000b"', '"a/b"', '""', '"x.y"', "stations",
    )  # fmt: skip
    inner = lines[at].strip("[] \t").split(".")
    inner[int(rng.integers(len(inner)))] = pick(rng, names)
    lines[at] = f"[{'.'.join(inner)}]"


def _added(rng: Rng, lines: list[str]) -> None:
    deep = "[" + ".".join(DEEP * ["a"]) + "]"
    lines.insert(
        int(rng.integers(len(lines) + 1)), pick(rng, (deep, f"x = {_literal(rng)}", "[x]", "\0", "[["))
    )


def _one_with(rng: Rng, lines: Sequence[str], what: str) -> int:
    having = [i for i, line in enumerate(lines) if what in line] or [0]
    return having[int(rng.integers(len(having)))]


# -- any text ----------------------------------------------------------------------------------------------


def _dropped(rng: Rng, lines: list[str]) -> None:
    del lines[int(rng.integers(len(lines)))]


def _doubled(rng: Rng, lines: list[str]) -> None:
    at = int(rng.integers(len(lines)))
    lines.insert(at, lines[at])


def _swapped(rng: Rng, lines: list[str]) -> None:
    a, b = rng.integers(len(lines), size=2)
    lines[a], lines[b] = lines[b], lines[a]


def _apply(rng: Rng, text: str, ways: Sequence[Callable[[Rng, list[str]], None]]) -> str:
    lines = text.splitlines()
    for _ in range(int(rng.integers(1, 3))):
        ways[int(rng.integers(len(ways)))](rng, lines)
        lines = lines or [""]
    return "\n".join(lines) + "\n"


LINES = (_dropped, _doubled, _swapped)
TOML = (*(3 * (_another_value,)), *(3 * (_scaled,)), *(2 * (_another_table,)), _another_key, _added, *LINES)


def toml(rng: Rng, text: str) -> bytes:
    """A TOML file like `text`, damaged."""
    damaged = _apply(rng, text, TOML).encode("utf-8", "surrogatepass")
    return flipped(rng, damaged) if rng.random() < 0.1 else damaged


# -- XML ---------------------------------------------------------------------------------------------------

DOCTYPE = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
ENCODINGS = ("utf-16", "utf-16-le", "utf-32", "latin-1", "cp037")


def _another_attribute(rng: Rng, lines: list[str]) -> None:
    at = _one_with(rng, lines, '="')
    parts = lines[at].split('"')
    held = range(1, len(parts), 2)  # what stands between quotes
    if held:
        one = held[int(rng.integers(len(held)))]
        parts[one] = pick(
            rng,
            (_any_size(rng), *NUMBERS, *(w for w in WORDS if "&" not in w and "<" not in w), "&b;", "&#0;"),
        )
        lines[at] = '"'.join(parts)


def _declared(rng: Rng, lines: list[str]) -> None:
    lines.insert(min(1, len(lines)), DOCTYPE)


def _nested(rng: Rng, lines: list[str]) -> None:
    deep = 20 * DEEP
    lines.insert(int(rng.integers(len(lines) + 1)), deep * "<a>" + deep * "</a>")


XML = (*(5 * (_another_attribute,)), _declared, _nested, *LINES)


def xml(rng: Rng, text: str) -> bytes:
    """An XML file like `text`, damaged, now and then in another encoding."""
    damaged = _apply(rng, text, XML)
    if rng.random() < 0.15:
        encoding = pick(rng, ENCODINGS)
        return damaged.replace("UTF-8", encoding, 1).encode(encoding, "replace")
    content = damaged.encode("utf-8", "surrogatepass")
    return flipped(rng, content) if rng.random() < 0.1 else content


# -- JSON and tables of cells --------------------------------------------------------------------------

DEEP_LIST = DEEP * "[" + DEEP * "]"
VALUES = (
    *("null", "true", '"x"', '""', "3", "-1", "1e308", "1e999", "NaN", "[]", "{}", "[[1, 2]]", "[null]"),
    *('{"a": null}', "1" + 400 * "0", DEEP_LIST, '"\\u001b]0;x\\u0007\\u202e"', '"../../x"', '"a\\u0000b"'),
)


def json_text(rng: Rng, text: str) -> bytes:
    """JSON like `text` with a value that is another, or missing, or with bytes flipped."""
    if rng.random() < 0.2:
        return flipped(rng, text.encode())
    data = json.loads(text)
    place = data
    while isinstance(place, dict | list) and len(place):
        keys = list(place) if isinstance(place, dict) else range(len(place))
        key = keys[int(rng.integers(len(keys)))]
        if rng.random() < 0.3 or not isinstance(place[key], dict | list) or not place[key]:
            if rng.random() < 0.2:
                del place[key]
                return json.dumps(data).encode()
            place[key] = MARK
            return json.dumps(data).replace(f'"{MARK}"', pick(rng, VALUES)).encode()
        place = place[key]
    return pick(rng, VALUES).encode()


MARK = "here stands another value"
CELLS = (*NUMBERS, *WORDS[:12], '"', '"a', '"' + 300_000 * "x" + '"', "=1+1", ",,,", ";", "\t", "\r", "\0")


def _another_cell(rng: Rng, lines: list[str]) -> None:
    at = int(rng.integers(len(lines)))
    cells = lines[at].split(",")
    cells[int(rng.integers(len(cells)))] = pick(rng, CELLS)
    lines[at] = ",".join(cells)


def table(rng: Rng, text: str) -> bytes:
    """A table of cells like `text`, damaged."""
    damaged = _apply(rng, text, (*(3 * (_another_cell,)), *LINES)).encode("utf-8", "surrogatepass")
    return flipped(rng, damaged) if rng.random() < 0.15 else damaged


# -- arrays --------------------------------------------------------------------------------------------

HEADS = (
    "{'descr': '<f8'", "[]", "1", "", 9999 * "(",
    "{'descr': '|O', 'fortran_order': False, 'shape': (2,), }",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }",
    "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (2,), }",
)  # fmt: skip


def arrays(rng: Rng, held: Mapping[str, np.ndarray]) -> bytes:
    """An archive of arrays like `held`, damaged."""
    chosen, name = rng.random(), pick(rng, list(held))
    if chosen < 0.4:
        others = (
            held[name],
            np.zeros(0),
            np.zeros((3, 3)),
            np.array("x"),
            np.full(4, np.nan),
            np.array([1e308]),
        )
        held = {**held, name: others[int(rng.integers(len(others)))]}
    elif chosen < 0.5:
        held = {key: value for key, value in held.items() if key != name}
    content = io.BytesIO()
    np.savez_compressed(content, allow_pickle=False, **dict(held))
    if chosen < 0.7:
        return content.getvalue() if chosen < 0.5 else flipped(rng, content.getvalue())
    with zipfile.ZipFile(content) as source:
        entries = {one: source.read(one) for one in source.namelist()}
    if chosen < 0.85:
        head = pick(rng, HEADS).encode() + b"\n"
        entries[f"{name}.npy"] = b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head + bytes(64)
        return archive(entries)
    packed = io.BytesIO()
    method = (zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2)[int(rng.integers(2))]
    with zipfile.ZipFile(packed, "w", method) as into:
        for one, data in entries.items():
            into.writestr(one, data)
    return flipped(rng, packed.getvalue()) if chosen < 0.95 else packed.getvalue()


def recording(rng: Rng, path: Path) -> None:
    """Damage an HDF5 file in its place: a column that is something else, or bytes flipped."""
    if rng.random() < 0.3:
        path.write_bytes(flipped(rng, path.read_bytes()))
        return
    with h5py.File(path, "r+") as file:
        group = file[pick(rng, [name for name in file if isinstance(file[name], h5py.Group)])]
        name = pick(rng, list(group) or list(group.attrs) or ["none"])
        rows = len(file["time"])
        if rng.random() < 0.2:
            group, name = file, "time"
        if rng.random() < 0.15:
            group.get(name, group).attrs[pick(rng, ("units", "long_name", "title", name))] = pick(
                rng, UNPRINTED[4:6]
            )
            return
        before = dict(group[name].attrs) if name in group else {}
        if isinstance(group.get(name), h5py.Dataset) and rng.random() < 0.2:
            group[name][...] = (np.inf, np.nan, 1e308, 0.0)[int(rng.integers(4))]
            return
        if name in group:
            del group[name]
        elsewhere = path.with_name("elsewhere.h5")
        others = (
            ["a"] * rows, np.zeros((rows, 3)), np.zeros(0), np.zeros(rows, [("a", "f8")]),
            np.zeros(rows + 1), np.zeros(rows, complex), np.array(3.0),
            h5py.SoftLink(f"/{name}"), h5py.SoftLink("/nowhere"),
            h5py.ExternalLink(str(elsewhere), "/x"),
        )  # fmt: skip
        chosen = int(rng.integers(len(others) + 3))
        if chosen < len(others):
            group[name] = others[chosen]
        elif chosen == len(others):
            group.create_dataset(name, (rows,), "f8", external=[(str(elsewhere), 0, 8 * rows)])
        elif chosen == len(others) + 1:
            group.create_dataset(name, (10**10,), "f8", chunks=(10**6,), compression="gzip")
        if name in group and chosen not in (7, 8, 9):
            group[name].attrs.update({key: before[key] for key in ("units", "long_name") if key in before})


# -- bytes -------------------------------------------------------------------------------------------------


def flipped(rng: Rng, content: bytes) -> bytes:
    """A few bytes are others, or the end is missing."""
    if not content:
        return content
    if rng.random() < 0.3:
        return content[: int(rng.integers(len(content)))]
    changed = bytearray(content)
    for _ in range(int(rng.integers(1, 6))):
        changed[int(rng.integers(len(changed)))] = int(rng.integers(256))
    return bytes(changed)


def archive(content: Mapping[str, bytes], stored: bool = False) -> bytes:
    """A ZIP archive of files by name."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED if stored else zipfile.ZIP_DEFLATED) as into:
        for name, data in content.items():
            into.writestr(name, data)
    return packed.getvalue()


def damaged_archive(rng: Rng, content: Mapping[str, bytes], heart: str) -> bytes:
    """An archive like `content` with its `heart` damaged, an entry less or more, or bytes flipped."""
    chosen = rng.random()
    files = dict(content)
    if chosen < 0.5:
        files[heart] = xml(rng, files[heart].decode())
        return archive(files)
    if chosen < 0.6:
        del files[pick(rng, list(files))]
        return archive(files)
    if chosen < 0.7:
        name = pick(
            rng, ("../out", "/abs", "a:b", "x\\y", "/", "dir/", heart.upper(), 300 * "n", 99 * "d/")
        )
        return archive(files | {name: b"x"})
    return flipped(rng, archive(files, stored=chosen < 0.85))
