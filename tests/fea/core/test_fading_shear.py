"""Shears of links along and about the axis: exact resultants, zero at the edges of the band, and no
edge at which stress would be infinite.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.beam.timoshenko import AXIAL, TORQUE, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.requirement import Requirement
from fea.core.tractions import tractions_of
from fea.singular.singularities import singularities_of
from fea.solve.solve import solve_pin
from fea.support.contact.pressure_loads import others_along
from geometry import Pin, Segment
from geometry.shape.rings import ringed

PIN = Pin(
    "P",
    (
        Segment(0.01, 0.02),
        Segment(0.02, 0.02, connection="A"),
        Segment(0.04, 0.02),
        Segment(0.03, 0.02, connection="B"),
        Segment(0.01, 0.02),
    ),
)
CUTS = {"A": np.array([0.0, 0.003, 0.01, 0.02]), "B": np.array([0.0, 0.02, 0.03])}
RINGED = ringed(PIN, CUTS)
RINGS = tuple(name for name in RINGED.connections)
STEEL = Material("steel", 210e9, 0.3, yield_strength=700e6)


def pulls(distribution: str = "cosine") -> PinLoads:
    """One kilonewton and seven newton metres from A to B."""
    forces, moments = np.zeros((2, 1, 2, 3))
    forces[0, :, 2], moments[0, :, 2] = [-1e3, 1e3], [-7.0, 7.0]
    return PinLoads("c", ("A", "B"), forces, moments, distribution)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["A", "B"])
@pytest.mark.parametrize("cut", [False, True])
def test_resultants_and_edges(name: str, cut: bool) -> None:
    """Over the band and over all of its rings alike: 1 N or 1 N m by Gauss quadrature, nothing at
    the edges, and the same traction on both sides of a ring's edge.
    """
    pin = RINGED if cut else PIN
    rings = tuple(x for x in RINGS if x.startswith(f"{name} ring")) if cut else (name,)
    x, weight = np.polynomial.legendre.leggauss(3)
    for kind, column, arm in (("pull", 2, 1.0), ("twist", 1, -0.01)):
        unit = UnitLoad("", kind, 0, tuple((r, 1.0) for r in rings))  # type: ignore[arg-type]
        parts = tractions_of(pin, unit if cut else UnitLoad(name, kind, 0))  # type: ignore[arg-type]
        assert [t.surface for t in parts] == list(rings)
        total, before = 0.0, 0.0
        for t in parts:
            band = pin.band(t.surface)
            at = band.middle + 0.5 * band.length * x
            total += 0.5 * band.area * float(weight @ t.at(at)[:, column]) * arm
            first, last = t.at(np.array([band.z0, band.z1]))[:, column]
            assert first == pytest.approx(before, abs=1e-9 * abs(t.mean[column]))
            before = last
        assert total == pytest.approx(1.0, rel=1e-12)
        assert before == pytest.approx(0.0, abs=1e-9 * abs(parts[0].mean[column]))


def test_rings_carry_what_their_band_does() -> None:
    """The forces on the rings are the integrals of the parabola, and the beam's axial force and
    torque over the ringed pin are those of the pin.
    """
    along = others_along(RINGED, RINGS, pulls())
    (pull_a,) = (u for u in along.coefficients() if u.kind == "pull" and "A" in u.surfaces[0])
    for c, ring in enumerate(RINGS):
        band = RINGED.band(ring)
        parts = [
            (u, both[0])
            for u, both in along.coefficients().items()
            if u.kind == "pull" and ring in u.surfaces
        ]
        z = np.linspace(band.z0, band.z1, 2001)
        ((unit, amount),) = parts
        (t,) = (t for t in tractions_of(RINGED, unit) if t.surface == ring)
        by_hand = np.trapezoid(t.at(z)[:, 2], z) * band.area / band.length * amount[0]
        assert along.forces[0, c, 2] == pytest.approx(by_hand, rel=1e-5)
    assert len(pull_a.surfaces) == 3
    at = np.linspace(0.0, PIN.length, 57)
    sums = []
    for pin, loads in ((PIN, pulls()), (RINGED, along)):
        amounts = loads.coefficients()
        beam = stepped_beam(pin, STEEL, tuple(amounts))
        phases = np.array([amounts[u][0, u.phases[0]] for u in amounts])
        sums.append((beam.at(at) @ phases)[:, [AXIAL, TORQUE]])
    assert sums[1] == pytest.approx(sums[0], rel=1e-9, abs=1e-6)
    middle = sums[0][(at > 0.031) & (at < 0.069)]
    assert middle == pytest.approx(np.tile([1e3, 7.0], (len(middle), 1)), rel=1e-9)


def test_no_edge_is_singular_and_the_maximum_converges() -> None:
    """With uniform shears stress would grow with every mesh."""
    assert singularities_of(PIN, STEEL, (), (pulls(),)) == ()
    (solution,) = solve_pin(PIN, STEEL, (), (pulls(),), Requirement(tolerance=0.003))
    peak = solution.peak
    assert peak.max_von_mises is not None
    assert peak.own_error is not None
    # tension and torsion between the bands, and somewhat more where they enter
    area, radius = np.pi * 0.01**2, 0.01
    nominal = np.hypot(1e3 / area, np.sqrt(3.0) * 7.0 / (0.5 * area * radius))
    assert nominal < peak.max_von_mises < 1.2 * nominal
    assert peak.own_error < 0.003 * peak.max_von_mises


def test_moments_among_pressures_are_pressures() -> None:
    """With the moment of a link across the axis, and no shear at the edges of its band."""
    loads = replace(pulls(), moments=np.array([[[3.0, -2.0, 0.0], [-3.0, 2.0, 0.0]]]))
    units = loads.coefficients()
    assert {u.kind for u in units} == {"tilt", "pull"}
    assert singularities_of(PIN, STEEL, (), (loads,)) == ()
    (t,) = tractions_of(PIN, UnitLoad("A", "tilt", 1))
    band = PIN.band("A")
    z = np.linspace(band.z0, band.z1, 2001)
    radial, round_, along = t.at(z).T
    assert not round_.any()
    assert not along.any()
    assert np.pi * band.radius * np.trapezoid(radial * (z - band.middle), z) == pytest.approx(
        1.0, rel=1e-5
    )
    uniform = replace(loads, distribution="uniform")
    assert {u.kind for u in uniform.coefficients()} == {"moment", "pull"}
    assert {z.kind for z in singularities_of(PIN, STEEL, (), (uniform,))} == {"edge of a load"}
