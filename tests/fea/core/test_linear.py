"""Solvers: both agree, and neither solves what is not held."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from fea.core import linear_solver as linear
from fea.core.linear_solver import ConstrainedSystem, SolveError, factorize
from fea.core.material import Material
from fea.solid.assembly import Discretisation
from fea.solid.boundary import clamped_nodes
from geometry import Pin
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.each import each
from tests.support.errors import raises


@pytest.fixture(scope="module")
def system(steel: Material) -> tuple[sp.csr_matrix, np.ndarray, np.ndarray]:
    from geometry import Segment

    pin = Pin("P", (Segment(0.03, 0.02, connection="B"),))
    space = Discretisation(solid_mesh(pin, MeshSize(across=2.0)).mesh)
    held = clamped_nodes(space, ("start",))
    free = np.setdiff1d(np.arange(space.unknowns), (3 * held[:, None] + np.arange(3)).ravel())
    return space.stiffness(steel), free, free // 3


@each("cholmod", [True, False])
@each("metis", [True, False])
def test_all_solvers_and_orders_agree(
    system: tuple[sp.csr_matrix, np.ndarray, np.ndarray],
    monkeypatch: pytest.MonkeyPatch,
    cholmod: bool,
    metis: bool,
) -> None:
    """To round-off: both are backward stable, so each is off the exact solution by the condition
    number (5e3) times a few units of round-off, and so is one that sums in another order, as with
    one right-hand side instead of two.
    """
    K, free, node = system
    K = K[free][:, free]
    b = np.random.default_rng(1).standard_normal((len(free), 2))
    one = factorize(K, node)(b)
    monkeypatch.setattr(linear, "has_cholmod", lambda: cholmod)
    monkeypatch.setattr(linear, "has_metis", lambda: metis)
    two, first = factorize(K, node)(b), factorize(K, node)(b[:, 0])
    off = 10.0 * np.linalg.cond(K.toarray()) * np.finfo(float).eps  # 1e-11
    assert np.linalg.norm(one - two) < off * np.linalg.norm(one)
    assert np.linalg.norm(first - two[:, 0]) < off * np.linalg.norm(first)


def test_a_body_that_nothing_holds_is_refused(
    system: tuple[sp.csr_matrix, np.ndarray, np.ndarray],
) -> None:
    K, _, _ = system
    n = K.shape[0]
    with pytest.raises(SolveError) as error:
        factorize(K, np.arange(n) // 3)(np.ones(n))
    assert error.value.code in ("not-positive-definite", "ill-conditioned")


@each("cholmod", [True, False])
def test_an_indefinite_matrix_is_refused(monkeypatch: pytest.MonkeyPatch, cholmod: bool) -> None:
    monkeypatch.setattr(linear, "has_cholmod", lambda: cholmod)
    K = sp.diags_array([1.0, 2.0, -3.0]).tocsr()
    with raises(SolveError, "not-positive-definite"):
        factorize(sp.csr_matrix(K), np.arange(3))


def test_a_wrong_solution_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear, "has_cholmod", lambda: True)
    monkeypatch.setattr(linear._Cholmod, "factor", lambda self, K: lambda b: 1.001 * b)
    with raises(SolveError, "backward-error", "5.0e-04"):
        factorize(sp.csr_matrix(sp.eye_array(3)), np.arange(3))(np.ones(3))


@each("size", [1.0, 1e-9])
def test_one_wrong_solution_among_many_is_refused(
    monkeypatch: pytest.MonkeyPatch, size: float
) -> None:
    """However small its load is, and although another load is its opposite."""
    only = np.diag([1.0, 1.0, 1.0 + 1e-6])
    monkeypatch.setattr(linear, "has_cholmod", lambda: True)
    monkeypatch.setattr(linear._Cholmod, "factor", lambda self, K: lambda b: only @ b)
    loads = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, size, -size]])
    with raises(SolveError, "backward-error"):
        factorize(sp.csr_matrix(sp.eye_array(3)), np.arange(3))(loads)
    only[2, 2] = 1.0
    assert factorize(sp.csr_matrix(sp.eye_array(3)), np.arange(3))(loads) == pytest.approx(loads)


def test_a_solution_that_round_off_makes_is_refused() -> None:
    """A chain of springs that almost nothing holds: its factor exists, and says nothing."""
    n, ground = 400, 1e-14
    spring = np.random.default_rng(1).uniform(0.5, 2.0, n - 1)
    own = np.append(spring, ground) + np.append(0.0, spring)
    K = sp.diags_array([-spring, own, -spring], offsets=[-1, 0, 1])
    with raises(SolveError, "ill-conditioned"):
        factorize(sp.csr_matrix(K), np.arange(n))(np.random.default_rng(1).standard_normal(n))


def test_a_slender_bodys_solution_is_right_though_its_residual_is_large() -> None:
    """A clamped beam of Hermite elements against F L^3 / (3 E I), L = 2000 of its elements."""
    n = 2000
    k = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]], dtype=float)
    at = 2 * np.arange(n)[:, None] + np.arange(4)
    row, column = at.repeat(4, axis=1), np.tile(at, 4)
    full = sp.csr_matrix((np.tile(k.ravel(), n), (row.ravel(), column.ravel())))
    K = sp.csr_matrix(full[2:, 2:])
    b = np.zeros(2 * n)
    b[-2] = 1.0
    x = factorize(K, np.arange(2 * n) // 2)(b)
    assert np.linalg.norm(K @ x - b) > 1e-6  # what was refused above 1e-5 of the load
    assert x[-2] == pytest.approx(n**3 / 3.0, rel=1e-3)


def test_no_load_has_no_solution_to_doubt() -> None:
    assert not factorize(sp.csr_matrix(sp.eye_array(3)), np.arange(3))(np.zeros((3, 2))).any()


def test_superlu_tells_a_singular_matrix(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(linear, "has_cholmod", lambda: False)
    K = sp.csr_matrix(np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]))
    with raises(SolveError, "singular-matrix"):
        factorize(K, np.arange(3))


def test_a_factor_that_is_kept_solves_after_another_matrix() -> None:
    K = sp.csr_matrix(np.diag([2.0, 3.0, 4.0]) + 0.5)
    system, free = ConstrainedSystem(K.copy()), np.array([1.0, 0.0, 1.0])
    forces = np.array([[1.0], [5.0], [2.0]])
    expected = system.solve(K.copy(), free, forces)
    solve = system.kept(K.copy(), free)
    system.solve(7.0 * K, np.ones(3), forces)
    assert np.array_equal(solve(forces), expected)
    assert expected[1, 0] == 0.0
