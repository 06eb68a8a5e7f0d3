"""Settings that do nothing, since what they need to act is missing (`modelkit.needs`)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ...modelkit.needs import Term, lacking, needs
from ..common.text import joined
from ..components.component import Component
from ..scene.scene import Scene
from .connections import Attachment

Settings = Mapping[tuple[str, str], float]  # SI, by component and variable


def idle_settings(
    scene: Scene,
    components: Mapping[str, Component],
    attachments: Sequence[Attachment],
    settings: Settings,
) -> Iterator[str]:
    """A line on the settings of each component that lack the same.

    Those of presets, zeros, and what the component starts from anyway, as that of a package does, aside.
    """
    for name, component in components.items():
        spec = scene.components[name]
        starts = {key: (0.0, variable.start) for key, variable in component.variables.items()}
        set_keys = [
            key
            for key in {**spec.inherited, **spec.set}
            if settings.get((name, key), 0.0) not in starts.get(key, (0.0,))
        ]
        if component.model is None or not set_keys:
            continue
        looked_up = _Values(name, components, attachments, settings)
        stated = needs(component.model)
        idle: dict[tuple[Term, ...], list[str]] = {}
        for key in set_keys:
            missing = (lacking(need, looked_up) for need in stated.get(key, ()))
            if first := next(filter(None, missing), None):
                idle.setdefault(tuple(first), []).append(f"{name}.{key}")
        for terms, keys in idle.items():
            do, them = ("do", "them") if len(keys) > 1 else ("does", "it")
            states = joined(dict.fromkeys(map(looked_up.state, terms)))
            remedies = joined(map(looked_up.remedy, terms), "or")
            yield f"{', '.join(keys)} {do} nothing while {states}; set {remedies}, or leave {them} out"


class _Values:
    """Values of what the settings of a component need."""

    def __init__(
        self,
        name: str,
        components: Mapping[str, Component],
        attachments: Sequence[Attachment],
        settings: Settings,
    ) -> None:
        self._name, self._components, self._settings = name, components, settings
        carried = {a.bearing for a in attachments if not a.on_journal and a.body == name}
        holding = [a for a in attachments if a.on_journal and a.bearing in carried | {name}]
        self._rotors = list(dict.fromkeys(a.body for a in holding))

    def __call__(self, term: Term) -> list[float]:
        """Of what a term names; none where that is not known, of any of the rotors."""
        found = [self._value(owner, term.name) for owner in self._owners(term)]
        known = [value for value in found if value is not None]
        return known if len(known) == len(found) else []

    def state(self, term: Term) -> str:
        """What is, in words: rotor.axial = 0."""
        found = zip(self._owners(term), self(term), strict=True)
        return joined(
            f"{owner}.{term.name} = {self._components[owner].variables[term.name].in_words(value)}"
            for owner, value in found
        )

    def remedy(self, term: Term) -> str:
        """What to set."""
        owner = self._owners(term)[0]
        variable = self._components[owner].variables[term.name]
        switch = variable.maximum == 1.0
        number = term.number if term.compare in ("==", ">=") else 1.0 if switch else None
        return f"{owner}.{term.name}" + ("" if number is None else f" = {variable.in_words(number)}")

    def _owners(self, term: Term) -> list[str]:
        return self._rotors if term.of_rotor else [self._name]

    def _value(self, owner: str, key: str) -> float | None:
        variable = self._components[owner].variables.get(key)
        return self._settings.get((owner, key), variable and variable.start)
