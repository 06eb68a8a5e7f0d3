"""Results of a run, for Python."""

from __future__ import annotations

import html
import tempfile
import weakref
from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...modelkit.kernel.writing import discard
from ..common.errors import Ended, as_list
from ..quantities import Summary, summary_items
from ..scene.scene import Scene
from .final_state import FinalState, Finished
from .headline import headline
from .recording import Recording
from .table import result_table, shown_value

if TYPE_CHECKING:
    import pandas
    import xarray

RECORDING = "result.h5"


class Scratch:
    """A temporary folder, gone when nothing uses it any more."""

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix="touchdown_"))
        weakref.finalize(self, discard, self.path)


@dataclass(frozen=True, repr=False, eq=False)
class Result:
    """Results of a run.

    `summary` holds its quantities in SI, nested by seat, component and gap as `master.quantities` says;
    None where something did not happen. `flat` is the same with one path for each value.
    """

    scene: Scene
    recording: Recording  # stays open, and this run's, even where the file is replaced
    folder: Path  # a temporary one, for as long as the result is in use, where none was asked for
    summary: Summary
    ending: FinalState
    ended: Ended
    stopped_because: str = ""
    warnings: list[str] = field(default_factory=list)
    pictures: list[Path] = field(default_factory=list)

    @cached_property
    def data(self) -> xarray.Dataset:
        """All that was recorded: COMPONENT.VARIABLE over `time` (s from the scene's zero), in SI.

        Every variable has the attributes units and long_name, and is read when it is looked at.
        """
        from .dataset import run_dataset

        return run_dataset(self.recording)

    @property
    def flat(self) -> dict[str, Any]:
        """The summary with a path for each value, such as "seats.A.peak_contact_force"; SI."""
        return {item.path: item.of(self.summary) for item in summary_items(self.summary)}

    def to_pandas(self, names: str | Iterable[str] | None = None) -> pandas.DataFrame:
        """The recorded COMPONENT.VARIABLE, or only `names`, indexed by time (s), in SI; `attrs["units"]`.

        Raises TouchdownError for what was not recorded.
        """
        import pandas

        recording, units = self.recording, dict(self.recording.columns())
        columns = {name: recording.as_read(name) for name in (units if names is None else as_list(names))}
        frame = pandas.DataFrame(columns, pandas.Index(recording.time, name="time"))
        frame.attrs["units"] = {name: units[name] for name in columns}
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """`data`."""
        return self.data

    def __getstate__(self) -> dict[str, object]:
        """Pickled with its fields, without data that were looked at.

        Raises TouchdownError where its folder is a temporary one, gone with this result.
        """
        return {part.name: getattr(self, part.name) for part in fields(self)}

    @property
    def headline(self) -> str:
        """What the run fails by, or how near it comes to its limits, and whether the rotor whirls."""
        run = Finished(self.scene, self.ending, self.recording)
        return headline(run, self.summary, self.ended, self.stopped_because)

    def __repr__(self) -> str:
        return f"Result of {self.scene.name}. {self.headline}\n{result_table(self.summary)}"

    def _repr_html_(self) -> str:
        """For notebooks."""
        cells = "".join(
            f"<tr><th style='text-align: left'>{html.escape(item.head)}</th>"
            f"<td>{html.escape(shown_value(item, self.summary))}</td></tr>"
            for item in summary_items(self.summary)
        )
        return f"<p>{html.escape(self.headline)}</p><table>{cells}</table>"
