"""The state of a run between two macro steps: who holds some, and the file that keeps it for a later run.

Each holder gives its part as plain values and arrays (`Kept.save`) and takes it back (`Kept.load`); the
components give bytes. A snapshot is taken once, where a run ends. It may be loaded where the same scene was
initialised anew: what follows is the same to the bit as without an end between. A file is as trustworthy as
an FMU: bytes of components go into their memory.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ...modelkit.archives import Format, reading
from ...modelkit.kernel.writing import replacing
from ..common.errors import TouchdownError

Saved = dict[
    str, Any
]  # by name: None, Booleans, numbers, texts, bytes, arrays, and lists and such of these
DAMAGE = (KeyError, TypeError, ValueError, IndexError, AttributeError)


class Kept:
    """Holds some of a run's state, by default in the attributes named in `KEPT`."""

    KEPT: ClassVar[tuple[str, ...]] = ()

    def save(self) -> Saved:
        """All that its next steps depend on beside the scene."""
        return {name: getattr(self, name) for name in self.KEPT}

    def load(self, saved: Saved) -> None:
        """Go on from what `save` gave, arrays in place. Raises one of `DAMAGE` for what it cannot be."""
        for name in self.KEPT:
            present = getattr(self, name)
            if isinstance(present, np.ndarray):
                present[...] = saved[name]
            else:
                setattr(self, name, saved[name])


@dataclass(frozen=True)
class Resumed:
    """Where a run starts that goes on from another one's end."""

    folder: Path  # of that run
    state: Saved
    recording: Path
    tuned: Mapping[str, Mapping[str, float]]  # SI, by component: what is another than there


STATE_FORMAT = Format("a run's state", "tree.npy", "a run leaves it where it ends", "run the scene again")


def write_state(path: Path, saved: Saved) -> None:
    """Write it, without Python objects. Raises OSError."""
    arrays: list[np.ndarray] = []

    def plain(value: object) -> dict[str, int]:
        """Of what JSON does not have: where it stands among the arrays."""
        if isinstance(value, bytes):
            arrays.append(np.frombuffer(value, np.uint8))
            return {"bytes": len(arrays) - 1}
        arrays.append(np.asarray(value))
        assert not arrays[-1].dtype.hasobject, value  # which is no state, and would be pickled
        return {"array": len(arrays) - 1}

    tree = np.frombuffer(json.dumps(saved, default=plain).encode(), np.uint8)
    named: dict[str, Any] = {f"array_{i}": array for i, array in enumerate(arrays)}
    with replacing(path) as file:
        np.savez(file, tree=tree, **named)


def read_state(path: Path) -> Saved:
    """What `write_state` wrote. Raises TouchdownError where that cannot be read."""
    with reading(path, STATE_FORMAT) as (file, _):
        content = np.load(file, allow_pickle=False)

        def live(value: dict[str, Any]) -> Any:
            if value.keys() == {"array"}:
                return content[f"array_{value['array']}"]
            if value.keys() == {"bytes"}:
                return content[f"array_{value['bytes']}"].tobytes()
            return value

        try:
            return {**json.loads(content["tree"].tobytes(), object_hook=live)}
        except DAMAGE:
            raise TouchdownError(f"{path} is not {STATE_FORMAT.name}; {STATE_FORMAT.remedy}") from None
