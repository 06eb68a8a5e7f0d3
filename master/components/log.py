"""The messages of an FMU: its logger, in compiled code, and the memory that it writes into.

An FMU may log from its threads while a call waits for them, without limit. So the logger
takes no lock of Python and allocates nothing: it counts by status and category, and keeps the last few
messages, cut to a length. FMI 2.0's logger is a printf: the message is a format, the arguments follow.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

STATUSES = 7  # FMI's six, and any other
KEPT = 16  # messages
CATEGORIES = 16  # that are counted; messages of further ones are kept, too
NAME, TEXT = 64, 1024  # bytes of a category and of a message, the ending zero included
OK, WARNING, OTHER = 0, 1, 6  # places of statuses

_CATEGORY = np.dtype([("count", "i8"), ("name", f"S{NAME}")])
_MESSAGE = np.dtype([("number", "i8"), ("status", "i8"), ("category", f"S{NAME}"), ("text", f"S{TEXT}")])
LOG = np.dtype(
    [
        ("total", "i8"),  # messages that are kept: all but those of OK
        ("by_status", "i8", STATUSES),
        ("categories", "i8"),
        ("category", _CATEGORY, CATEGORIES),
        ("message", _MESSAGE, KEPT),
    ]
)
_AT = {"categories": 8 + 8 * STATUSES, "category": 16 + 8 * STATUSES}  # bytes
_AT["message"] = _AT["category"] + CATEGORIES * _CATEGORY.itemsize

# In LLVM's language, since nothing that llvmlite compiles from Python has variable arguments.
_CODE = f"""
declare void @llvm.va_start(i8*)
declare void @llvm.va_end(i8*)
declare i32 @vsnprintf(i8*, i64, i8*, i8*)
declare i32 @strncmp(i8*, i8*, i64)
declare i8* @strncpy(i8*, i8*, i64)
declare i8* @strstr(i8*, i8*)
@nothing = private constant [1 x i8] zeroinitializer
@writes = private constant [3 x i8] c"%n\\00"

