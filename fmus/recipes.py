"""The FMUs that can be made, and the named sets of parameters they take.

An FMU is made of a model of the project, of a rotor file or of the file of a controller's law. A module
below `bearings` or `rotor` that declares a `MODEL` is a model; that is all it takes. pythonfmu runs a
script in the FMU, which names the model, or carries the text of the file, so that the FMU needs nothing
beside it.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path

from ..bearings import catalogue
from ..bearings.catalogue import CatalogueError
from ..bearings.magnetic.law_file import ENDINGS, read_law
from ..bearings.magnetic.state_space import controller
from ..modelkit.errors import TouchdownError
from ..modelkit.model import Model
from ..modelkit.reader import text_of
from ..rotor.file import parse_rotor, rotor_named, shipped_rotors
from ..rotor.flexible import flexible_rotor
from .model_names import models
from .python.packed_sources import content_hash
from .variants import defaults, starting_from, with_modes

_SCRIPT = '''"""FMU: {title}."""

from touchdown.{module} import MODEL
from touchdown.fmus.slave import ModelSlave


class {identifier}(ModelSlave):
    """{title}."""

    model = MODEL
'''
_ROTOR_SCRIPT = '''"""FMU: flexible rotor {name}."""

from touchdown.fmus.slave import ModelSlave
from touchdown.rotor.file import parse_rotor
from touchdown.rotor.flexible import flexible_rotor

TEXT = {text!r}


class {identifier}(ModelSlave):
    """flexible rotor."""

    model = flexible_rotor(parse_rotor(TEXT, {file!r}), {name!r}, {content!r})
'''
_LAW_SCRIPT = '''"""FMU: controller {name}."""

import json

from touchdown.bearings.magnetic.law_file import law_of
from touchdown.bearings.magnetic.state_space import controller
from touchdown.fmus.slave import ModelSlave

TEXT = {text!r}


class {identifier}(ModelSlave):
    """controller of magnetic bearings."""

    model = controller(law_of(json.loads(TEXT), {file!r}), {name!r}, {content!r})
'''


_STARTING = """

from touchdown.fmus.variants import starting_from

{identifier}.model = starting_from({identifier}.model, {values!r})
"""

_WITH_MODES = """

from touchdown.fmus.variants import with_modes

{identifier}.model = with_modes({identifier}.model, {count}, {told})
"""


@dataclass(frozen=True)
class Recipe:
    """How an FMU is made; `content` is a hash over everything in it."""

    name: str
    identifier: str  # of its class, and of its library
    script: str
    content: str
    model: Model

    @property
    def module(self) -> str:
        """Module name of its script: one interpreter may hold several versions of it."""
        return f"{self.name}_{self.content}"

    def starting_from(self, values: Mapping[str, float]) -> Recipe:
        """The recipe of an FMU that starts from `values` (SI, by name) where nothing is set in it.

        Raises KeyError for a name that is neither a parameter nor an input.
        """
        held = defaults(self.model)
        others = {n: float(v) for n, v in sorted(values.items()) if repr(float(v)) != repr(float(held[n]))}
        if not others:
            return self
        model = starting_from(self.model, others)
        script = self.script + _STARTING.format(identifier=self.identifier, values=others)
        return replace(self, script=script, content=f"{self.content}{model.content[-17:]}", model=model)

    def with_modes(self, count: int, listed: int) -> Recipe:
        """The recipe of an FMU for rotors of `count` modes per plane (`variants.modes`)."""
        model = with_modes(self.model, count, listed)
        if model is self.model:
            return self
        script = self.script + _WITH_MODES.format(identifier=self.identifier, count=count, told=listed)
        return replace(self, script=script, content=f"{self.content}_modes{count}_{listed}", model=model)


def fmu_names() -> list[str]:
    """FMUs of the project: its models, and the rotors that come with it."""
    return sorted([*models(), *shipped_rotors()])


def recipe(name: str) -> Recipe:
    """The recipe of an FMU of the project's by name, or of a rotor or controller by the path of its file.

    Raises TouchdownError where the file has a mistake, LookupError for an unknown name.
    """
    if name.endswith(".toml"):
        return _from_rotor(Path(name))
    if is_law(name):
        return _from_law(Path(name))
    if name in shipped_rotors():
        return _from_rotor(shipped_rotors()[name])
    if name not in models():
        raise LookupError(f"there is no FMU called {name}")
    module = models()[name]
    model: Model = import_module(f"touchdown.{module}").MODEL
    script = _SCRIPT.format(title=model.title, module=module, identifier=_identifier(name))
    return Recipe(name, _identifier(name), script, content_hash(), model)


def _identifier(name: str) -> str:
    return "".join(f"{part[:1].upper()}{part[1:]}" for part in name.split("_"))


def _from_rotor(path: Path) -> Recipe:
    text = text_of(path)
    shaft = parse_rotor(text, str(path))
    return _carrying(path, "Rotor", _ROTOR_SCRIPT, text, lambda *known: flexible_rotor(shaft, *known))


def is_law(name: str) -> bool:
    """Whether `name` is the path of a file with a controller's law."""
    return name.lower().endswith(ENDINGS)


def _from_law(path: Path) -> Recipe:
    law = read_law(path)
    return _carrying(path, "Controller", _LAW_SCRIPT, law.text, lambda *known: controller(law, *known))


def _carrying(path: Path, kind: str, script: str, text: str, model: Callable[[str, str], Model]) -> Recipe:
    """The recipe of an FMU whose script carries the text of the file at `path`; model: by name and hash."""
    name = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    mark = hashlib.sha256(text.encode()).hexdigest()[:16]
    identifier = f"{kind}{_identifier(name)}"
    whole = script.format(file=path.name, text=text, identifier=identifier, name=name, content=mark)
    return Recipe(name, identifier, whole, f"{content_hash()}_{mark}", model(name, mark))


def mean_eccentricity(fmu: str, folder: Path) -> float:
    """The amounts of a rotor's unbalances over its mass (m); 0: its file has none, or it has no file."""
    with suppress(LookupError, TouchdownError):
        shaft = rotor_named(str(folder / fmu) if fmu.endswith(".toml") else fmu)
        return sum(one.moment for one in shaft.unbalances) / shaft.mass
    return 0.0


def presets() -> list[str]:
    """Names of the sets of parameters that a component may ask for: the bearings of the catalogue."""
    return catalogue.built_in()


def find_preset(name: str, *folders: Path) -> str:
    """The values of `preset` for the bearing called `name`, from the first of `folders` that has it.

    Raises CatalogueError, that of the first folder, where there is none.
    """
    file = name.rpartition(":")[0]
    there = [folder for folder in folders if not file or (folder / file).is_file()] or folders[:1]
    for folder in there:
        with suppress(CatalogueError):
            return catalogue.bearing_reference(name, folder)
    return catalogue.bearing_reference(name, there[0])


def preset(found: str) -> dict[str, float]:
    """Values in SI by parameter name; a component takes those it has. Raises TouchdownError."""
    return catalogue.bearing(found).settings()


def is_angled(found: str) -> bool:
    """Whether the bearing that `preset` takes is a pair with a contact angle. Raises TouchdownError."""
    return catalogue.bearing(found).angle_in_drops > 0.0


def bore_of(found: str) -> float:
    """Bore (m) of the bearing that `preset` takes. Raises TouchdownError."""
    return catalogue.bearing(found).bore
