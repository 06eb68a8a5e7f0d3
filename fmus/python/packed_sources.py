"""The project's sources as they travel inside an FMU.

FMUs in one process share one interpreter. So that FMUs of different versions, and an installed project
of yet another one, never meet under one module name, the sources travel as a package named by the hash
of its content, with their imports of each other rewritten to it.
"""

from __future__ import annotations

import re
from pathlib import Path

from ...modelkit.kernel import PHYSICS_PACKAGES, source_hash
from ...modelkit.kernel.writing import make_folder, write

ROOT = Path(__file__).resolve().parents[2]
SLAVE_MODULES = (
    *("__init__.py", "slave.py", "fmu_messages.py", "variants.py", "version.py"),
    *(f"description/{name}.py" for name in ("__init__", "fmi2", "described_variables")),
)
_IMPORT = re.compile(r"^([ \t]*(?:from|import)) touchdown\.(modelkit|rotor|bearings|fmus)\b", re.MULTILINE)


def content_hash() -> str:
    """Hash over everything that decides what an FMU contains."""
    return source_hash((*PHYSICS_PACKAGES, "fmus"))


def package_name() -> str:
    """Name of the package inside the FMU."""
    return f"touchdown_{content_hash()}"


def host_module() -> str:
    """Name of the module that meets the host's interpreter."""
    return f"{package_name()}_host"


def with_package_imports(text: str) -> str:
    """`text` with the project's own imports turned to the package inside the FMU."""
    return _IMPORT.sub(lambda match: f"{match[1]} {package_name()}.{match[2]}", text)


def write_sources(folder: Path) -> Path:
    """Write the package into `folder`; returns its path."""
    package = folder / package_name()
    for name in PHYSICS_PACKAGES:
        for path in sorted((ROOT / name).rglob("*.py")):
            _copy(path, package / path.relative_to(ROOT))
    for name in SLAVE_MODULES:
        _copy(ROOT / "fmus" / name, package / "fmus" / name)
    _copy(ROOT / "fmus" / "python" / "resident.py", package / "__init__.py")
    return package


def write_host(folder: Path) -> Path:
    """Write the module that meets the host's interpreter into `folder`; returns its path."""
    path = folder / f"{host_module()}.py"
    _copy(ROOT / "fmus" / "python" / "host.py", path)
    return path


def write_script(text: str, module: str, folder: Path) -> Path:
    """Write an FMU's script, as `module`, into `folder`; returns its path."""
    text = f"__import__({host_module()!r}).prepare()\n\n{with_package_imports(text)}"
    text += (
        "\n\n# pythonfmu runs this file anew for every instance, and drops a reference to its globals\n"
        f"__import__({package_name()!r}).keep(globals())\n"
    )
    return write(folder / f"{module}.py", text)


def _copy(source: Path, target: Path) -> None:
    make_folder(target.parent)
    write(target, with_package_imports(source.read_text(encoding="utf-8")))
