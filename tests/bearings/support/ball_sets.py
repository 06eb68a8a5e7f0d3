"""Ball sets as the kernels of a bearing derive them."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from touchdown.bearings.contact.materials import STEEL_NUMBERS, Elastic
from touchdown.bearings.rolling.ball_set import BallSet
from touchdown.bearings.simplified_cageless import MODEL
from touchdown.modelkit.instance import Instance


def memory_of(balls: BallSet, weight: float = 1.0, rings: Elastic = STEEL_NUMBERS) -> tuple[Any, int]:
    """Memory of a bearing with these `balls` and a ring of `weight` (N), derived; number of a problem."""
    instance = Instance(MODEL)
    p = instance.record["p"]
    for field in fields(balls):
        p["balls"][field.name] = getattr(balls, field.name)
    p["ring"]["mass"], p["gravity"] = 1.0, weight
    p["ring"]["modulus"], p["ring"]["poisson"] = rings
    return instance.record, MODEL.derive(instance.words)


def derived(balls: BallSet, weight: float = 1.0, rings: Elastic = STEEL_NUMBERS) -> Any:
    """Constants of a bearing with these `balls` and a ring of `weight` (N)."""
    memory, problem = memory_of(balls, weight, rings)
    assert problem == 0
    return memory["d"]


def problem_of(balls: BallSet) -> str | None:
    """Why these balls cannot be put together, or None."""
    memory, number = memory_of(balls)
    return MODEL.problems[number - 1].format(*memory["message_numbers"]) if number else None


def stiffness_of(balls: BallSet, rings: Elastic = STEEL_NUMBERS) -> tuple[float, float, float]:
    """Of inner race, outer race and both in series (N/m^1.5)."""
    inner, outer, series = derived(balls, rings=rings)["stiffness"]
    return float(inner), float(outer), float(series)


def resting_place(balls: BallSet, weight: float, rings: Elastic = STEEL_NUMBERS) -> tuple[float, float]:
    """Of a ring of `weight` (N), from the middle (m)."""
    d = derived(balls, weight, rings)
    return float(d["rest_x"]), float(d["rest_y"])


def angles_of(balls: BallSet) -> list[float]:
    """Attitude angles at the start (rad)."""
    return derived(balls)["angles"][: balls.count].tolist()