; counts a message, and gives the place for its text; null where none is kept, or no log is named
define private i8* @noted(i8* %log, i32 %status, i8* %said) {{
begin:
  %whose = icmp eq i8* %log, null
  br i1 %whose, label %nothing, label %count
count:
  %unsaid = icmp eq i8* %said, null
  %category = select i1 %unsaid, i8* getelementptr ([1 x i8], [1 x i8]* @nothing, i64 0, i64 0), i8* %said
  %total = bitcast i8* %log to i64*
  %by_status = getelementptr i64, i64* %total, i64 1
  %wide = sext i32 %status to i64
  %known = icmp ult i64 %wide, {OTHER}
  %which = select i1 %known, i64 %wide, i64 {OTHER}
  %times = getelementptr i64, i64* %by_status, i64 %which
  %0 = atomicrmw add i64* %times, i64 1 monotonic
  %told = icmp ne i64 %wide, {OK}
  br i1 %told, label %number, label %nothing
nothing:
  ret i8* null
number:
  %mine = atomicrmw add i64* %total, i64 1 monotonic
  %categories = getelementptr i64, i64* %total, i64 {_AT["categories"] // 8}
  br label %look
look:
  %i = phi i64 [0, %number], [%next, %another]
  %used = load atomic i64, i64* %categories acquire, align 8
  %offset = mul i64 %i, {_CATEGORY.itemsize}
  %place = add i64 %offset, {_AT["category"]}
  %entry = getelementptr i8, i8* %log, i64 %place
  %name = getelementptr i8, i8* %entry, i64 8
  %there = icmp ult i64 %i, %used
  br i1 %there, label %compare, label %new
compare:
  %differs = call i32 @strncmp(i8* %name, i8* %category, i64 {NAME - 1})
  %same = icmp eq i32 %differs, 0
  br i1 %same, label %found, label %another
another:
  %next = add i64 %i, 1
  br label %look
new:
  %room = icmp ult i64 %i, {CATEGORIES}
  br i1 %room, label %add, label %keep
add:
  %1 = call i8* @strncpy(i8* %name, i8* %category, i64 {NAME - 1})
  %more = add i64 %i, 1
  store atomic i64 %more, i64* %categories release, align 8
  br label %found
found:
  %of_category = bitcast i8* %entry to i64*
  %2 = atomicrmw add i64* %of_category, i64 1 monotonic
  br label %keep
keep:
  %turn = urem i64 %mine, {KEPT}
  %along = mul i64 %turn, {_MESSAGE.itemsize}
  %start = add i64 %along, {_AT["message"]}
  %slot = getelementptr i8, i8* %log, i64 %start
  %numbers = bitcast i8* %slot to i64*
  store i64 %mine, i64* %numbers
  %second = getelementptr i64, i64* %numbers, i64 1
  store i64 %wide, i64* %second
  %its_category = getelementptr i8, i8* %slot, i64 16
  %3 = call i8* @strncpy(i8* %its_category, i8* %category, i64 {NAME - 1})
  %text = getelementptr i8, i8* %slot, i64 {16 + NAME}
  store i8 0, i8* %text
  ret i8* %text
}}

define void @fmi3_logger(i8* %log, i32 %status, i8* %category, i8* %message) {{
  %text = call i8* @noted(i8* %log, i32 %status, i8* %category)
  %quiet = icmp eq i8* %text, null
  %no_message = icmp eq i8* %message, null
  %silent = or i1 %quiet, %no_message
  br i1 %silent, label %done, label %copy
copy:
  %1 = call i8* @strncpy(i8* %text, i8* %message, i64 {TEXT - 1})
  br label %done
done:
  ret void
}}

define void @plain_logger(i8* %log, i8* %instance, i32 %status, i8* %category, i8* %message) {{
  call void @fmi3_logger(i8* %log, i32 %status, i8* %category, i8* %message)
  ret void
}}

; copies the format unchanged where it would write to an argument (%n), or is null
define void @fmi2_logger(i8* %log, i8* %instance, i32 %status, i8* %category, i8* %format, ...) {{
  %no_format = icmp eq i8* %format, null
  br i1 %no_format, label %plain, label %look
look:
  %found = call i8* @strstr(i8* %format, i8* getelementptr ([3 x i8], [3 x i8]* @writes, i64 0, i64 0))
  %harmless = icmp eq i8* %found, null
  br i1 %harmless, label %note, label %plain
plain:
  call void @fmi3_logger(i8* %log, i32 %status, i8* %category, i8* %format)
  ret void
note:
  %text = call i8* @noted(i8* %log, i32 %status, i8* %category)
  %quiet = icmp eq i8* %text, null
  br i1 %quiet, label %done, label %print
print:
  %arguments = alloca [32 x i8], align 16
  %list = bitcast [32 x i8]* %arguments to i8*
  call void @llvm.va_start(i8* %list)
  %1 = call i32 @vsnprintf(i8* %text, i64 {TEXT}, i8* %format, i8* %list)
  call void @llvm.va_end(i8* %list)
  br label %done
done:
  ret void
}}
"""


class _Compiled:
    """The loggers, for as long as the process lives."""

    def __init__(self) -> None:
        llvm: Any = import_module("llvmlite.binding")
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        machine = llvm.Target.from_default_triple().create_target_machine()
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(_CODE), machine)
        self._engine.finalize_object()
        self.addresses: dict[str, int] = {
            name: self._engine.get_function_address(f"{name}_logger") for name in LOGGERS
        }


LOGGERS = "fmi2", "plain", "fmi3"
compiled = cache(_Compiled)


class _Message(NamedTuple):
    """A message of an FMU."""

    status: int
    category: str
    text: str


class FmuLog:
    """The messages of one instance, which its logger writes while it lives."""

    def __init__(self) -> None:
        self._memory = np.zeros((), LOG)
        self.address = self._memory.ctypes.data

    def __iter__(self) -> Iterator[_Message]:
        """The last messages that are more than OK, the newest last."""
        held = self._memory["message"]
        for slot in held[np.argsort(held["number"], kind="stable")]:
            if slot["status"] != OK:
                category, text = (  # after the zero stands the rest of an earlier, longer one
                    slot[key].partition(b"\0")[0].decode("utf-8", "replace").strip()
                    for key in ("category", "text")
                )
                yield _Message(int(slot["status"]), category, text)

    @property
    def categories(self) -> dict[str, int]:
        """How many messages, those of OK left out, each category has."""
        found = self._memory["category"][: int(self._memory["categories"])]
        return {entry["name"].decode("utf-8", "replace"): int(entry["count"]) for entry in found}

    def warned(self) -> str:
        """A line on the warnings: their number and the text of the last one; "" without warnings."""
        count = int(self._memory["by_status"][WARNING])
        last = [one for one in self if one.status == WARNING and one.text]
        if not count:
            return ""
        times = "once" if count == 1 else f"{count} times"
        words = f": {one_line(last[-1].text)}" if last else ""
        return f"its FMU warned {times}{words}"


WORDS = 200  # characters of a message that are shown


def one_line(text: str) -> str:
    """The words of a message as one line, cut where it is long."""
    line = " ".join(text.split())
    return line if len(line) <= WORDS else f"{line[:WORDS]}..."


def allocators() -> tuple[int, int]:
    """Addresses of C's calloc and free, which FMUs of FMI 2.0 are handed."""
    library = ctypes.CDLL("msvcrt" if os.name == "nt" else None)
    return tuple(
        ctypes.cast(getattr(library, name), ctypes.c_void_p).value or 0 for name in ("calloc", "free")
    )  # type: ignore[return-value]
