"""Elements of a mount against closed forms, quadrature and the equation of a weight on a string."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from touchdown.bearings.supports import mount_law as law
from touchdown.modelkit.variables import as_record

STIFFNESS, FORCE, REACH = 2e7, 400.0, 60e-6  # N/m, N, m


def slides(*pairs: tuple[float, float]) -> Any:
    """Parameters of slides of these stiffnesses (N/m) and forces (N), and nothing else."""
    count = law.SLIDES - len(pairs)
    made = tuple(law.Slide(*pair) for pair in pairs) + (law.Slide(),) * count
    return as_record(law.Elements(slide=made))


def follow(p: Any, path: np.ndarray, h: float = 1e-5) -> tuple[np.ndarray, np.ndarray]:
    """Mean forces (N), (n, 2), on the legs of a path (m), (n + 1, 2), and the heat of each leg (J)."""
    z, heat = np.zeros(2 * law.SLIDES), np.zeros(law.HEATS)
    forces, heats = [], []
    for (x, y), (dx, dy) in zip(path[:-1], np.diff(path, axis=0), strict=True):
        forces.append(law.mean_force(p, x, y, dx, dy, h, z)[:2])
        before = heat.sum()
        law.go(p, x, y, dx, dy, h, z, heat)
        heats.append(heat.sum() - before)
    return np.array(forces), np.array(heats)


def around(steps: int, turns: int, circle: bool) -> np.ndarray:
    """A path to and fro, or in a circle, of REACH."""
    angle = 2.0 * math.pi * np.arange(turns * steps + 1) / steps
    return REACH * np.stack((np.cos(angle), np.sin(angle) if circle else 0.0 * angle), 1)


def test_four_slides_follow_masing() -> None:
    """Unloading is the first loading, doubled in force and way."""
    pairs = [(1e7, 100.0), (8e6, 200.0), (6e6, 300.0), (4e6, 400.0)]
    way = np.linspace(0.0, REACH, 4001)
    path = np.concatenate((way, REACH - 2.0 * way[1:]))
    forces, _ = follow(slides(*pairs), np.stack((path, 0.0 * path), 1))
    up, down = forces[:4000, 0], forces[4000:, 0]
    top = sum(min(k * REACH, force) for k, force in pairs)
    assert np.max(np.abs(top - down - 2.0 * up)) < 1e-12 * top
    loop = sum(4.0 * force * max(REACH - force / k, 0.0) for k, force in pairs)
    _, heats = follow(slides(*pairs), around(1000, 2, False))
    assert heats[-1000:].sum() == pytest.approx(loop, rel=1e-12)


def test_a_slide_is_dragged_like_a_weight_on_a_string() -> None:
    """Its equation, integrated by scipy: the foot moves along the string, by the pull's part along it."""
    k, force = STIFFNESS, FORCE
    r, generator = force / k, np.random.default_rng(3)
    record = as_record(law.Slide(k, force))
    for _ in range(40):
        z = r * math.sqrt(generator.uniform()) * np.array(_unit(generator.uniform(0.0, 7.0)))
        d = generator.uniform(0.1, 5.0) * r * np.array(_unit(generator.uniform(0.0, 7.0)))
        fx, fy, ex, ey, slid = law.slide(record, *z, *d)
        assert math.hypot(ex, ey) <= r * (1.0 + 1e-12)
        gained = 0.5 * k * (ex**2 + ey**2 - z @ z)
        assert fx * d[0] + fy * d[1] == pytest.approx(gained + force * slid, abs=1e-13 * force * r)
        mean, end = _dragged(z, d, r)
        np.testing.assert_allclose((ex, ey), end, atol=1e-7 * r)
        np.testing.assert_allclose((fx, fy), k * mean, atol=1e-6 * force)


def _unit(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)


