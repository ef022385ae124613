"""The harmonic model against the solid one, which shares only the loads and the material with it.

A cantilever with a fillet: energy (the load's displacement) to 0.2 %, the fillet's peak to 1.5 %,
which is what a solid mesh of this size leaves (it is 9 elements across, quadratic).
"""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.harmonic.model import HarmonicModel
from fea.harmonic.superposition import Circumference
from fea.solid.model import SolidModel
from fea.solid.superposition import envelope
from geometry import Pin
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from geometry.mesh.solid_mesh import MeshSize, solid_mesh

LOADS = {
    "bent": PinLoads("bent", ("P1",), np.array([[[1000.0, 0.0, 0.0]]])),
    "pulled": PinLoads("pulled", ("P1",), np.array([[[0.0, 0.0, 1000.0]]])),
    "twisted": PinLoads("twisted", ("P1",), np.zeros((1, 1, 3)), np.array([0.0, 0.0, 10.0])),
    "turned over": PinLoads("over", ("P1",), np.zeros((1, 1, 3)), np.array([0.0, 10.0, 0.0])),
}
UNITS = {name: next(iter(loads.coefficients())) for name, loads in LOADS.items()}


@pytest.mark.slow
def test_harmonic_beside_solid(cantilever_pin: Pin, steel: Material) -> None:
    pin = cantilever_pin
    units = tuple((unit, phase) for unit in UNITS.values() for phase in unit.phases)
    mesh = solid_mesh(pin, MeshSize(across=7.0, corner=1.5, arc=6.0))
    solid = SolidModel(pin, mesh, steel, ("start",))
    by_solid = solid.solve(units)
    section = meridian_mesh(pin, SectionSize().finer(6.0))
    flat = HarmonicModel(pin, section, steel, ("start",))
    by_section = flat.solve(tuple(UNITS.values()))
    r, z = by_section.points.T
    fillet = (np.arange(len(r)) < by_section.skin) & (np.abs(z - 0.0225) < 0.0025)
    x = by_solid.space.nodes
    near = (np.abs(x[:, 2] - 0.0225) < 0.0025) & np.isin(np.arange(len(x)), by_solid.surface.nodes)
    for name, loads in LOADS.items():
        energy = _work(flat, UNITS[name])
        k = units.index((UNITS[name], UNITS[name].phases[0]))
        u = by_solid.displacement[..., k].ravel()
        assert u @ (solid.stiffness @ u) == pytest.approx(energy, rel=2e-3), name
        peak = Circumference(by_section, loads).top(fillet).value
        # the mean over turning the loads, as the solid model reports it
        found = envelope(by_solid, loads, near[by_solid.surface.nodes]).maximum
        assert found == pytest.approx(peak, rel=1.5e-2), name


def _work(model: HarmonicModel, unit: UnitLoad) -> float:
    """Of a unit load on the displacement it causes, J."""
    forces, _ = model._applied(unit.n, [unit])
    return float((forces.T @ model.displace(unit.n, forces))[0, 0])
