"""Whether recordings are equal to the bit: of a scene in three ways, and of two versions of the project.

    python benchmarks/recordings.py [--scenes a,b] [--duration "12 ms"] [--ways in-process,python,native]
                                    [-o runs/recordings.json] [--against before.json]

Every shipped scene is run in each way: its models in process, as FMUs in Python, as native FMUs. `-o` keeps
a digest of each recorded column, of the first way. `--against` compares them with what another version
kept: columns that differ, that are new, that are gone. The exit status is 1 where a column differs.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np

import touchdown
from touchdown.master.scene.file import shipped_scenes

WAYS = {"in-process": {"in_process": True}, "python": {}, "native": {"native": True}}
Digests = Mapping[str, str]  # by the names of columns


def digests(name: str, duration: str, way: str) -> Digests:
    """Of all columns of a scene's recording, by a `way` of `WAYS`; the scene ends after `duration`."""
    scene = touchdown.load(name).set({"run.duration": duration})
    data = touchdown.run(scene, **WAYS[way]).data
    columns = {str(column): np.ascontiguousarray(data[column].values) for column in data.variables}
    return {column: hashlib.sha256(values.tobytes()).hexdigest()[:16] for column, values in columns.items()}


def difference(here: Digests, there: Digests) -> tuple[list[str], list[str], list[str]]:
    """Columns that differ, that are here alone, that are there alone."""
    differ = [column for column in here if column in there and here[column] != there[column]]
    return differ, sorted(here.keys() - there.keys()), sorted(there.keys() - here.keys())


def told(here: Digests, there: Digests) -> str:
    """The `difference` in words."""
    differ, new, gone = difference(here, there)
    parts = [f"{len(here.keys() & there.keys()) - len(differ)} columns equal"]
    for what, columns in (("differ", differ), ("here alone", new), ("there alone", gone)):
        if columns:
            shown = ", ".join(columns[:3]) + (", ..." if len(columns) > 3 else "")
            parts.append(f"{len(columns)} {what} ({shown})")
    return "; ".join(parts)


def main(arguments: list[str] | None = None) -> int:
    """Print one line a scene and comparison; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--scenes", help="only these, by commas")
    parser.add_argument("--duration", default="12 ms", help="of each scene; in 12 ms most have landed")
    parser.add_argument("--ways", default=",".join(WAYS), help="to step a scene, by commas")
    parser.add_argument("--against", type=Path, help="what -o of another version left")
    parser.add_argument("-o", "--output", type=Path, default=Path("runs/recordings.json"))
    options = parser.parse_args(arguments)
    before = json.loads(options.against.read_text("utf-8")) if options.against else {}
    kept: dict[str, Digests] = {}
    differing = False
    for name in options.scenes.split(",") if options.scenes else sorted(shipped_scenes()):
        first, *others = options.ways.split(",")
        kept[name] = digests(name, options.duration, first)
        compared = {f"{first}, {way}": digests(name, options.duration, way) for way in others}
        if name in before:
            compared[f"{first}, {options.against}"] = before[name]
        for title, other in compared.items():
            differing |= bool(difference(kept[name], other)[0])
            print(f"{name:24}  {title:32}  {told(kept[name], other)}", flush=True)
    options.output.parent.mkdir(parents=True, exist_ok=True)
    options.output.write_text(json.dumps(kept, indent=1), encoding="utf-8")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
