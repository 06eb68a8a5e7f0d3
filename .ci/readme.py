"""Run the README's own commands, and those of some pages, so that what they promise is what is tested.

    python .ci/readme.py run|test|rest|pages [--python python3]

The README's ```sh blocks hold one command a line. The first line of the first block is `run`, the
second `test`; everything in later blocks is `rest`, ```python blocks included. `pages` are all blocks of
PAGES, by the commands of .venv. Lines run in the repository's root, in one shell each, as a reader would
type them.
"""

from __future__ import annotations

import argparse
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = ("docs/studies.md", "docs/mounts.md")  # tests run what the other pages name


def blocks(page: str) -> list[list[str]]:
    """Commands of each ```sh block of a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    fenced = re.findall(r"^```(sh|python)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    return [
        [f".venv/bin/python -c {shlex.quote(block)}"] if kind == "python" else block.splitlines()
        for kind, block in fenced
    ]


def chosen(part: str) -> list[str]:
    """The commands of a part of the README, or of the pages."""
    if part == "pages":
        return [_in_venv(line) for page in PAGES for block in blocks(page) for line in block]
    first, *later = blocks("README.md")
    if len(first) != 2:
        sys.exit(f"the README's first block must hold two commands, it holds {len(first)}")
    return {"run": first[:1], "test": first[1:], "rest": [line for block in later for line in block]}[part]


def _in_venv(command: str) -> str:
    """A page's command as it runs here: pip is this machine's own, the rest is .venv's."""
    if command.startswith("pip "):
        return f"python3 -m pip --python .venv/bin/python {command.removeprefix('pip ')}"
    return f'PATH="$PWD/.venv/bin:$PATH" {command}'


def main() -> int:
    """Run the commands; stops at the first that fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("run", "test", "rest", "pages"))
    parser.add_argument("--python", default="python3", help="stands for python3 in the commands")
    options = parser.parse_args()
    for command in chosen(options.part):
        command = re.sub(r"\bpython3\b", options.python, command)
        print(f"$ {command}", flush=True)
        status = subprocess.run(["bash", "-c", command], cwd=ROOT, check=False).returncode
        if status:
            print(f"exit status {status}: {command}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
