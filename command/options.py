"""The options of a verb, from the signatures and docstrings of the functions behind it.

A verb calls a public function and prints what it returns. Parameters in front of the `*` of a signature are
arguments of the command, those behind it options, and `name: meaning` in the docstring is their help. What
a signature cannot tell, such as short forms, is in the tables here and in the verb.
"""

from __future__ import annotations

import argparse
import ast
import inspect
import re
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from . import completion
from .parameters import METAVARS, POSITIVE, REPEATED, SIGNED, read

OUTPUT = ("folder", "path")  # parameters that -o names
# Of arguments, and of options that may be repeated
OWN_METAVARS = {
    "scene_name": "SCENE",
    "figure_name": "NAME",
    "source": "FILE",
    "fmus": "FMU",
    "rotors": "ROTOR",
    "swap": "COMPONENT=FMU",
    "names": "COMPONENT=FILE",
    "vary": "NAME=VALUES",
    "tie": "NAME=VALUES",
    "range": "NAME=LOW:HIGH UNIT",
    "support": "STATION=STIFFNESS",
    "mount": "FILE",
    "at": "SEAT=NAME,...",
    "pick": "KEY",
    "over": "NAME",
}
COMMON = {  # what options of scenes mean
    "scene_name": "name of a scene, or path of a .toml, an .ssp or a run's scene.json",
    "variant": "of an .ssp that has several systems: the name of another .ssd file in it",
    "settings": "set run.KEY or COMPONENT.VARIABLE; run.macro_step=auto: the largest advised",
    "swap": "replace a component's FMU; bearing_*=FMU those of all that match",
    "names": "TOML: the FMU's own names for the variables of the contract; controller_*=FILE: of all that "
    "match",
    "duration": 'length of a run, counted from the scene\'s zero of time, such as "0.2 s"',
    "continue_from": "folder of a run: go on where it ended, as if it had not, with the --duration and the "
    "tunable parameters that are given, these into another folder",
}
NOTES = "notes"  # a parameter of `show`: what the run warned of
PROGRESS = "progress"  # shown by the command unless there is --quiet
FLAGS = ("bool", "bool | None", "Pictures")
KINDS = {*METAVARS, *POSITIVE, *SIGNED}
# Options of other names than their parameters
SPELLED = {
    "settings": "set",
    "continue_from": "from",
    "role": "as",
    "points": "list",
    "targets": "target",
    "component": "variables",
}
ONLY_IN_PYTHON = re.compile(r"; (?:in Python|without one)\b[^;]*")  # parts of meanings
MEANING = re.compile(r"^(\w+): (.*(?:\n {4}.*)*)", re.MULTILINE)
Values = dict[str, Any]


@dataclass(frozen=True)
class _Option:
    """A parameter of a function as an argument or an option of the command."""

    name: str
    kind: str  # its annotation without "| None"
    default: Any
    positional: bool
    meaning: str

    @property
    def flag(self) -> str:
        """The option as typed."""
        return (
            "--"
            + ("no-" if self.default is True else "")
            + SPELLED.get(self.name, self.name).replace("_", "-")
        )

    @property
    def choices(self) -> dict[str, Any]:
        """The values of a `Literal` by their texts; none of others."""
        if not self.kind.startswith("Literal"):
            return {}
        return {str(value): value for value in ast.literal_eval(self.kind.removeprefix("Literal"))}

    def add_to(self, parser: argparse.ArgumentParser, output: str) -> None:
        """Declare it."""
        meaning, default = self.meaning.replace("%", "%%"), self.default
        if self.name == PROGRESS:
            parser.add_argument("--quiet", action="store_false", dest=PROGRESS, help="no progress bar")
            return
        if self.kind in FLAGS:
            action, meaning = ("store_false", f"do not {meaning}") if default else ("store_true", meaning)
            parser.add_argument(self.flag, action=action, dest=self.name, default=default, help=meaning)
            return
        keywords: Values = {"help": meaning, "choices": list(self.choices) or None}
        keywords["metavar"] = None if self.choices else METAVARS.get(self.kind, self.kind.upper())
        if (self.positional and not self.choices) or self.kind == "Texts":
            keywords["metavar"] = OWN_METAVARS.get(self.name, self.name.upper())
        required = default is inspect.Parameter.empty
        if self.positional:
            nargs = "*" if self.kind == "Texts" else None if required else "?"
            action = parser.add_argument(self.name, nargs=nargs, **keywords)
        elif self.name in OUTPUT:
            keywords |= {"metavar": "PATH", "help": f"{meaning} (default: {output})" if output else meaning}
            action = parser.add_argument("-o", "--output", dest=self.name, **keywords)
        else:
            if self.kind in REPEATED:
                keywords["action"] = "append"
            elif default not in (None, "", (), 0, inspect.Parameter.empty) and "(default" not in meaning:
                keywords["help"] += f" (default: {default})"
            action = parser.add_argument(self.flag, dest=self.name, required=required, **keywords)
        if self.name in completion.COMPLETERS:
            cast(Any, action).completer = completion.COMPLETERS[self.name]  # argcomplete asks it

    def value(self, options: argparse.Namespace) -> Any:
        """As the function takes it. Raises TouchdownError for a text that it cannot be."""
        entered = getattr(options, self.name)
        if entered is None or entered == []:
            return None if self.default is inspect.Parameter.empty else self.default
        if self.kind in FLAGS or self.name == PROGRESS:
            return entered
        if self.choices:
            return self.choices[entered]
        return read(self.kind, entered, self.name.upper() if self.positional else self.flag)


