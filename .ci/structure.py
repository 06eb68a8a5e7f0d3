"""The state of the house in figures: `python .ci/structure.py [CHECKOUT]` prints a table.

It reads the sources as text and runs none of them. Tests, benchmarks and documents do not count.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

PACKAGES = ("modelkit", "rotor", "bearings", "fmus", "master", "validation", "src")
KERNELS = {"kernel", "inlined", "njit"}
LONG, MANY, STRETCH = 40, 6, 6


def main() -> int:
    """Print the figures of a checkout."""
    root = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    files = [
        path
        for package in PACKAGES
        for path in sorted((root / package).rglob("*.py"))
        if not any(parent.is_symlink() for parent in path.parents)
    ]
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in files}
    lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in files}
    functions = [(path, node) for path, tree in trees.items() for node in _functions(tree)]
    own = [node for _, node in functions if not _is_kernel(node)]
    fullest = max(_folders(root), key=_entries)
    longest = max(lines, key=lambda path: lines[path])
    rows = {
        "modules": len(files),
        "lines": sum(lines.values()),
        "import circles": len(_circles(_graph(root, trees))),
        "entries of the fullest folder": f"{_entries(fullest)} ({fullest.relative_to(root)})",
        "longest file": f"{lines[longest]} lines ({longest.relative_to(root)})",
        f"functions over {LONG} lines, kernels apart": sum(_length(node) > LONG for node in own),
        f"functions over {MANY} parameters, kernels apart": sum(_parameters(node) > MANY for node in own),
        "comparisons with a word": sum(len(list(_words_compared(tree))) for tree in trees.values()),
        f"stretches of {STRETCH} lines that stand twice": _stretches(files),
    }
    for name, value in rows.items():
        print(f"{name:<48}{value}")
    return 0


def _functions(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    return (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))


def _is_kernel(node: ast.FunctionDef) -> bool:
    names = (ast.unparse(decorator).partition("(")[0] for decorator in node.decorator_list)
    return any(name.rpartition(".")[2] in KERNELS for name in names)


def _length(node: ast.FunctionDef) -> int:
    return (node.end_lineno or node.lineno) - node.lineno + 1


def _parameters(node: ast.FunctionDef) -> int:
    a = node.args
    return len([p for p in (*a.posonlyargs, *a.args, *a.kwonlyargs) if p.arg not in ("self", "cls")])


def _folders(root: Path) -> Iterator[Path]:
    for package in (*PACKAGES, "tests"):
        top = root / package
        yield from (f for f in (top, *top.rglob("*")) if f.is_dir() and f.name != "__pycache__")


def _entries(folder: Path) -> int:
    return sum(not entry.is_symlink() and entry.name != "__pycache__" for entry in folder.iterdir())


def _words_compared(tree: ast.AST) -> Iterator[ast.Compare]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Eq | ast.NotEq):
            sides = [node.left, *node.comparators]
            words = [s.value for s in sides if isinstance(s, ast.Constant) and isinstance(s.value, str)]
            if any(word.isidentifier() or "-" in word for word in words) and "__main__" not in words:
                yield node


def _graph(root: Path, trees: Mapping[Path, ast.AST]) -> dict[str, set[str]]:
    """What each module imports of the others, anywhere in it; names without the package around all."""
    names = {path: ".".join(path.relative_to(root).with_suffix("").parts) for path in trees}
    modules = {name.removeprefix("src.touchdown.").removesuffix(".__init__") for name in names.values()}
    graph: dict[str, set[str]] = {name: set() for name in modules}
    for path, tree in trees.items():
        name = names[path].removeprefix("src.touchdown.").removesuffix(".__init__")
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module:
                module = node.module.removeprefix("touchdown.")
                for one in node.names:
                    whole = f"{module}.{one.name}"
                    graph[name].add(whole if whole in modules else module)
    return {name: (others & modules) - {name} for name, others in graph.items()}


def _circles(graph: Mapping[str, set[str]]) -> list[set[str]]:
    """Sets of modules of which each leads to each other."""
    reach = {name: _reached(name, graph) for name in graph}
    circles: list[set[str]] = []
    for name in graph:
        circle = {other for other in reach[name] if name in reach[other]}
        if circle and circle not in circles:
            circles.append(circle)
    return circles


def _reached(name: str, graph: Mapping[str, set[str]]) -> set[str]:
    reached: set[str] = set()
    ahead = list(graph[name])
    while ahead:
        other = ahead.pop()
        if other not in reached:
            reached.add(other)
            ahead += graph[other]
    return reached


def _stretches(files: list[Path]) -> int:
    """Runs of lines that stand in two places, each counted once whatever its length; imports apart."""
    seen: dict[tuple[str, ...], int] = {}
    count = place = 0
    for path in files:
        kept = [line for line in _code(path) if len(line) > 2 and not line.startswith("#")]
        last = -STRETCH
        for i in range(len(kept) - STRETCH + 1):
            run = tuple(kept[i : i + STRETCH])
            if run in seen:
                count += i > last + 1
                last = i
            seen.setdefault(run, place + i)
        place += len(kept)
    return count


def _code(path: Path) -> list[str]:
    """Lines of a module without its imports."""
    text = path.read_text(encoding="utf-8")
    lines = [line.strip() for line in text.splitlines()]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            for number in range(node.lineno, (node.end_lineno or node.lineno) + 1):
                lines[number - 1] = ""
    return lines


if __name__ == "__main__":
    sys.exit(main())
