"""Strain energy: of bars and cantilevers in closed form, and of one model against another."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.requirement import Requirement
from fea.harmonic.first_mesh import FirstMesh
from fea.harmonic.model import HarmonicModel
from fea.harmonic.stress_recovery import NO_POINTS
from fea.solve.single_mesh import ModelMesh, Problem, result_on
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from geometry.mesh.section_mesh import SectionSize, meridian_mesh

A, L, F, T = 0.01, 0.3, 1000.0, 50.0
ROD = Pin("rod", (Segment(0.98 * L, 2.0 * A), Segment(0.02 * L, 2.0 * A, connection="P")))
AREA, INERTIA = math.pi * A**2, math.pi * A**4 / 4.0


def case(force: tuple[float, float, float], couple: tuple[float, float, float]) -> PinLoads:
    return PinLoads("c", ("P",), np.array([[force]]), np.array(couple))


def energy_on(loads: PinLoads, steel: Material) -> float:
    problem = Problem(ROD, replace(steel, poisson_ratio=0.0), ("start",), loads)
    found = result_on(problem, ModelMesh("harmonic"))
    assert found.energy is not None
    return found.energy.of(loads)


def bent(steel: Material) -> float:
    """F^2 a^3 / 6 E I to the band's middle, and of shear with the area of a round section: the rest
    of the band adds (l / a)^2, 1e-4.
    """
    a, E = 0.99 * L, steel.youngs_modulus
    shear = 0.5 * F**2 * a / (6.0 / 7.0 * E / 2.0 * AREA)
    return F**2 * a**3 / (6.0 * E * INERTIA) + shear


def test_closed_forms(steel: Material) -> None:
    """Without Poisson's ratio a hanging bar is one-dimensional, with a displacement that the
    elements hold exactly; a torque is so but for the load's band.
    """
    E, a = steel.youngs_modulus, 0.99 * L
    assert steel.density is not None
    weight = steel.density * AREA * 9.81
    body = np.array([[0.0, 0.0, 9.81]])
    hanging = PinLoads("c", ("P",), np.zeros((1, 1, 3)), body=body)
    assert energy_on(hanging, steel) == pytest.approx(weight**2 * L**3 / (6.0 * E * AREA), rel=1e-7)
    twisted = case((0.0, 0.0, 0.0), (0.0, 0.0, T))
    J = 2.0 * INERTIA
    assert energy_on(twisted, steel) == pytest.approx(T**2 * a / (2.0 * E / 2.0 * J), rel=1e-2)
    for force in ((F, 0.0, 0.0), (0.0, -F, 0.0), (0.6 * F, 0.8 * F, 0.0)):
        across = case(force, (0.0, 0.0, 0.0))
        assert energy_on(across, steel) == pytest.approx(bent(steel), rel=3e-3)


def test_loads_of_one_harmonic_work_on_each_other(steel: Material) -> None:
    """A force and the couple that bends the same way: energy is not the sum of both."""
    force, couple = case((F, 0.0, 0.0), (0.0, 0.0, 0.0)), case((0.0, 0.0, 0.0), (0.0, T, 0.0))
    both = case((F, 0.0, 0.0), (0.0, T, 0.0))
    a, E = 0.99 * L, steel.youngs_modulus
    mixed = F * T * a**2 / (2.0 * E * INERTIA)  # the couple on the slope by the force
    more = energy_on(both, steel) - energy_on(force, steel) - energy_on(couple, steel)
    assert more == pytest.approx(mixed, rel=2e-3)


@pytest.mark.parametrize("clamps", [("start",), ()])
def test_a_beam_has_nearly_the_same(clamps: tuple[str, ...], steel: Material) -> None:
    """Slender, so that what the beam leaves out is local: also where bands react each other."""
    ends = tuple(Segment(0.1 * L, 2.0 * A, connection=name) for name in "ABC")
    gap = Segment(0.35 * L, 2.0 * A)
    pin = Pin("three", (ends[0], gap, ends[1], gap, ends[2]))
    forces = np.array([[[F, 0.0, 0.0], [-2.0 * F, 0.0, 0.0], [F, 0.0, 0.0]]])
    loads = PinLoads("c", ("A", "B", "C"), forces)
    found = [
        solve_pin(pin, steel, clamps, (loads,), Requirement(model=model))[0].peak.history
        for model in ("beam", "harmonic")
    ]
    (beam,), meshes = found
    energies = [step.strain_energy for step in meshes if step.strain_energy is not None]
    assert len(energies) == len(meshes)
    assert energies == sorted(energies)  # a finer mesh is softer
    assert beam.strain_energy == pytest.approx(energies[-1], rel=0.03)


def test_of_loads_solved_one_after_the_other(cantilever_pin: Pin, steel: Material) -> None:
    """On one mesh: the same as of both at once, works on each other included."""
    loads = PinLoads("c", ("P1",), np.array([[[F, 0.0, F]]]), np.array([0.0, T, T]))
    units = tuple(loads.coefficients())
    mesh = meridian_mesh(cantilever_pin, SectionSize())

    def energy(*parts: tuple[UnitLoad, ...]) -> float:
        model, first = HarmonicModel(cantilever_pin, mesh, steel, ("start",)), FirstMesh()
        for part in parts:
            fields = first.fields(lambda: model, ("mesh",), (part, NO_POINTS, ()))
        assert fields.energy is not None
        return fields.energy.of(loads)

    assert energy(units[:2], units[2:]) == pytest.approx(energy(units), rel=1e-9)


@pytest.mark.long
@pytest.mark.slow
def test_harmonic_beside_solid(cantilever_pin: Pin, steel: Material) -> None:
    """Force, pull, couple and torque together; the tetrahedra lack a few parts in a thousand."""
    loads = PinLoads("c", ("P1",), np.array([[[F, 0.5 * F, F]]]), np.array([0.0, T, T]))
    problem = Problem(cantilever_pin, steel, ("start",), loads)
    found = []
    for rung in (ModelMesh("harmonic", level=2), ModelMesh("solid", level=2)):
        energy = result_on(problem, rung).energy
        assert energy is not None
        found.append(energy.of(loads))
    assert found[0] == pytest.approx(found[1], rel=5e-3)
