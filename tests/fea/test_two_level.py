"""Conjugate gradients on two levels beside a factorisation of the same matrix."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.linear_solver import ConstrainedSystem
from fea.core.material import Material
from fea.cut import local_model
from fea.cut.local_model import LocalModel
from fea.cut.region import pieces
from fea.cut.two_level import TwoLevel
from geometry import CutPin, Hole, Pin, Segment
from geometry.mesh.cut_piece import piece_mesh

STEEL = Material("steel", 2.1e11, 0.3)
D = 0.02
(PIECE,) = pieces(CutPin(Pin("bar", (Segment(0.16, D),)), (Hole(0.08, 0.2 * D),)), ())
MESH = piece_mesh(PIECE, 1.0)


def test_a_held_body_as_by_a_factorisation() -> None:
    """Forces at random nodes, in two columns of very different size; one is none at all."""
    model = LocalModel(PIECE, MESH, STEEL)
    free = np.ones(model.unknowns)
    held = model.space.basis.get_dofs(model.space.mesh.boundaries["end"]).flatten()
    free[(3 * held[:, None] + np.arange(3)).ravel()] = 0.0
    forces = np.random.default_rng(1).normal(size=(model.unknowns, 3)) * [1.0, 1e-3, 0.0]
    found = TwoLevel(model.space, model.stiffness).solve(free, np.zeros(0, dtype=int), forces)
    assert found is not None
    assert not found[free == 0.0].any()
    system = ConstrainedSystem(model.stiffness, np.arange(model.unknowns) // 3)
    known = system.solve(model.stiffness.copy(), free, forces)
    assert np.abs(found - known).max(axis=0) == pytest.approx(0.0, abs=1e-5 * np.abs(known).max())


@pytest.mark.parametrize("component", [2, 4, 5])
def test_stress_about_a_hole_as_by_a_factorisation(
    component: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In tension and shear, by classes with and without rigid motions that nothing holds."""
    model = LocalModel(PIECE, MESH, STEEL)
    stress = np.zeros((*model.images.shape[:2], 6, 1))
    stress[:, :, component] = 1.0 + model.images[..., 1:2] / D
    monkeypatch.setattr(local_model, "FACTORED", model.unknowns)
    known = model.solve(stress)
    monkeypatch.setattr(local_model, "FACTORED", 0)
    found = model.solve(stress)
    assert not np.array_equal(found.stress, known.stress)
    assert found.stress == pytest.approx(known.stress, abs=1e-5 * np.abs(known.stress).max())
    assert found.moved == pytest.approx(known.moved, abs=1e-5 * np.abs(known.moved).max())
