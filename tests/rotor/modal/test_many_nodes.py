"""Rotors with more nodes than are kept as modes or followed for their stresses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from touchdown.rotor.beams.element import split_element
from touchdown.rotor.beams.shaft import Shaft, Support
from touchdown.rotor.file import rotor_named
from touchdown.rotor.modal.data import MAX_ENDS, MAX_MODES, tabulate
from touchdown.rotor.modal.modal_stresses import watched_nodes
from touchdown.rotor.modal.modes import basis, flexibility, fullest
from touchdown.rotor.modal.whirl_speeds import critical_speeds


def finer(name: str, count: int) -> Shaft:
    """A shipped rotor with each of its elements divided."""
    shaft = rotor_named(name)

    def moved(things):
        return tuple(replace(t, node=(t.node - 1) * count + 1) for t in things)

    return replace(
        shaft,
        elements=tuple(piece for e in shaft.elements for piece in split_element(e, count)),
        points=moved(shaft.points),
        unbalances=moved(shaft.unbalances),
        stations=moved(shaft.stations),
        sensors=moved(shaft.sensors),
    )


FINE = finer("rotor_II", 3)  # 73 nodes
HELD = [s.node for s in FINE.stations]


def test_modes_by_either_solver_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    few = basis(FINE, 20)
    monkeypatch.setattr("touchdown.rotor.modal.modes.MAX_SOLVED", 2 * FINE.nodes)
    dense = basis(FINE, 20)
    assert few.omega == pytest.approx(dense.omega, rel=1e-9)
    assert np.abs(few.shapes - dense.shapes).max() < 1e-6 * np.abs(dense.shapes).max()


def test_held_nodes_keep_their_flexibility() -> None:
    """With residual vectors, a stiff support meets what it meets of the whole."""
    kept = fullest(FINE, HELD)
    elastic = kept.deflections(HELD)[:, 2:]
    there = elastic @ (elastic.T / kept.omega[2:, None] ** 2)
    whole = flexibility(FINE, HELD)[[2 * (node - 1) for node in HELD]]
    assert there == pytest.approx(whole, rel=1e-6, abs=1e-6 * np.abs(whole).max())
    held = [Support(FINE.node(name), 5e9) for name in ("A", "B")]
    coarse = critical_speeds(
        basis(rotor_named("rotor_II"), 0), [replace(s, node=(s.node - 1) // 3 + 1) for s in held]
    )
    assert critical_speeds(kept, held)[:3] == pytest.approx(coarse[:3], rel=5e-3)


def test_the_stresses_of_watched_nodes_are_theirs() -> None:
    """Rows of the table against those of all nodes."""
    table = tabulate(FINE, 10, 1).stress
    nodes, rows = watched_nodes(FINE), int(table.ends)
    assert rows <= MAX_ENDS
    assert [nodes[int(place)] for place in table.place[:rows]] == [int(n) for n in table.node[:rows]]
    assert set(table.node[:rows]) == set(nodes)
    assert table.bending.shape == (MAX_MODES, MAX_ENDS)


def test_a_thousand_nodes() -> None:
    fine = finer("rotor_II", 42)
    assert fine.nodes > 1000
    assert basis(fine, 8).omega[2:] == pytest.approx(basis(finer("rotor_II", 4), 8).omega[2:], rel=2e-3)
