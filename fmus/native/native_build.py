"""Build native FMUs: libraries for the targets, the description, documentation and icon."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import tostring

from ...modelkit.model import Model
from ..build import is_sound, kept_sound, write_fmu
from ..description.described_variables import Making, guid
from ..presentation import terminals
from ..presentation.documentation import page
from ..presentation.icon import icon
from ..recipes import Recipe
from ..variants import refusal
from ..version import VERSION
from .c_tables import Choice, HeldConstants, header, source
from .compiler import SOURCE, NativeError, Target, chosen_targets, command, library
from .in_c import ENTRIES, InC, sources
from .interfaces import FMI_2, FmiVersion
from .kernels import bitcode

MODES = (2, 5, 10)  # per plane, that rotors hold constants for; the scenes ask for these
_HEAD = b"<?xml version='1.0' encoding='UTF-8'?>\n"


@dataclass(frozen=True)
class Native:
    """The targets of native FMUs: machines, numbers of a rotor's modes, a version of FMI.

    lenient: leave out numbers of modes that a rotor does not have.
    """

    targets: tuple[Target, ...]
    modes: tuple[int, ...] = MODES
    lenient: bool = True
    face: FmiVersion = FMI_2

    def check(self) -> None:
        """Raise NativeError where the compiler for a target is not there."""
        for target in self.targets:
            command(target)


def build_native(recipe: Recipe, folder: Path, native: Native) -> Path:
    """Build a native FMU into `folder` as NAME.fmu; returns its path. An older one is replaced.

    Raises NativeError where kernels cannot be compiled, or the compiler is missing or fails.
    """
    model, held, face = recipe.model, _held(recipe.model, native), native.face
    identity = _identity(model, held, face)
    making = Making(f"touchdown-cosim {VERSION}, native", identity, needs_tool=False)
    description = face.described(model, recipe.identifier, face.categories, making)
    entries = {
        "modelDescription.xml": _HEAD + tostring(description),
        "documentation/index.html": page(
            recipe, needs=_needs(model, native, held), exposed=face.documented(model)
        ).encode(),
        **terminals.terminal_entries(model, face.variables(model)),
        **({"model.png": icon(model)} if face is FMI_2 else {}),
    }
    code, texts = _code(model, identity, held, face)
    libraries = {target: library(code, texts, target, recipe.identifier) for target in native.targets}
    for place, target in face.places(native.targets).items():
        entries[f"binaries/{place}/{recipe.identifier}{target.suffix}"] = libraries[target]
    return write_fmu(entries, folder, recipe.name, sealed=not isinstance(model.advance, InC))


def compile_kernels(recipes: Sequence[Recipe]) -> None:
    """Compile the kernels of several models beside each other, where there are processors for it."""
    models = {r.model.advance: r.model for r in recipes if not isinstance(r.model.advance, InC)}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(bitcode, models.values()))


def cached_native(recipe: Recipe, modes: Sequence[int] = (), targets: Sequence[str] = ()) -> Path:
    """The native FMU of a recipe; built on first use, and where it is damaged.

    modes: for which numbers a rotor holds constants, beside `MODES`; targets: by name, this machine if
    none. Raises NativeError as `build_native` does, OSError where it cannot be written.
    """
    native, content = _kept_as(recipe, modes, targets)
    return kept_sound(recipe.name, content, lambda folder: build_native(recipe, folder, native))


def is_at_hand(recipe: Recipe, modes: Sequence[int] = ()) -> bool:
    """Whether `cached_native` finds what was built of the present sources, and need not build."""
    try:
        return is_sound(recipe.name, _kept_as(recipe, modes)[1])
    except NativeError:
        return False


def _kept_as(recipe: Recipe, modes: Sequence[int], targets: Sequence[str] = ()) -> tuple[Native, str]:
    """How an FMU is made, and a digest of all that it is made of, and for: machines may share a cache."""
    more = tuple(n for n in dict.fromkeys(modes) if n not in MODES) if recipe.model.tabulated else ()
    native = Native(chosen_targets(targets), (*MODES, *more))
    native.check()
    parts = (
        recipe.content,
        _sources(),
        command(native.targets[0])[0],
        *(target.name for target in native.targets),
        version("numba"),
        version("llvmlite"),
        *map(str, more),
    )
    return native, f"{hashlib.sha256(' '.join(parts).encode()).hexdigest()[:16]}-native"


def _code(
    model: Model, identity: str, held: HeldConstants, face: FmiVersion
) -> tuple[bytes | None, dict[str, str]]:
    """The code of a library: kernels as bitcode, if they are not in C, and sources in C by name."""
    side = (SOURCE / face.source).read_text(encoding="utf-8")
    texts = {face.source: side, "texts.h": header(face.categories)}
    constants = face.tables(model)
    if isinstance(model.advance, InC):
        return None, texts | {"model.c": source(model, identity, held, constants, ENTRIES)} | sources(model)
    return bitcode(model), texts | {"model.c": source(model, identity, held, constants)}


def _held(model: Model, native: Native) -> HeldConstants:
    """What a model holds constants for, whose defaults are among it: hosts may set nothing.

    Of a rotor that are numbers of modes, with and without the residual ones. Raises NativeError where it
    does not have what is asked for.
    """
    if model.tables is None:
        return HeldConstants()
    started: Any = model.parameters()
    if model.tabulated[:1] != ("modes",):
        return HeldConstants((tuple(getattr(started, name) for name in model.tabulated),))
    held: list[Choice] = []
    for choice in product(dict.fromkeys((*native.modes, started.modes)), (1, 0)):
        problem = refusal(model, dict(zip(model.tabulated, choice, strict=True)))
        if problem and not native.lenient:
            raise NativeError(f"{model.name}: {problem}")
        if not problem:
            held.append(choice)
    return HeldConstants(tuple(held))


def _identity(model: Model, held: HeldConstants, face: FmiVersion) -> str:
    """GUID of a native FMU: another one than that of the model's FMU in Python, whose states are others."""
    digest = hashlib.sha256(f"{guid(model)} native {_sources()} {held} {face.version}".encode()).hexdigest()
    return f"{digest[:8]}-{digest[8:12]}-{digest[12:16]}-{digest[16:20]}-{digest[20:32]}"


@cache
def _sources() -> str:
    """Hash over the sources in C."""
    digest = hashlib.sha256()
    for path in sorted(SOURCE.iterdir()):
        digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


def _needs(model: Model, native: Native, held: HeldConstants) -> str:
    """The needs of a host, in words."""
    machines = ", ".join(target.name for target in native.targets)
    text = f"A C library and nothing else, on {machines}. No Python, no compiler: the first step steps."
    if model.tabulated:
        text += f" It holds constants for {held.choices_in_words(model)}; others are refused."
    return text
