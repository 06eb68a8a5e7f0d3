"""Log lines without a category have an empty one.

For the category of its own lines, those of a call that is refused, pythonfmu's library gives the host a
null pointer. FMI knows no such thing, and a host that makes a string of it ends there: OMSimulator is
aborted. The empty text that the category is would do. So in the FMU's copy of the library the place that
hands a line on no longer tells an empty category from others, and the one that does so itself, because it
knows the category to be empty, goes through that place. All else stays as it is.
"""

from __future__ import annotations

import re

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

    A library that is none of these, or was compiled otherwise, is returned as it is.
    """
    changed = library
    for code, instead in _CHANGES:
        found = list(re.finditer(code, changed, re.DOTALL))
        if len(found) != 1:
            return library
        changed = changed[: found[0].end(1)] + instead + changed[found[0].start(2) :]
    return changed
