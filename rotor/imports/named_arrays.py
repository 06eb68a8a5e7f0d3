"""Named arrays of an imported file, each mistake said in one line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from ...modelkit.errors import TouchdownError, one_of
from ..beams.superelement import by


@dataclass(frozen=True)
class Given:
    """Data of an imported file, and the file's name for messages."""

    file: str
    data: Mapping[str, Any]

    def error(self, says: str) -> TouchdownError:
        """The error to raise."""
        return TouchdownError(f"{self.file}: {says}")

    def require(self, holds: object, says: str) -> None:
        """Raise the error unless the condition holds."""
        if not holds:
            raise self.error(says)

    def only(self, *known: str) -> None:
        """Raises TouchdownError for the first name that is not known."""
        for name in self.data:
            if name not in known:
                raise self.error(f"{name} is not known; {one_of(str(name), known)}")

    def has(self, name: str) -> bool:
        """Whether it is there."""
        return self.data.get(name) is not None

    def names(self, name: str) -> np.ndarray:
        """Texts, or whole numbers as texts, at least one row of them. Raises TouchdownError."""
        values = np.atleast_1d(np.asarray(self.data[name]))
        if values.dtype.kind == "f" and np.all(values == np.round(values)):
            values = values.astype(int)
        self.require(values.dtype.kind in "iuUS", f"{name} must be an array of texts or whole numbers")
        return values.astype(str)

    def numbers(self, name: str, *sizes: tuple[int, ...]) -> np.ndarray:
        """Finite real numbers as one of `sizes`, any where none is given.

        Raises TouchdownError, also where they are missing.
        """
        self.require(self.has(name), f"{name} is missing")
        try:
            values = self.data[name]
            values = np.asarray(values.toarray() if sparse.issparse(values) else values)
            if values.dtype.kind not in "iuf":
                raise TypeError
            values = values.astype(float)
        except (TypeError, ValueError):
            raise self.error(f"{name} must be an array of real numbers") from None
        if sizes and values.shape not in sizes:
            required = " or ".join(by(size) for size in sizes)
            raise self.error(f"{name} is {by(values.shape)}; it must be {required}")
        if not np.all(np.isfinite(values)):
            where = ", ".join(str(i + 1) for i in np.argwhere(~np.isfinite(values))[0])
            raise self.error(f"{name} holds what is not a finite number, first at [{where}]")
        return values
