"""Solvers: both agree, and neither solves what is not held."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from fea import linear
from fea.elasticity import Discretisation
from fea.linear import SolveError, factorize
from fea.material import Material
from fea.surface import held_nodes
from geometry import Pin
from geometry.solid_mesh import MeshSize, solid_mesh


@pytest.fixture(scope="module")
def system(steel: Material) -> tuple[sp.csr_matrix, np.ndarray, np.ndarray]:
    from geometry import Segment

    pin = Pin("P", (Segment(0.03, 0.02, connection="B"),))
    space = Discretisation(solid_mesh(pin, MeshSize(across=2.0)).mesh)
    held = held_nodes(space, ("start",))
    free = np.setdiff1d(np.arange(space.unknowns), (3 * held[:, None] + np.arange(3)).ravel())
    return space.stiffness(steel), free, free // 3


def test_cholmod_and_superlu_agree(
    system: tuple[sp.csr_matrix, np.ndarray, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    K, free, node = system
    b = np.random.default_rng(1).standard_normal((len(free), 2))
    one = factorize(K[free][:, free], node)(b)

    def absent(*_: object) -> None:
        raise ImportError

    monkeypatch.setattr(linear, "_Cholmod", absent)
    two = factorize(K[free][:, free], node)(b)
    assert np.abs(one - two).max() < 1e-9 * np.abs(one).max()
    assert np.abs(factorize(K[free][:, free], node)(b[:, 0]) - two[:, 0]).max() == 0.0


def test_a_body_that_nothing_holds_is_refused(
    system: tuple[sp.csr_matrix, np.ndarray, np.ndarray],
) -> None:
    K, _, _ = system
    n = K.shape[0]
    with pytest.raises(SolveError, match=r"not positive definite|relative residual"):
        factorize(K, np.arange(n) // 3)(np.ones(n))


def test_an_indefinite_matrix_is_refused() -> None:
    K = sp.diags_array([1.0, 2.0, -3.0]).tocsr()
    with pytest.raises(SolveError, match="not positive definite"):
        factorize(sp.csr_matrix(K), np.arange(3))


def test_a_wrong_solution_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear._Cholmod, "factor", lambda self, K: lambda b: 1.001 * b)
    with pytest.raises(SolveError, match=r"relative residual of 1\.0e-03"):
        factorize(sp.csr_matrix(sp.eye_array(3)), np.arange(3))(np.ones(3))


def test_superlu_tells_a_singular_matrix(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(*_: object) -> None:
        raise ImportError

    monkeypatch.setattr(linear, "_Cholmod", absent)
    K = sp.csr_matrix(np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    with pytest.raises(
        SolveError, match=r"stiffness matrix is singular \(.*\): the pin is not held"
    ):
        factorize(K, np.arange(3))
