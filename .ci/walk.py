"""Run the commands of pages of the documentation as a reader would: in a folder of its own, in their order.

    python .ci/walk.py docs/own-machine.md ...

A block of TOML that begins with the name of its file, `# FOLDER/FILE.toml`, is written there; the lines of
```sh blocks are run, with the command `touchdown` of this interpreter's environment.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

BLOCK = re.compile(r"^```(sh|toml)\n(.*?)^```", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"# (\S+\.toml)\n")


def steps(page: Path) -> Iterator[tuple[str, str]]:
    """Of a page, in order: the name of a file and its text, or "" and a command."""
    for kind, block in BLOCK.findall(page.read_text(encoding="utf-8")):
        if kind == "sh":
            yield from (("", line) for line in block.splitlines())
        elif named := FILE.match(block):
            yield named[1], block


def walk(page: Path, folder: Path) -> int:
    """Do what a page says, in `folder`; the status of the first command that fails, or 0."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    for name, text in steps(page):
        if name:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8")
            continue
        print(f"$ {text}", flush=True)
        ended = subprocess.run(
            ["bash", "-c", text], cwd=folder, env={**os.environ, "PATH": path}, check=False
        )
        if ended.returncode:
            print(f"exit status {ended.returncode}: {text}", file=sys.stderr)
            return ended.returncode
    return 0


def main(pages: list[str]) -> int:
    """Walk all pages; stops at the first that fails."""
    for page in pages:
        with tempfile.TemporaryDirectory() as folder:
            if status := walk(Path(page), Path(folder)):
                return status
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
