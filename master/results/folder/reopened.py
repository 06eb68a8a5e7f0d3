"""A run read back from its folder."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from touchdown.master.common.ended import Ended
from touchdown.master.common.errors import TouchdownError
from touchdown.master.results.folder import ENDING, SCENE, SUMMARY
from touchdown.master.results.folder.ending import read_ending
from touchdown.master.results.recording import Recording
from touchdown.master.results.result import RECORDING, Result
from touchdown.master.scene.file import SCENE_FILE
from touchdown.master.scene.restored import restored
from touchdown.master.scene.tables import is_scene_file


def reopened(folder: Path) -> Result:
    """What a run left in `folder`, as `run_scene` returned it, without its pictures.

    Raises TouchdownError where there is no run, it was killed or goes on, or another version left it.
    """
    if os.path.isfile(folder):
        if is_scene_file(folder) and not (folder.parent / SUMMARY).exists():
            raise TouchdownError(
                f"{folder} is a scene; `touchdown run {folder}` first, and give the folder it names"
            )
        raise TouchdownError(f"{folder} is a file; give the folder that it lies in, {folder.parent}")
    if not os.path.isdir(folder):
        raise TouchdownError(f"there is no folder {folder}; give the one that `touchdown run` wrote to")
    if (folder / SCENE_FILE).is_file() and not (folder / SUMMARY).exists():
        raise TouchdownError(
            f"{folder} is a machine's folder; `touchdown run {folder}` first, and give the folder it names"
        )
    runs = sorted(path.parent for path in folder.glob(f"*/{SUMMARY}"))
    if runs and not (folder / SUMMARY).exists():
        raise TouchdownError(
            f"{folder} is no run's folder, it holds {len(runs)} of them; give one, such as {runs[0]}"
        )
    summary = _values(folder, SUMMARY, "it is no run's, or its run was killed or goes on")
    told = _values(folder, ENDING, "an earlier version left it; run the scene again")
    scene = _values(folder, SCENE, "run the scene again")
    if not (folder / RECORDING).is_file():
        raise TouchdownError(f"{folder / RECORDING} is missing; run the scene again")
    try:
        ending, warnings = read_ending(told)
        ran = restored(scene)
        if ran.components.keys() != ending.components.keys():
            raise ValueError(f"{SCENE} has other components than {ENDING}")
        return Result(
            ran,
            Recording(folder / RECORDING),
            folder,
            summary,
            ending,
            Ended(summary["ended"]),
            summary.get("stopped_because", ""),
            warnings,
        )
    except TouchdownError as error:
        raise TouchdownError(f"{folder}: {error}") from None
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise TouchdownError(
            f"{folder} is not as a run leaves it ({type(error).__name__}: {error}); run the scene again"
        ) from None


def _values(folder: Path, name: str, lacking: str) -> dict[str, Any]:
    """Of a file of the folder; `lacking`: why there may be none. Raises TouchdownError."""
    try:
        values = json.loads((folder / name).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise TouchdownError(f"{folder} has no {name}: {lacking}") from None
    except OSError as error:
        raise TouchdownError(f"cannot read {folder / name}: {error.strerror}") from None
    except ValueError as error:
        raise TouchdownError(f"{folder / name} is no JSON: {error}") from None
    if not isinstance(values, dict):
        raise TouchdownError(f"{folder / name} is not as a run leaves it; run the scene again")
    return values
