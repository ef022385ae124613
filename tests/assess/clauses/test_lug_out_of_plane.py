"""Lugs bent out of their plane: statics by hand, and a plate of solid elements."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import skfem
from skfem.helpers import ddot, eye, sym_grad, trace

from assess.clauses.lug_out_of_plane import (
    STRUCTURE_NEED,
    PlateSection,
    _Actions,
    _corner,
    _face,
    lug_out_of_plane,
)
from assess.margin import Margin
from assess.situation import LoadFactors, Situation
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug, Shank
from geometry import Pin, Segment

STEEL = Material("steel", 210e9, 0.3, None, 500e6, 700e6)
WIDTH, THICK, LONG, HOLE = 0.05, 0.02, 0.1, 0.02
FORCE = np.array([10e3, 1e3, 2e3])  # along the shank, across it, along the pin
OUTLINE = Shank("round", WIDTH, LONG, WIDTH / 2.0)
PIN = Pin("P", (Segment(THICK, HOLE, connection="A"), Segment(THICK, HOLE, connection="B")))


def situation(
    force: np.ndarray = FORCE,
    moment: tuple[float, float, float] = (0.0, 0.0, 0.0),
    degrees: float = 0.0,
    shank: Shank | None = OUTLINE,
) -> Situation:
    """Lug A under a force and a moment in the axes of its shank; the link at B balances them."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    f, m = force @ turn, np.array(moment) @ turn
    other = -m - np.cross([0.0, 0.0, -THICK], f)  # about the middle of B
    loads = PinLoads("side", ("A", "B"), np.array([[f, -f]]), np.array([[m, other]]))
    a = shank and replace(shank, angle=math.radians(degrees))
    lugs = Lug("A", WIDTH, STEEL, shank=a), Lug("B", WIDTH, STEEL)
    return Situation(PIN, STEEL, loads, lugs=lugs, sized=lugs, factors=LoadFactors())


def of_a(s: Situation) -> Margin:
    """The margin of A against yield; B has no shank."""
    first, *others = lug_out_of_plane(s)
    assert others[-1].needs == "pin.P.lug.B.shank"
    assert first.level == "limit"
    assert first.at == "A"
    return first


@pytest.mark.parametrize("degrees", [0.0, 37.0, 180.0])
def test_where_the_shank_is_held(degrees: float) -> None:
    """10 kN on 50 x 20 mm are 10 MPa, 1 kN over 100 mm 12 MPa, 2 kN over 100 mm 60 MPa."""
    margin = of_a(situation(degrees=degrees))
    assert margin.demand == pytest.approx(82e6)
    assert margin.allowable == 500e6
    assert margin.basis == "nominal stress where it is held"
    assert margin.work[0].result.value == margin.demand


def test_beside_the_bore() -> None:
    """A moment that the force along the pin balances where the shank is held: 200 N m on walls of
    30 mm in all, W = 30 x 20^2 / 6 mm^3, are 100 MPa, and 10 kN on 600 mm^2 16.7.
    """
    margin = of_a(situation(moment=(0.0, -200.0, 0.0)))
    assert margin.demand == pytest.approx(100e6 + 10e3 / 600e-6)
    assert margin.basis == "nominal stress beside the bore"


def test_the_shortest_margin_over_a_motion() -> None:
    s = situation()
    forces = np.concatenate([0.5 * s.loads.forces, s.loads.forces])
    moments = np.concatenate([0.5 * s.loads.moments, s.loads.moments])
    loads = PinLoads("side", ("A", "B"), forces, moments, times=np.array([0.0, 2.0]))
    margin = of_a(replace(s, loads=loads))
    assert margin.demand == pytest.approx(82e6)
    assert margin.time == 2.0


def test_the_thickness_that_would_just_pass() -> None:
    """Of the statics above, with ten times the force."""
    margin = of_a(situation(force=10.0 * FORCE))
    assert margin.passing is not None
    t = margin.passing.value
    N, M_in, M_out = 100e3, 1000.0, 2000.0
    stress = N / (WIDTH * t) + 6.0 * M_in / (WIDTH**2 * t) + 6.0 * M_out / (WIDTH * t**2)
    assert margin.used > 1.0
    assert t > THICK
    assert stress == pytest.approx(500e6, rel=1e-5)


def test_what_is_lacking_is_named() -> None:
    without = lug_out_of_plane(situation(shank=None))
    assert [m.needs for m in without] == ["pin.P.lug.A.shank, pin.P.lug.B.shank"]
    assert lug_out_of_plane(situation(force=FORCE * [1.0, 1.0, 0.0])) != []  # B takes the couple
    plain = situation()
    flat = PinLoads("pull", ("A", "B"), plain.loads.forces * [1.0, 1.0, 0.0])
    assert lug_out_of_plane(replace(plain, loads=flat)) == []


