"""Progress over pieces of work, in a terminal or a notebook."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Generator
from contextlib import contextmanager
from threading import RLock
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, cast

if TYPE_CHECKING:
    from tqdm import tqdm


class Progress(NamedTuple):
    """Progress of work whose pieces become known on the way."""

    planned: Callable[[int], object]  # so many pieces more are to be done
    done: Callable[[], object]  # one of them is


def _nothing(*_: object) -> None:
    pass


SILENT_PROGRESS = Progress(_nothing, _nothing)


def bars() -> type[tqdm[NoReturn]]:
    """Bars for where they are shown: a terminal or a notebook."""
    with warnings.catch_warnings():
        # a notebook without widgets gets bars of text, and no warning about what it does not need
        warnings.filterwarnings("ignore", "IProgress not found")
        from tqdm.auto import tqdm
    if not hasattr(tqdm, "_lock"):  # tqdm's own is one of processes, which one that is killed leaves behind
        cast(Any, tqdm).set_lock(RLock())
    return tqdm


LINES = 20  # of a bar in a file, one for each part of it


class _Lines:
    """Stands in for a stderr that is a file, in which tqdm would write over what it wrote."""

    def write(self, text: str) -> None:
        if shown := text.strip():
            print(shown, file=sys.stderr)

    def flush(self) -> None:
        sys.stderr.flush()


def bar_of(total: float, quiet: bool, **how: Any) -> tqdm[NoReturn]:
    """A bar over `total`; in a file LINES lines."""
    kind = bars()
    in_notebook = any(one.__module__ == "tqdm.notebook" for one in kind.__mro__)
    if not quiet and not in_notebook and not sys.stderr.isatty():
        how |= {"file": _Lines(), "mininterval": 0.0, "maxinterval": math.inf, "miniters": total / LINES}
    return kind(total=total, disable=quiet, **how)


def bar_over(total: int, what: str, quiet: bool) -> tqdm[NoReturn]:
    """A bar over `total` pieces of work, all of them `what`; as a context."""
    return bar_of(total, quiet, desc=what, leave=False)


@contextmanager
def growing_bar(what: str, quiet: bool) -> Generator[Progress]:
    """A bar over pieces of work, all of them `what`, that grows when more of them are planned."""
    bar: tqdm[NoReturn] | None = None

    def plan(more: int) -> None:
        nonlocal bar
        if bar is None:  # none is shown before it is known that there is work
            bar = bar_over(more, what, quiet)
        else:
            bar.total += more
            if not quiet and bar.mininterval == 0.0:  # of lines
                bar.miniters = bar.total / LINES
            bar.refresh()

    def done() -> None:
        if bar is not None:
            bar.update()

    try:
        yield Progress(plan, done)
    finally:
        if bar is not None:
            bar.close()
