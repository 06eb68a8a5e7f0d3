"""Two changes to pythonfmu's library in an FMU: the log category of a refused call, and its status.

Log lines without a category have an empty one. For the category of its own lines, those of a call that is
refused, pythonfmu's library gives the host a null pointer. FMI knows no such thing, and a host that makes a
string of it ends there: OMSimulator is aborted. The empty text that the category is would do. So in the
FMU's copy of the library the place that hands a line on no longer tells an empty category from others, and
the one that does so itself, because it knows the category to be empty, goes through that place.

Wrong calls are answered by fmi2Error. pythonfmu's library answers every exception of a slave by fmi2Fatal,
after which a host may neither reset nor free an instance of the FMU. It throws a type of its own, which it
catches apart from other runtime errors; those it answers by fmi2Error. In the FMU's copy of the library
the exception is thrown as its base, `std::runtime_error`, which has the same size and the same text: one
relocation, of the one place that throws.

All else in the library stays unchanged.
"""

from __future__ import annotations

import re
import struct

_CHANGES = (  # code in parts, of which the middle one is replaced
    (
        rb"(\x48\x83\x7a\x08\x00\x4c\x8b\x10)"  # cmpq $0,8(%rdx); mov (%rax),%r10
        rb"\x74\x03"  # je, past what follows
        rb"(\x48\x8b\x0a)",  # mov (%rdx),%rcx
        b"\x66\x90",  # nop
    ),
    (
        rb"(\x48\x39\xd0)"  # cmp %rdx,%rax
        rb"\x0f\x85"  # jne
        rb"(....\x4c\x8b\x4d\x48\x48\x8b\x75\x10\x31\xc9)",  # to; mov; mov; xor %ecx,%ecx
        b"\x90\xe9",  # nop; jmp
    ),
)


def with_categories(library: bytes) -> bytes:
    """A pythonfmu library for Linux on x86-64 that gives every log line a category.

    Any other library, or one compiled otherwise, is returned unchanged.
    """
    changed = library
    for code, instead in _CHANGES:
        found = list(re.finditer(code, changed, re.DOTALL))
        if len(found) != 1:
            return library
        changed = changed[: found[0].end(1)] + instead + changed[found[0].start(2) :]
    return changed


EXCEPTION_TYPE = b"_ZTIN9pythonfmu11fatal_errorE"  # as the compiler names types
EXCEPTION_BASE = b"_ZTISt13runtime_error"
_SECTION = struct.Struct("<2I4Q2I2Q")  # of a table of sections: name, type, ..., offset, size, link, ...
_SYMBOL = struct.Struct("<I2BH2Q")
_RELOCATION = struct.Struct("<QQq")  # place, symbol and type, addend
_GLOB_DAT = 6  # on x86-64: the address of a symbol, for code
_DYNSYM, _RELA = 11, 4


def with_errors(library: bytes) -> bytes:
    """A pythonfmu library for Linux on x86-64 with the type it throws replaced.

    Any other library, or one that throws in another way, is returned unchanged.
    """
    if library[:6] != b"\x7fELF\x02\x01" or library[18:20] != b"\x3e\0":  # 64 bits, for x86-64
        return library
    (table,) = struct.unpack_from("<Q", library, 40)
    size, count = struct.unpack_from("<2H", library, 58)
    sections = [_SECTION.unpack_from(library, table + i * size) for i in range(count)]
    tables = [s for s in sections if s[1] == _DYNSYM]
    names = _names(library, tables[0], sections[tables[0][6]]) if tables else []
    if EXCEPTION_TYPE not in names or EXCEPTION_BASE not in names:
        return library
    thrown = names.index(EXCEPTION_TYPE) << 32 | _GLOB_DAT
    base = names.index(EXCEPTION_BASE) << 32 | _GLOB_DAT
    changed = bytearray(library)
    for section in (s for s in sections if s[1] == _RELA):
        for offset in range(section[4], section[4] + section[5], _RELOCATION.size):
            place, info, addend = _RELOCATION.unpack_from(library, offset)
            if info == thrown:
                _RELOCATION.pack_into(changed, offset, place, base, addend)
    return bytes(changed)


def _names(library: bytes, symbols: tuple[int, ...], texts: tuple[int, ...]) -> list[bytes]:
    """Names of the dynamic symbols, in order."""
    text = library[texts[4] : texts[4] + texts[5]]
    starts = (s[0] for s in _SYMBOL.iter_unpack(library[symbols[4] : symbols[4] + symbols[5]]))
    return [text[start : text.index(b"\0", start)] for start in starts]