def _dragged(z: np.ndarray, d: np.ndarray, r: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean and last stretch (m) of a string of length `r` whose end goes `d`: slack first, then taut."""
    free = min(1.0, float(np.max(np.roots([d @ d, 2.0 * z @ d, z @ z - r * r]).real)))
    state = np.array([*(z + free * d), *(free * (z + 0.5 * free * d))])
    if free < 1.0:
        state = solve_ivp(_taut, (free, 1.0), state, args=(d,), rtol=1e-10, atol=1e-16).y[:, -1]
    return state[2:], state[:2]


def _taut(_: float, state: np.ndarray, d: np.ndarray) -> np.ndarray:
    """A string that is taut gives way across itself only; its stretch, summed up, is behind it."""
    place = state[:2]
    return np.concatenate((d - (place @ d) / (place @ place) * place, place))


S = 0.01 * 0.03 * (0.012 / 1e-4) ** 3  # N s/m


def film(cavitation: int) -> Any:
    """A film whose unit of resistance is S."""
    return as_record(law.Film(0.03, 0.012, 1e-4, 0.01, cavitation))


@pytest.mark.parametrize(("cavitation", "reach"), [(1, 0.5 * math.pi), (0, math.pi)], ids=["torn", "whole"])
def test_a_film_in_any_direction(cavitation: int, reach: float) -> None:
    """Against quadrature of n n^T/H^3 over the half that is squeezed, or all round."""
    generator = np.random.default_rng(4)
    for _ in range(20):
        e, place, way = generator.uniform(0.0, 0.95), *generator.uniform(-math.pi, math.pi, 2)
        x, y = 1e-4 * e * math.cos(place), 1e-4 * e * math.sin(place)
        found = law.film_matrix(film(cavitation), x, y, math.cos(way), math.sin(way))
        for value, part in zip(found, ((2, 0), (1, 1), (0, 2)), strict=True):
            expected, _ = quad(_squeezed, way - reach, way + reach, (e, place, *part), limit=400)
            assert value == pytest.approx(S * expected, abs=1e-9 * S * (1 - e) ** -3)


def _squeezed(angle: float, e: float, place: float, cosines: int, sines: int) -> float:
    return math.cos(angle) ** cosines * math.sin(angle) ** sines / (1 - e * math.cos(angle - place)) ** 3


def test_a_stop_gives_back_what_it_takes_but_for_its_damping() -> None:
    stop = as_record(law.EndStop(1e-4, 1e10, 1.5, 0.0))
    lossy = as_record(law.EndStop(1e-4, 1e10, 1.5, 0.5))
    for before, after in ((0.9e-4, 1.2e-4), (1.5e-4, 1.1e-4), (1.2e-4, 1.2e-4 + 1e-11)):
        work = law.stop_mean(stop, before, after, 1e-5)[0] * (after - before)
        gained = law.stop_energy(stop, after) - law.stop_energy(stop, before)
        assert work == pytest.approx(gained, rel=1e-6)
        assert law.stop_mean(lossy, before, after, 1e-5)[0] * (after - before) >= gained
    assert law.stop_mean(lossy, 1.5e-4, 1.1e-4, 1e-6)[0] == 0.0  # it never pulls


@pytest.mark.parametrize("way", [(3e-6, 1e-6), (4e-5, -2e-5)], ids=["it sticks", "it slides"])
def test_slopes_of_the_mean_force(way: tuple[float, float]) -> None:
    """By differences: of a stop with damping all, of a slide that slides those along the way."""
    stop = law.Elements(slide=(law.Slide(),) * law.SLIDES, stop=law.EndStop(1e-5, 1e10, 1.5, 0.3))
    z = np.zeros(2 * law.SLIDES)
    z[:2] = 0.3 * REACH * np.array([0.1, 0.2])
    slips = bool(np.hypot(*(z[:2] + way)) > FORCE / STIFFNESS)
    assert slips == (way[0] > 1e-5)
    for p, across in ((as_record(stop), True), (slides((STIFFNESS, FORCE)), not slips)):

        def force(d: np.ndarray, p: Any = p) -> np.ndarray:
            return np.array(law.mean_force(p, 2e-5, 1e-5, d[0], d[1], 1e-5, z))

        d = np.array(way)
        slopes, directions = force(d)[2:].reshape(2, 2), [d / np.hypot(*d)]
        directions += [np.array([-directions[0][1], directions[0][0]])] if across else []
        for u in directions:
            found = (force(d + 1e-10 * u) - force(d - 1e-10 * u))[:2] / 2e-10
            assert np.hypot(*found) > 1e5
            assert slopes @ u == pytest.approx(found, rel=1e-4)


def test_dynamic_stiffness_of_circles() -> None:
    """What force does in a circle, over the amplitude: of slides and torn film as they are stepped."""
    omega, steps = 900.0, 2000
    p = law.Elements(
        slide=(law.Slide(STIFFNESS, FORCE), *(law.Slide(),) * 3), film=law.Film(0.03, 0.012, 1e-4, 0.01)
    )
    path = around(steps, 4, True)
    h = 2.0 * math.pi / omega / steps
    forces, _ = follow(as_record(p), path, h)
    middle = (0.5 * (path[1:] + path[:-1]) @ [1.0, 1.0j])[-steps:]
    found = np.mean((forces @ [1.0, 1.0j])[-steps:] / middle)
    expected = law.mount_dynamic_stiffness(p, omega, REACH)
    assert found == pytest.approx(expected[0, 0], rel=1e-4)
    assert expected[0, 0] == expected[1, 1]
    assert expected[0, 1] == expected[1, 0] == 0.0
    still = law.mount_dynamic_stiffness(p, omega)
    assert still[0, 0] == pytest.approx(STIFFNESS + 0.5j * omega * math.pi * S, rel=1e-12)


def test_dynamic_stiffness_of_what_is_linear() -> None:
    """Tensors and branches: k (W tau)^2/(1 + (W tau)^2) and k W tau/(1 + (W tau)^2)."""
    k, tau, omega = 5e6, 1e-3, 700.0
    p = law.Carrier(
        spring=law.Stiffness(1e7, 2e7, 1e5, -2e5), damper=law.Damping(10.0, 20.0, 1.0, 2.0),
        branch=(law.Branch(k, tau), *(law.Branch(),) * 2),
    )  # fmt: skip
    found = law.mount_dynamic_stiffness(p, omega)
    turn = omega * tau
    branch = k * (turn * turn + 1j * turn) / (1.0 + turn * turn)
    expected = np.array([[1e7, 1e5], [-2e5, 2e7]]) + 1j * omega * np.array([[10.0, 1.0], [2.0, 20.0]])
    np.testing.assert_allclose(found, expected + branch * np.eye(2), rtol=1e-12)
    # going round either way: the mean of both directions, to which what is antisymmetric is a loss
    for sense in (1.0, -1.0):
        linear = 1.5e7 + 1j * (15.0 * sense * omega - 1.5e5) - 0.5 * sense * omega
        around = law.circle_stiffness(p, sense * omega)(0.0)
        assert around == pytest.approx(linear + (branch if sense > 0.0 else branch.conjugate()), rel=1e-12)