@dataclass(frozen=True)
class Verb:
    """A verb: what it runs, what prints the result, and what their signatures do not tell."""

    name: str
    run: Callable[..., Any]  # returns a result, or, without `show`, prints it and returns the status
    show: Callable[..., int] | None = None  # prints the result, its first argument; returns the exit status
    examples: tuple[str, ...] = ()  # whole command lines
    before: Callable[..., object] | None = None  # checks and says what must come before the run
    output: str = ""  # where -o leads; {NAME} stands for a parameter, {SCENE} for a scene's name
    documented: tuple[Callable[..., Any], ...] = ()  # whose docstrings tell of parameters of `run`
    named: tuple[str, ...] = ()  # parameters in front of the * that are options all the same
    defaults: Mapping[str, Any] = field(default_factory=dict)  # where the command's differ
    builders: Mapping[str, Callable[..., Any]] = field(default_factory=dict)  # of what options make up
    left: Callable[..., str] | None = None  # says what is there after Ctrl-C
    in_place: bool = False  # whether the folder of --from is where -o leads

    @property
    def words(self) -> str:
        """The verb in a line."""
        first = (inspect.getdoc(self.run) or "").partition("\n")[0]
        return first[0].lower() + first[1:].rstrip(".")

    def options(self) -> dict[str, _Option]:
        """Every argument and option, by the name of its parameter."""
        functions = [f for f in (self.run, self.show) if f is not None]
        found = dict[str, _Option]()
        for function in functions:
            for option in self._of(function):
                found.setdefault(option.name, option)
        return found

    def _of(self, function: Callable[..., Any]) -> Iterator[_Option]:
        """Of one function; a parameter with a builder is replaced by the builder's own."""
        texts = (inspect.getdoc(one) or "" for one in (*self.documented, function))
        lines = (one for text in texts for one in MEANING.findall(text))
        meanings = COMMON | {name: ONLY_IN_PYTHON.sub("", " ".join(text.split())) for name, text in lines}
        for name, one in inspect.signature(function).parameters.items():
            if name in self.builders:
                optional = one.default is None
                for option in self._of(self.builders[name]):
                    yield (
                        _Option(**{**vars(option), "default": None})
                        if optional and option.positional
                        else option
                    )
            elif name in meanings or name in (*OUTPUT, PROGRESS):
                kind = one.annotation if one.annotation in FLAGS else one.annotation.partition(" | ")[0]
                if name in OUTPUT or (kind not in KINDS and "PathLike" in one.annotation):
                    kind = "PathLike"
                positional = one.kind is one.POSITIONAL_OR_KEYWORD and name not in self.named
                output = name in OUTPUT and (self.output or one.default is not one.empty)
                default = self.defaults.get(name, one.default)
                yield _Option(name, kind, default, positional and not output, meanings.get(name, "folder"))

    def add_to(self, verbs: Any) -> None:
        """Add it to the command; `verbs` are argparse's subparsers."""
        parser = verbs.add_parser(
            self.name,
            help=self.words,
            description=f"{self.words[0].upper()}{self.words[1:]}.",
            epilog="\n  ".join(("examples:", *self.examples)),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        self.declare(parser)
        parser.set_defaults(execute=self.execute, help_text=parser.format_help)

    def declare(self, parser: argparse.ArgumentParser) -> None:
        """Declare its arguments and options."""
        for option in self.options().values():
            option.add_to(parser, self.output.translate({ord(brace): None for brace in "{}"}))

    def execute(self, options: argparse.Namespace) -> int:
        """Do it; returns the exit status."""
        values = {name: option.value(options) for name, option in self.options().items()}
        try:
            return self._done(values)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(called(self.left, values) if self.left else "") from None

    def _done(self, values: Values) -> int:
        for name, build in self.builders.items():
            values[name] = called(build, values)
        chosen = values.get("scene")
        words = {name.upper(): value for name, value in values.items()} | {
            "SCENE": getattr(chosen, "name", "cases")
        }
        for name in OUTPUT:
            if name in values and values[name] is None and self.output:
                earlier = values.get("continue_from") if self.in_place else None
                values[name] = earlier or Path(self.output.format_map(words))
        if self.before:
            called(self.before, values)
        noting = self.show is not None and NOTES in inspect.signature(self.show).parameters
        with warnings.catch_warnings(record=noting) as noted:
            if noting:
                warnings.simplefilter("always", UserWarning)
            result = called(self.run, values)
        values[NOTES] = [str(one.message) for one in noted or ()]
        return result if self.show is None else called(self.show, values, result)


def called(function: Callable[..., Any], values: Values, *first: Any) -> Any:
    """The function with those of the values that it has parameters for."""
    parameters = inspect.signature(function).parameters
    names = list(parameters)[len(first) :]
    if any(one.kind is one.VAR_KEYWORD for one in parameters.values()):
        names = [*names, *values]
    return function(*first, **{name: values[name] for name in names if name in values})
