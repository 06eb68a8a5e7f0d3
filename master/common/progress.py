"""Progress over pieces of work, in a terminal or a notebook."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from tqdm import tqdm


def bar_over(total: int, what: str, quiet: bool) -> tqdm[NoReturn]:
    """A bar over `total` pieces of work, all of them `what`; as a context."""
    from tqdm.auto import tqdm

    return tqdm(total=total, desc=what, disable=quiet, leave=False)


@contextmanager
def named_progress(total: int, quiet: bool) -> Generator[Callable[[str], None]]:
    """A bar over pieces of work of many kinds: call what it gives with the name of each as it begins."""
    begun = 0
    with bar_over(total, "", quiet) as bar:

        def begin(what: str) -> None:
            nonlocal begun
            bar.update(1 if begun else 0)
            begun += 1
            bar.set_description(what)

        yield begin
