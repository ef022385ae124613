"""Conjugate gradients on two levels beside a factorisation of the same matrix."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.linear_solver import ConstrainedSystem
from fea.core.material import Material
from fea.cut import piece_system
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
    free = np.ones(model.space.unknowns)
    held = model.space.basis.get_dofs(model.space.mesh.boundaries["end"]).flatten()
    free[(3 * held[:, None] + np.arange(3)).ravel()] = 0.0
    forces = np.random.default_rng(1).normal(size=(model.space.unknowns, 3)) * [1.0, 1e-3, 0.0]
    found = TwoLevel(model.space, model.system.stiffness).solve(
        free, np.zeros(0, dtype=int), forces
    )
    assert found is not None
    assert not found[free == 0.0].any()
    system = ConstrainedSystem(model.system.stiffness, np.arange(model.space.unknowns) // 3)
    known = system.solve(model.system.stiffness.copy(), free, forces)
    assert np.abs(found - known).max(axis=0) == pytest.approx(0.0, abs=1e-5 * np.abs(known).max())


@pytest.mark.parametrize("twisted", [False, True])
def test_stress_about_a_hole_as_by_a_factorisation(
    twisted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In tension with bending, and in torsion: classes with rigid motions that nothing holds."""
    model = LocalModel(PIECE, MESH, STEEL)
    stress = np.zeros((*model.faces.images.shape[:2], 6, 1))
    x, y, _ = np.moveaxis(model.faces.images / D, -1, 0)
    if twisted:
        stress[..., 3, 0], stress[..., 4, 0] = x, -y
    else:
        stress[..., 2, 0] = 1.0 + y
    monkeypatch.setattr(piece_system, "MAX_FACTORED_UNKNOWNS", model.space.unknowns)
    known = model.solve(stress)
    monkeypatch.setattr(piece_system, "MAX_FACTORED_UNKNOWNS", 0)
    found = model.solve(stress)
    assert not np.array_equal(found.stress, known.stress)
    assert found.stress == pytest.approx(known.stress, abs=1e-5 * np.abs(known.stress).max())
    apart, known_apart = (np.diff(read.moved, axis=0) for read in (found, known))  # of both ends
    assert apart == pytest.approx(known_apart, abs=1e-5 * np.abs(known_apart).max())


def test_what_brings_little_is_solved_less_accurately(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two loads alike in size, one of which brings a thousandth of the stress of any case: the
    other one to 1e-5 as ever, and the two in the amounts in which they act.
    """
    model = LocalModel(PIECE, MESH, STEEL)
    stress = np.zeros((*model.faces.images.shape[:2], 6, 2))
    stress[..., 2, 0], stress[..., 2, 1] = 1.0, model.faces.images[..., 1] / D
    monkeypatch.setattr(piece_system, "MAX_FACTORED_UNKNOWNS", model.space.unknowns)
    known = model.solve(stress).stress
    monkeypatch.setattr(piece_system, "MAX_FACTORED_UNKNOWNS", 0)
    weight = np.array([1.0, 1e-3])
    found = model.solve(stress, weight=weight).stress
    off, most = (np.abs(x).max(axis=(0, 1)) for x in (found - known, known))
    assert off[0] < 1e-5 * most[0]
    assert 1e-8 * most[1] < off[1] < 1e-2 * most[1]
    assert np.abs((found - known) @ weight).max() < 2e-5 * most[0]
