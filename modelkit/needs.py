"""What a setting needs to act: other settings, of its own model or of the rotor.

A declaration says it in a few words, the field `needs` of a variable or of a group:

    "axial"                         a variable that is not 0
    "damping_ratio or dissipation"  one of them
    "law == 1 and gap > 0"          both; `and` binds closer than `or`
    "modes >= #"                    #: the number of the group in its row, of mode[3] 3
    "@axial"                        a variable of the rotor that a bearing holds, or whose bearing a mount
                                    carries; a rotor that has no such variable does not lack it
    "?micro_step == 0"              a variable that not every model has; one that has none does not lack it

Names are looked for in the group that declares the need, then in those around it. Kernels know nothing of
this: whoever assembles a scene warns of settings whose needs are not met.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from .model import Model
from .variables import flatten

OPERATORS: Mapping[str, Callable[[float, float], bool]] = {
    "!=": operator.ne,
    "==": operator.eq,
    ">=": operator.ge,
    ">": operator.gt,
}
_TERM = re.compile(r"([@?]?)([\w.\[\]]+)(?: (!=|==|>=|>) ([\d.]+|#))?")


class Term(NamedTuple):
    """A variable that must stand to a number as the operator says."""

    name: str
    compare: str = "!="
    number: float = 0.0
    of_rotor: bool = False

    def met(self, value: float) -> bool:
        """Whether `value` is such."""
        return OPERATORS[self.compare](value, self.number)


Need = tuple[tuple[Term, ...], ...]  # one of these, all of each


@cache
def needs(model: Model) -> Mapping[str, Sequence[Need]]:
    """All that each parameter of `model` needs, by its exposed name. Raises ValueError for a wrong one."""
    variables = flatten(model.parameters())
    names = {v.name for v in variables}
    found: dict[str, Sequence[Need]] = {}
    for v in variables:
        exposed = model.rename(v.name) if v.needs else None
        if exposed is not None:
            stated = [_parsed(model, text, owner, names) for owner, text in v.needs]
            found[exposed] = [need for need in stated if all(need)]
    return found


def _parsed(model: Model, text: str, owner: str, names: Collection[str]) -> Need:
    """A need that the variable or group `owner` declares."""
    return tuple(
        tuple(term for part in words.split(" and ") if (term := _term(model, part, owner, names)))
        for words in text.split(" or ")
    )


def _term(model: Model, text: str, owner: str, names: Collection[str]) -> Term | None:
    """A term; None where it holds by itself."""
    found = _TERM.fullmatch(text)
    if found is None:
        raise ValueError(f"{model.name}.{owner} needs {text!r}, which cannot be read")
    sign, name, compare, number = found.groups()
    if number == "#":
        number = re.findall(r"\[(\d+)\]", owner)[-1]
    term = Term(name, compare or "!=", float(number or 0.0), sign == "@")
    if term.of_rotor:
        return term
    group = owner
    while group:
        group = group.rpartition(".")[0]
        inside = f"{group}.{name}" if group else name
        if inside in names:
            return term._replace(name=model.rename(inside) or inside)
    if sign == "?":
        return None
    raise ValueError(f"{model.name}.{owner} needs {name}, which the model does not have")


def lacking(need: Need, values: Callable[[Term], Sequence[float]]) -> list[Term]:
    """The terms that keep `need` from being met, one for each of its alternatives; empty where it is met.

    values: of what a term names; one that meets it is enough; without any it is met, too.
    """
    missing: list[Term] = []
    for terms in need:
        unmet = [t for t in terms if (known := values(t)) and not any(map(t.met, known))]
        if not unmet:
            return []
        missing.append(unmet[0])
    return missing
