"""The harmonic model: symmetry, superposition, balance, equilibrium, loads on the whole pin."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import BODY_SURFACE, Floats, PinLoads, UnitLoad
from fea.core.tractions import closing_tractions
from fea.harmonic.assembly import Section
from fea.harmonic.first_mesh import FirstMesh
from fea.harmonic.model import HarmonicModel, body_force, rigid_motions
from fea.harmonic.stress_recovery import NO_POINTS, reading
from fea.harmonic.superposition import Circumference
from geometry import Pin, Segment
from geometry.mesh.section_mesh import MeridianMesh, SectionSize, meridian_mesh
from tests.support.each import each
from tests.support.errors import raises
from tests.support.exact.exact_fields import displacements_of

PIN = Pin(
    "P",
    (
        Segment(0.02, 0.03, connection="A"),
        Segment(0.03, 0.02, connection="B"),
        Segment(0.02, 0.025, connection="C"),
    ),
    fillet=0.002,
)


@pytest.fixture(scope="module")
def section() -> MeridianMesh:
    return meridian_mesh(PIN, SectionSize())


def some_loads(distribution: str = "uniform", seed: int = 0) -> PinLoads:
    """On all bands, at three instants, and on the whole."""
    chance = np.random.default_rng(seed)
    force, moment = chance.normal(size=(3, 3, 3)) * 1e3, chance.normal(size=(3, 3, 3)) * 10.0
    body = chance.normal(size=(3, 3)) * 100.0
    names = ("A", "B", "C")
    if distribution == "cosine":
        return PinLoads("case", names, force, moment, "cosine", body)
    return PinLoads("case", names, force, moment, "uniform", body)


@each("distribution", ["uniform", "cosine"])
@each("clamps", [(), ("start",)])
def test_turned_loads_turn_the_answer(
    distribution: str, clamps: tuple[str, ...], section: MeridianMesh, steel: Material
) -> None:
    """Stress at turned angles, 1e-10 of the peak; and so the maxima."""
    loads = some_loads(distribution)
    turned = loads.turned(0.7)
    fields = HarmonicModel(PIN, section, steel, clamps).solve(tuple(loads.coefficients()))
    one, other = Circumference(fields, loads), Circumference(fields, turned)
    points = np.arange(0, len(fields.points), 7)
    angles = np.linspace(0.0, 5.0, 9)
    for instant in range(3):
        a, b = one.stress(points, instant, angles), other.stress(points, instant, angles + 0.7)
        assert b == pytest.approx(a, abs=1e-10 * np.abs(a).max())
    everywhere = np.ones(len(fields.points), dtype=bool)
    assert other.maxima(everywhere) == pytest.approx(one.maxima(everywhere), rel=1e-10)


def test_superposition_is_solving_at_once(section: MeridianMesh, steel: Material) -> None:
    """The tractions of several unit loads summed first, then solved: 1e-10 of the peak."""
    units = tuple(UnitLoad(name, "force", 1) for name in "ABC")
    amount = np.array([300.0, -700.0, 500.0])
    model = HarmonicModel(PIN, section, steel, ("start",))
    forces, _ = model._applied(1, list(units))
    at_once = model.displace(1, (forces @ amount)[:, None])[:, 0]
    summed = model.displace(1, forces) @ amount
    assert at_once == pytest.approx(summed, abs=1e-10 * np.abs(summed).max())
    _, tractions = model._applied(1, list(units))
    read = reading(model.space, model.outline, steel, model.clamps)
    _, expected = read.of(1, displacements_of(at_once), (tractions @ amount)[..., None])
    together = model.solve(units).stress @ amount
    assert together == pytest.approx(expected[..., 0], abs=1e-10 * np.abs(together).max())


@pytest.mark.parametrize("pivot", [0.3, 1.0])
def test_balanced_pins_do_not_depend_on_the_pivot(
    pivot: float, section: MeridianMesh, steel: Material
) -> None:
    """1e-9 of each unit load's peak; and displacements differ, or the test tested nothing."""
    units = (*some_loads().coefficients(), UnitLoad("B", "pressure", 2))
    models = [HarmonicModel(PIN, section, steel, ()) for _ in range(2)]
    models[1].pivot = pivot
    a, b = (model.solve(units) for model in models)
    off = np.abs(a.stress - b.stress).max(axis=(0, 1)) / np.abs(a.stress).max(axis=(0, 1))
    assert off.max() < 1e-9
    moved = np.abs(a.displacement - b.displacement).max(axis=(0, 1))
    assert (moved / np.abs(a.displacement).max(axis=(0, 1))).max() > 0.1


def test_what_closes_the_balance(section: MeridianMesh, steel: Material) -> None:
    """Every unit load of a free pin ends without a resultant; closing tractions have one each."""
    model = HarmonicModel(PIN, section, steel, ())
    units = tuple(some_loads().coefficients())
    for n in (0, 1):
        modes = rigid_motions(model.space.nodes, n) * [1.0, 1.0 / PIN.length]
        here = [u for u in units if u.n == n]
        closed, _ = model._applied(n, here)
        alone, _ = HarmonicModel(PIN, section, steel, ("start",))._applied(n, here)
        assert np.abs(modes.T @ closed).max() < 1e-12 * np.abs(modes.T @ alone).max()
        assert np.abs(modes.T @ alone).max() > 0.5
    axial = closing_tractions(PIN, 0, 0)[0]
    assert {t.surface for t in axial} == {"A", "B", "C"}