def test_lugs_of_a_structure_that_react_are_named() -> None:
    """Their share is not known, so that the check is never complete."""
    plain = situation()
    alone = PinLoads("side", ("A",), plain.loads.forces[:, :1], plain.loads.moments[:, :1])
    *_, last = lug_out_of_plane(replace(plain, loads=alone))
    assert last.needs == STRUCTURE_NEED
    assert lug_out_of_plane(replace(plain, loads=alone, clamps=("B",)))[-1].needs == ""


@pytest.mark.parametrize("width", [0.02, 0.05, 0.4])
def test_torsion_of_a_rectangle(width: float) -> None:
    """Prandtl's membrane by finite elements; a thin strip has T / (b t^2 / 3)."""
    mesh = skfem.MeshQuad.init_tensor(np.linspace(0.0, width, 41), np.linspace(0.0, THICK, 41))
    basis = skfem.Basis(mesh, skfem.ElementQuad2())
    stiffness = skfem.BilinearForm(lambda u, v, w: u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1])
    load = skfem.LinearForm(lambda v, w: 2.0 * v).assemble(basis)
    phi = skfem.solve(*skfem.condense(stiffness.assemble(basis), load, D=basis.get_dofs()))
    torque = 2.0 * skfem.Functional(lambda w: w.phi).assemble(basis, phi=phi)
    edge = skfem.FacetBasis(mesh, skfem.ElementQuad2(), facets=mesh.facets_satisfying(
        lambda x: np.isclose(x[1], 0.0)))  # fmt: skip
    shear = np.abs(edge.interpolate(phi).grad[1]).max()
    section = PlateSection(width, THICK)
    assert section.modulus_torsion == pytest.approx(torque / shear, rel=2e-3)
    if width > 10.0 * THICK:
        assert section.modulus_torsion == pytest.approx(width * THICK**2 / 3.0, rel=0.05)


@pytest.mark.slow
def test_a_plate_of_solid_elements() -> None:
    """At half of its length a plate that is held at one end has the stress that statics gives, at
    its corners and, with torsion, at the middle of its sides.
    """
    half = np.array([WIDTH, THICK]) / 2.0
    mesh = skfem.MeshHex.init_tensor(
        np.linspace(0.0, LONG, 9),
        np.linspace(-half[0], half[0], 5),
        np.linspace(-half[1], half[1], 3),
    )
    vector = skfem.ElementVector(skfem.ElementHex2())
    basis = skfem.Basis(mesh, vector)
    lame, mu = 210e9 * 0.3 / (1.3 * 0.4), 210e9 / 2.6

    def stress(strain: Any) -> Any:
        return lame * eye(trace(strain), 3) + 2.0 * mu * strain

    stiffness = skfem.BilinearForm(lambda u, v, w: ddot(stress(sym_grad(u)), sym_grad(v)))
    end = skfem.FacetBasis(mesh, vector, facets=mesh.facets_satisfying(lambda p: p[0] < 1e-9))
    held = basis.get_dofs(mesh.facets_satisfying(lambda p: p[0] > LONG - 1e-9))
    area = WIDTH * THICK
    polar = area * (WIDTH**2 + THICK**2) / 12.0
    matrix = stiffness.assemble(basis)

    def largest(torque: float, corners: bool) -> float:
        def pull(v: Any, w: Any) -> Any:
            _, b, c = w.x
            across = FORCE[1] / area - torque * c / polar
            along = FORCE[2] / area + torque * b / polar
            return -FORCE[0] / area * v[0] + across * v[1] + along * v[2]

        u = skfem.solve(*skfem.condense(matrix, skfem.LinearForm(pull).assemble(end), D=held))
        found, scalar = (
            stress(sym_grad(basis.interpolate(u))),
            basis.with_element(skfem.ElementHex1()),
        )
        tensor = np.array([[scalar.project(found[i, j]) for j in range(3)] for i in range(3)])
        deviator = tensor - np.eye(3)[..., None] * np.trace(tensor) / 3.0
        von_mises = np.sqrt(1.5 * (deviator**2).sum(axis=(0, 1)))
        x = np.abs(mesh.p[1:].T / half)
        at = (x > 0.99).all(axis=1) if corners else np.isclose(x, [0, 1]).all(axis=1) | np.isclose(
            x, [1, 0]).all(axis=1)  # fmt: skip
        return float(von_mises[at & np.isclose(mesh.p[0], LONG / 2.0)].max())

    section, turned = PlateSection(WIDTH, THICK), np.array([[150.0, 0.0, 0.0]])
    corner, _ = _corner(section, _Actions(FORCE[None], 0.0 * turned), LONG / 2.0)
    side, _ = _face(section, _Actions(FORCE[None], turned), LONG / 2.0)
    assert largest(0.0, corners=True) == pytest.approx(float(corner[0]), rel=0.02)
    assert largest(150.0, corners=False) == pytest.approx(float(side[0]), rel=0.03)
