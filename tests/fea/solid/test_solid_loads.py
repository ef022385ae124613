"""Bearing pressure and loads on the whole pin; the closed balance of a pin that nothing holds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.equilibrium import out_of_balance
from fea.core.linear_solver import SolveError, factorize
from fea.core.material import Material
from fea.core.pin_loads import BODY_SURFACE, PinLoads, UnitLoad
from fea.core.requirement import Requirement
from fea.core.voigt import von_mises
from fea.solid import model as solid
from fea.solid import nodal_loads as solid_loads
from fea.solid.boundary import Patch, resultants, surface
from fea.solid.model import SolidModel, acting
from fea.solid.nodal_loads import nodal_loads, with_closing_tractions
from fea.solid.superposition import envelope
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.errors import raises
from tests.support.pins.solid_line import axial_stress
from tests.support.pins.unit_loads import at, forces, moments

FREE = Pin(
    "P",
    (
        Segment(0.02, 0.02, connection="A"),
        Segment(0.03, 0.02),
        Segment(0.02, 0.03, connection="B"),
        Segment(0.03, 0.02),
        Segment(0.02, 0.02, connection="C"),
    ),
)
BODIES = tuple((UnitLoad(BODY_SURFACE, "body", n), p) for n, p in ((1, 0), (1, 1), (0, 0)))


@pytest.fixture(scope="module")
def model(steel: Material) -> SolidModel:
    return SolidModel(FREE, solid_mesh(FREE, MeshSize(across=2.5, corner=1.0)), steel, ())


def test_loads_on_the_whole_pin_are_its_mass(steel: Material) -> None:
    """Along each axis, through its centre of gravity: here a cone of two steps, 1e-3 by the mesh's
    volume.
    """
    pin = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")))
    space = SolidModel(pin, solid_mesh(pin, MeshSize(across=3.0)), steel, ()).space
    F = nodal_loads(pin, steel, space, surface(space), BODIES).forces
    assert steel.density is not None
    mass = steel.density * pin.volume
    found = resultants(space.nodes, F)
    assert found[:3] == pytest.approx(mass * np.eye(3), rel=1e-3, abs=1e-9 * mass)
    thick, thin = 0.02 * 0.03**2, 0.04 * 0.02**2
    centre = (thick * 0.01 + thin * 0.04) / (thick + thin)
    assert found[4, 0] == pytest.approx(mass * centre, rel=1e-3)
    assert found[3, 1] == pytest.approx(-mass * centre, rel=1e-3)


def test_a_hanging_bar_carries_its_weight(steel: Material) -> None:
    """rho g (L - z) all over the section, a diameter from the clamp; and the clamp the weight."""
    pin = Pin("bar", (Segment(0.1, 0.02, connection="B"),))
    model = SolidModel(pin, solid_mesh(pin, MeshSize(across=3.0, corner=1.0)), steel, ("start",))
    fields = model.solve(acting([PinLoads("own", (), np.zeros((1, 0, 3)), np.zeros((1, 0, 3)),
                                          body=np.array([0.0, 0.0, 9.81]))]))  # fmt: skip
    assert steel.density is not None
    z = np.linspace(0.03, 0.09, 7)
    found = axial_stress(fields, np.array([9.81]), 0.01, 0.0, z)
    assert found == pytest.approx(steel.density * 9.81 * (0.1 - z), rel=5e-3)
    assert fields.support[2, 0] == pytest.approx(-steel.density * pin.volume, rel=1e-3)
    bare = replace(steel, density=None)
    with raises(SolveError, "no-density", "steel"):
        SolidModel(pin, solid_mesh(pin, MeshSize(across=2.0)), bare, ("start",)).solve(BODIES)


def test_far_from_the_band_a_pressure_is_its_force(steel: Material) -> None:
    """A bearing pressure and a uniform traction of the same force differ where they act and not two
    diameters away, where only the mesh's 1e-3 remains (Saint-Venant).
    """
    pin = Pin("bar", (Segment(0.06, 0.02), Segment(0.02, 0.02, connection="B")))
    mesh = solid_mesh(pin, MeshSize(across=4.0, corner=1.0))
    uniform = PinLoads("case", ("B",), np.array([[[300.0, 1000.0, 0.0]]]))
    cosine = replace(uniform, distribution="cosine")
    fields = SolidModel(pin, mesh, steel, ("start",)).solve(acting([uniform, cosine]))
    s = [fields.stress @ fields.coefficients(case)[0] for case in (uniform, cosine)]
    assert len(fields.loads) == 2 + 1 + 4 * 2
    z = fields.space.nodes[:, 2]
    size = np.abs(s[0]).max()
    assert np.abs(s[0] - s[1])[z < 0.02].max() < 1e-3 * size
    assert np.abs(s[0] - s[1])[z > 0.06].max() > 0.02 * size
    # on the pushed side the pressure is 4 F / (pi D L), on the other nothing, but for the terms
    # beyond the sixth harmonic: (2 p0 / pi) / (2 * 6 + 2)
    size = math.hypot(300.0, 1000.0)
    p0 = 4.0 * size / (math.pi * 0.02 * 0.02)
    boundary = fields.surface
    at_nodes = nodal_loads(pin, steel, fields.space, boundary, fields.loads).traction
    t = at_nodes @ fields.coefficients(cosine)[0]
    x = fields.space.nodes[boundary.corners]
    on = np.isin(boundary.facets, fields.space.mesh.boundaries["B"])
    angle = np.arctan2(x[on][..., 1], x[on][..., 0]) - math.atan2(1000.0, 300.0)
    expected = -p0 * np.maximum(-np.cos(angle), 0.0)
    radial = np.sum(t[on][..., :2] * x[on][..., :2], axis=-1) / 0.01
    assert np.abs(radial - expected).max() < 2.0 * p0 / math.pi / 14.0 + 1e-3 * p0


def test_a_pressure_turns_with_its_force(steel: Material) -> None:
    """Many unit loads, and few: both ways to the envelope give the same."""
    pin = Pin("bar", (Segment(0.02, 0.02), Segment(0.02, 0.02, connection="B")))
    mesh = solid_mesh(pin, MeshSize(across=2.5, corner=1.0))
    rng = np.random.default_rng(0)
    force = rng.standard_normal((20, 1, 3)) * [1.0, 1.0, 0.0]
    case = PinLoads("case", ("B",), force, distribution="cosine", terms=8)
    fields = SolidModel(pin, mesh, steel, ("start",)).solve(acting([case]) + moments("B"))
    found = envelope(fields, case)
    assert len(fields.loads) > 12
    less = replace(fields, loads=fields.loads[:-3], stress=fields.stress[..., :-3])
    assert len(less.loads) <= 12
    assert envelope(less, case).maximum == pytest.approx(found.maximum, rel=1e-9)
    assert envelope(less, case.turned(2 * math.pi / 9)).maximum == pytest.approx(
        found.maximum, rel=1e-9
    )
    brute = von_mises(fields.stress[fields.surface.nodes] @ fields.coefficients(case)[3])
    assert envelope(fields, case, directions=1).maxima[3] == pytest.approx(brute.max(), rel=1e-12)


def test_bands_take_up_what_is_left_over(model: SolidModel, steel: Material) -> None:
    """Nothing remains, to round-off, of force and moment of any load; what is added is constant or
    linear along z on every band, and nothing elsewhere.
    """
    units = forces("A", "C", along=(0, 1, 2)) + moments("B") + BODIES
    boundary = surface(model.space)
    loads = nodal_loads(FREE, steel, model.space, boundary, units)
    whole = with_closing_tractions(FREE, model.space, boundary, loads)
    size = np.abs(whole.forces).sum(axis=(0, 1))
    assert np.abs(resultants(model.space.nodes, whole.forces) / size).max() < 1e-13
    added = whole.traction - loads.traction
    on = [np.isin(boundary.facets, model.space.mesh.boundaries[name]) for name in "ABC"]
    assert np.abs(added[~np.any(on, axis=0)]).max() == 0.0
    largest = np.abs(added[..., 0, 0]).max()
    slopes, means = [], []
    for name, band in zip("ABC", on, strict=True):
        x_forces = added[band][..., 0, 0].ravel()
        z = model.space.nodes[boundary.corners[band]][..., 2].ravel() - FREE.band(name).middle
        line = np.polynomial.Polynomial.fit(z, x_forces, 1)
        assert np.abs(line(z) - x_forces).max() < 1e-3 * largest
        slopes.append(line.deriv()(0.0))
        means.append(line(0.0))
    assert np.ptp(slopes) < 1e-3 * np.abs(slopes).max()
    assert np.ptp(means) < 1e-3 * largest
    consistent = Patch(model.space, boundary, "B").nodal_forces(added[on[1]])
    assert np.abs(consistent.sum(axis=(0, 1))).max() > 0.0


def test_closed_stresses_do_not_depend_on_where_rigid_motions_are_removed(
    model: SolidModel, steel: Material
) -> None:
    """Of every unit load by itself, none of which is in balance."""
    units = forces("A", along=(0, 1, 2)) + moments("C") + BODIES
    units += ((UnitLoad("A", "pressure", 1), 0), (UnitLoad("A", "pressure", 2), 1))
    other = SolidModel(FREE, solid_mesh(FREE, MeshSize(across=2.5, corner=1.0)), steel, ())
    singularities = ([0, 0, 0], [0, 0, 0.12], [0.01, 0, 0.06])
    a, b, c = (int(np.linalg.norm(other.space.nodes - x, axis=1).argmin()) for x in singularities)
    other.__dict__["fixed"] = np.sort([3 * a, 3 * a + 1, 3 * a + 2, 3 * b, 3 * b + 1, 3 * c + 1])
    assert set(other.fixed.tolist()) != set(model.fixed.tolist())
    one, two = model.solve(units).stress, other.solve(units).stress
    assert np.abs((one - two).max(axis=(0, 1)) / np.abs(one).max(axis=(0, 1))).max() < 1e-9


def test_loads_in_balance_close_nothing(model: SolidModel, steel: Material) -> None:
    """Three-point bending: the sum of what closes each load vanishes, so the tractions on bands are
    the loads' own.
    """
    fields = model.solve(forces("A", "B", "C"))
    c = at(fields, A=(0.0, -500.0, 0.0), B=(0.0, 1000.0, 0.0), C=(0.0, -500.0, 0.0))
    boundary = surface(model.space)
    loads = nodal_loads(FREE, steel, model.space, boundary, fields.loads)
    added = (
        with_closing_tractions(FREE, model.space, boundary, loads).traction - loads.traction
    ) @ c
    assert np.abs(added).max() < 1e-9 * np.abs(loads.traction @ c).max()


def test_the_own_weight_counts_in_the_balance(steel: Material) -> None:
    """Half the weight at each end holds the pin up; without density the same forces do not."""
    assert steel.density is not None
    weight = steel.density * 9.81 * FREE.volume
    forces = np.array([[[0.0, 0.5 * weight, 0.0], [0.0, 0.5 * weight, 0.0]]])
    loads = PinLoads("own", ("A", "C"), forces, body=np.array([0.0, -9.81, 0.0]))
    found = out_of_balance(FREE, loads, steel.density)
    assert found.refusal is None
    assert found.force == pytest.approx(0.0, abs=1e-12 * weight)
    found = out_of_balance(FREE, loads)
    assert found.code == "force-imbalance"
    assert found.force == pytest.approx(2.0 * found.largest)


def test_one_band_alone_holds_nothing(steel: Material) -> None:
    pin = Pin("P", (Segment(0.02, 0.02, connection="B"),))
    loads = PinLoads("case", ("B",), np.array([[[0.0, 1.0, 0.0]]]))
    (found,) = solve_pin(pin, steel, (), (loads,), Requirement(0.5, model="solid"))
    assert found.peak.verdict == "rigid"
    assert found.answer is None
    assert found.peak.reasons == ("one-band",)
    still = PinLoads("still", ("A", "B"), np.zeros((1, 2, 3)))
    assert out_of_balance(FREE, still).refusal is None


def test_a_force_on_a_face_that_is_no_band_is_uniform(model: SolidModel, steel: Material) -> None:
    units = forces("end", along=(0, 1, 2))
    boundary = surface(model.space)
    loads = nodal_loads(FREE, steel, model.space, boundary, units)
    assert resultants(model.space.nodes, loads.forces)[:3] == pytest.approx(np.eye(3), abs=1e-12)
    on = np.isin(boundary.facets, model.space.mesh.boundaries["end"])
    area = math.pi * 0.01**2  # to what the mesh's sides cut off the circle
    assert loads.traction[on] == pytest.approx(
        np.broadcast_to(np.eye(3) / area, (on.sum(), *loads.traction.shape[1:])), rel=0.01
    )
    assert not loads.traction[~on].any()


def test_a_mesh_that_cuts_too_much_off_a_band_is_refused(
    model: SolidModel, steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(solid_loads, "MAX_CURVED_AREA_LOSS", 1e-7)
    with raises(SolveError, "area-mismatch", "surface A"):
        nodal_loads(FREE, steel, model.space, surface(model.space), forces("A"))


def test_loads_that_do_not_sum_to_their_resultant_are_refused(
    model: SolidModel, steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    true = Patch.exactly
    monkeypatch.setattr(Patch, "exactly", lambda *given: (1.0 + 1e-6) * true(*given))
    with raises(SolveError, "resultant-mismatch", "pin P", " A "):
        nodal_loads(FREE, steel, model.space, surface(model.space), forces("A"))


def test_clamps_that_do_not_answer_the_loads_are_noticed(
    steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As from a solver that is a thousandth off."""

    def off(*system: object) -> object:
        solve = factorize(*system)  # type: ignore[arg-type]
        return lambda b: 1.001 * solve(b)

    monkeypatch.setattr(solid, "factorize", off)
    pin = Pin("P", (Segment(0.02, 0.02, connection="B"),))
    held = SolidModel(pin, solid_mesh(pin, MeshSize(across=2.0)), steel, ("start",))
    with raises(SolveError, "no-equilibrium"):
        held.solve(forces("B"))


def test_no_band_can_close_the_balance_of_a_pin_without_any(steel: Material) -> None:
    pin = Pin("P", (Segment(0.02, 0.02),))
    lone = SolidModel(pin, solid_mesh(pin, MeshSize(across=2.0)), steel, ())
    with raises(SolveError, "unconstrained"):
        lone.solve(BODIES)