def units_and_resultants() -> list[tuple[UnitLoad, tuple[float, float]]]:
    """Force, and moment about z = 0 or the axis, that each unit load must have."""
    found = []
    for name in "ABC":
        z = PIN.band(name).middle
        found += [
            (UnitLoad(name, "force", 1), (1.0, z)),
            (UnitLoad(name, "moment", 1), (0.0, 1.0)),
            (UnitLoad(name, "pressure", 1), (1.0, z)),
            (UnitLoad(name, "force", 0), (1.0, 0.0)),
            (UnitLoad(name, "moment", 0), (0.0, -1.0)),  # phase 1: sin psi = -1
            (UnitLoad(name, "pressure", 0), (0.0, 0.0)),
        ]
    return found


def test_clamps_answer_every_load(section: MeridianMesh, steel: Material) -> None:
    """The residual on held unknowns is minus the load: 1e-9 (the system's residual), and the load
    is what it is called: 1e-12.
    """
    model = HarmonicModel(PIN, section, steel, ("end",))
    for unit, expected in units_and_resultants():
        modes = rigid_motions(model.space.nodes, unit.n)
        forces = model._applied(unit.n, [unit])[0]
        assert (modes.T @ forces)[:, 0] == pytest.approx(expected, abs=1e-12)
        left = model.space.stiffness(steel, unit.n) @ model.displace(unit.n, forces) - forces
        held = np.zeros(len(left), dtype=bool)
        held[model._constrained(unit.n)] = True
        reaction = np.where(held[:, None], left, 0.0)
        assert (modes.T @ reaction)[:, 0] == pytest.approx([-x for x in expected], abs=1e-9)


def through(section_at: float, radius: float, solve: HarmonicModel, unit: UnitLoad) -> Floats:
    """Resultants of stress through a solid cross-section: n = 1: shear force along x and moment
    about y; n = 0: axial force and torque.
    """
    x, w = np.polynomial.legendre.leggauss(12)
    r, weight = radius * (x + 1.0) / 2.0, radius * w / 2.0
    points = np.stack([r, np.full_like(r, section_at)], axis=1)
    zz, tz, rz = solve.solve((unit,), points).stress[-len(r) :, [2, 3, 4], 0].T
    if unit.n:
        return np.pi * np.array([np.sum(weight * r * (rz - tz)), -np.sum(weight * r**2 * zz)])
    return 2.0 * np.pi * np.array([np.sum(weight * r * zz), np.sum(weight * r**2 * tz)])


def test_stress_carries_the_load(section: MeridianMesh, steel: Material) -> None:
    """Through the middle of the shaft, under a load beyond it: 2 % on the first mesh, which has an
    element per radius there.
    """
    cut, z = 0.03, PIN.band("C").middle
    model = HarmonicModel(PIN, section, steel, ("start",))
    force = through(cut, 0.01, model, UnitLoad("C", "force", 1))
    assert force == pytest.approx([1.0, z - cut], rel=2e-2)
    axial = through(cut, 0.01, model, UnitLoad("C", "force", 0))
    assert axial == pytest.approx([1.0, 0.0], rel=2e-2, abs=1e-9)
    # about z, phase 1: sin psi = -cos, so the amplitude of the torque through the cut is -1
    torque = through(cut, 0.01, model, UnitLoad("C", "moment", 0))
    assert np.abs(torque) == pytest.approx([0.0, 1.0], rel=2e-2, abs=1e-9)


def test_weight_needs_a_density(section: MeridianMesh) -> None:
    light = Material("?", 1e9, 0.3)
    with raises(SolveError, "no-density"):
        HarmonicModel(PIN, section, light, ("start",)).solve((UnitLoad(BODY_SURFACE, "body", 0),))


def test_inertia_sums_to_the_mass(section: MeridianMesh, steel: Material) -> None:
    """Along and across: rho V, of a mesh whose fillets are parabolas: 1e-5; and at the centroid."""
    space = Section(section)
    z = space.nodes[:, 1]
    model = HarmonicModel(PIN, section, steel, ("start",))
    assert steel.density is not None
    for n in (0, 1):
        forces = body_force(model.material, n, model.space.integrals)
        total = rigid_motions(space.nodes, n).T @ forces
        assert total[0] == pytest.approx(steel.density * PIN.volume, rel=1e-5)
    weighed = 2.0 * np.pi * np.sum(space.integrals * z) / PIN.volume
    across = rigid_motions(space.nodes, 1).T @ body_force(model.material, 1, model.space.integrals)
    assert across[1] / across[0] == pytest.approx(weighed, rel=1e-5)


def test_patterns_of_pressure_come_one_after_the_other(
    section: MeridianMesh, steel: Material
) -> None:
    """On the first mesh, whatever came before: stress and displacement as if solved together."""
    bands = PIN.connections

    def pressure(n: int, *amounts: float) -> UnitLoad:
        return UnitLoad("", "pressure", n, tuple(zip(bands, amounts, strict=False)))

    first = pressure(0, 1.0, -2.0), pressure(2, 0.5, 3.0)
    later = pressure(2, 1.0, 1.0), pressure(1, -1.0, 2.0), UnitLoad(bands[0], "force", 1)
    model = HarmonicModel(PIN, section, steel, ())
    mesh = FirstMesh()
    mesh.fields(lambda: model, ("mesh",), (first, NO_POINTS, ()))
    found = mesh.fields(lambda: model, ("mesh",), (later, NO_POINTS, ()))
    exact = model.solve((*first, *later))
    assert found.loads == exact.loads
    for name in ("stress", "displacement"):
        one, other = getattr(found, name), getattr(exact, name)
        assert np.abs(one - other).max(axis=(0, 1)) == pytest.approx(
            0.0, abs=1e-9 * np.abs(other).max()
        )
