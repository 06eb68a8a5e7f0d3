"""Size and structure of the product in figures: `python .ci/structure.py [CHECKOUT]` prints a table.

It reads the sources as text and runs none of them. Tests, benchmarks and documents do not count.
"""

from __future__ import annotations

import ast
import sys
import tokenize
from collections.abc import Iterator, Mapping
from pathlib import Path

PACKAGES = (
    *("modelkit", "rotor", "bearings", "fmus", "master"),
    *("studies", "reports", "command", "validation", "src"),
)
KERNELS = {"kernel", "inlined", "njit"}
LONG, MANY, STRETCH = 40, 6, 6
LAYOUT = {
    *(tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT),
    tokenize.ENDMARKER,
}


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
    lines = {path: _length_of(path) for path in files}
    functions = [(path, node) for path, tree in trees.items() for node in _functions(tree)]
    own = [node for _, node in functions if not _is_kernel(node)]
    fullest = max(_folders(root), key=_entries)
    longest = max(lines, key=lambda path: lines[path])
    statements = sum(_statements(path, tree) for path, tree in trees.items())
    depths = {folder: len(folder.relative_to(root).parts) - 1 for folder in _folders(root)}
    deepest = max(depths, key=lambda folder: depths[folder])
    rows = {
        "modules": len(files),
        "folders that hold modules": len({path.parent for path in files}),
        "deepest folder below a top folder": f"{depths[deepest]} ({deepest.relative_to(root)})",
        "lines": sum(lines.values()),
        "lines without blanks, comments and docstrings": statements,
        "mean lines of a module": round(sum(lines.values()) / len(files)),
        "lines of tests": sum(_length_of(path) for path in (root / "tests").rglob("*.py")),
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


def _length_of(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def _statements(path: Path, tree: ast.AST) -> int:
    """Lines that statements take: without blanks, comments and docstrings."""
    with tokenize.open(path) as file:
        tokens = list(tokenize.generate_tokens(file.readline))
    taken = {
        line
        for token in tokens
        if token.type not in LAYOUT
        for line in range(token.start[0], token.end[0] + 1)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node, False):
            taken -= set(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    return len(taken)


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
    names = {path: _module(path.relative_to(root).with_suffix("").parts) for path in trees}
    modules = set(names.values())
    graph: dict[str, set[str]] = {name: set() for name in modules}
    for path, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                source = _source(node, path.relative_to(root))
                for one in node.names:
                    whole = f"{source}.{one.name}".removeprefix(".")
                    graph[names[path]].add(whole if whole in modules else source)
    return {name: (others & modules) - {name} for name, others in graph.items()}


def _module(parts: tuple[str, ...]) -> str:
    return ".".join(parts).removeprefix("src.touchdown.").removesuffix(".__init__")


def _source(node: ast.ImportFrom, path: Path) -> str:
    """The module or package that an import names, without the package around all."""
    if not node.level:
        return (node.module or "").removeprefix("touchdown.")
    package = path.parent.parts[: len(path.parent.parts) - node.level + 1]
    return ".".join((*package, *filter(None, [node.module])))


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
