"""Stress beside the edge of a pressure: Johnson's half-plane, fitted fields, and finer meshes."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.local_fit import continuation, fit_weights
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.model import HarmonicModel
from fea.harmonic.pressure_edge import EDGE_DIRECTIONS, jumps
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.harmonic.superposition import Circumference
from fea.solve.refine import MESH_RATIO
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from geometry.mesh.section_mesh import meridian_mesh
from geometry.mesh.sizing import SectionSize, Spot

R = 0.01
PIN = Pin(
    "two",
    (Segment(0.02, 2.0 * R, connection="left"), Segment(0.02, 2.0 * R, connection="right")),
)
MIDDLE = (R, 0.02)
SHEARED = PinLoads(
    "shear",
    ("left", "right"),
    np.array([[[1000.0, 0.0, 0.0], [-1000.0, 0.0, 0.0]]]),
    distribution="cosine",
)


def half_plane(x: np.ndarray, y: np.ndarray, nu: float) -> np.ndarray:
    """Stress rr, tt, zz, tz, rz, rt of a pressure of 1 on x < 0 of the plane y > 0, by integrating
    Flamant's solution numerically; r = -y, z = x.
    """
    s = -np.tan(np.linspace(0.0, np.pi / 2.0, 200_001)[:-1])  # to -infinity
    weight = np.gradient(-s)
    out = np.zeros((len(x), 6))
    for k, (at, deep) in enumerate(zip(x, y, strict=True)):
        from_here = at - s
        far = -2.0 * deep / np.pi / (from_here**2 + deep**2) ** 2 * weight
        xx, yy, xy = (
            np.sum(far * term) for term in (from_here**2, deep**2 + 0.0 * s, from_here * deep)
        )
        out[k, [0, 1, 2, 4]] = yy, nu * (xx + yy), xx, -xy
    return out


def test_a_half_planes_stress_comes_back_exactly_beside_what_is_smooth(steel: Material) -> None:
    space = Section(meridian_mesh(PIN, SectionSize()))
    outline = Outline(space)
    (jump,) = jumps(space, outline, steel, (MIDDLE,))
    depth, along = R - space.samples[:, 0], space.samples[:, 1] - MIDDLE[1]
    used = np.zeros((len(space.samples), 6))
    used[jump.samples] = half_plane(along[jump.samples], depth[jump.samples], steel.poisson_ratio)
    smooth = np.stack([1.0 + 3.0 * along / R - (depth / R) ** 2] * 6, axis=1)
    pressure = np.zeros((*outline.nodes.shape, 3, 1))
    pressure[jump.before, :, 0] = -1.0
    found = jump.stress((5.0 * used + smooth)[..., None], 5.0 * pressure)[..., 0]
    angle = np.linspace(0.0, np.pi, EDGE_DIRECTIONS)[2:-2]  # where the integral is exact enough
    true = 5.0 * half_plane(R * np.cos(angle), R * np.sin(angle), steel.poisson_ratio) + 1.0
    assert found[2:-2] == pytest.approx(true, abs=2e-3)


def test_the_maximum_at_a_jump_is_that_of_far_finer_elements_near_it(steel: Material) -> None:
    """Two links that shear a pin press on opposite sides of it: the largest stress is right under
    their common edge. Elements forty times as fine, read 0.5 to 2 % of the radius away from it,
    come near that from below.
    """
    results = [
        harmonic_result(
            harmonic_solution(SectionProblem(PIN, steel, (), (SHEARED,), ()), level, MESH_RATIO),
            (),
            SHEARED,
        )
        for level in range(3)
    ]
    units = tuple(SHEARED.coefficients())
    finest = [Spot(*MIDDLE, 2e-3 * R, 0.1 * R)]
    angle, far = np.meshgrid(np.pi * np.arange(1, 12) / 12.0, [0.005 * R, 0.01 * R, 0.02 * R])
    there = np.stack([R - far * np.sin(angle), MIDDLE[1] + far * np.cos(angle)], axis=2)
    mesh = meridian_mesh(PIN, SectionSize().finer(4.0), finest)
    fields = HarmonicModel(PIN, mesh, steel, ()).solve(units, there.reshape(-1, 2))
    rows = np.arange(len(fields.points) - there.size // 2, len(fields.points))
    value, _ = Circumference(fields, SHEARED).largest_over_angle(
        rows, np.zeros(len(rows), dtype=int)
    )
    for result in results:
        assert result.maximum == pytest.approx(value.max(), rel=0.03)
        assert np.hypot(*result.location[:2]) == pytest.approx(R, rel=1e-9)
        assert result.location[2] == pytest.approx(MIDDLE[1], rel=1e-9)


def test_a_pin_sheared_by_pressures_converges_on_few_meshes(steel: Material) -> None:
    """What elements at the edge say is off by some 5 % on every mesh. Double shear: nothing but
    bands would react the couple of PIN.
    """
    bands = zip(("left", "middle", "right"), (0.7 * R, 1.4 * R, 0.7 * R), strict=True)
    pin = Pin("three", tuple(Segment(x, 2.0 * R, connection=name) for name, x in bands))
    forces = np.array([[[500.0, 0.0, 0.0], [-1000.0, 0.0, 0.0], [500.0, 0.0, 0.0]]])
    sheared = PinLoads("shear", pin.connections, forces, distribution="cosine")
    (found,) = solve_pin(pin, steel, (), (sheared,), Requirement(tolerance=0.02, model="harmonic"))
    assert found.peak.verdict == "converged"
    assert len(found.peak.history) <= 4


def test_a_fillets_peak_beside_the_edge_of_a_pressure_is_read(steel: Material) -> None:
    pin = Pin(
        "shoulder",
        (Segment(0.02, 3.0 * R, name="wide"), Segment(0.03, 2.0 * R, connection="narrow")),
        fillet=0.1 * R,
    )
    case = PinLoads("push", ("narrow",), np.array([[[500.0, 0.0, 0.0]]]), distribution="cosine")
    coarse, fine = (
        harmonic_result(
            harmonic_solution(
                SectionProblem(pin, steel, ("start",), (case,), ()), level, MESH_RATIO
            ),
            (),
            case,
        )
        for level in (0, 5)
    )
    assert 0.02 < fine.location[2] < 0.02 + 0.1 * R
    assert coarse.maximum == pytest.approx(fine.maximum, rel=0.03)


def test_quadratic_fields_are_continued_exactly() -> None:
    random = np.random.default_rng(1)
    samples, points = random.random((200, 2)), random.random((20, 2))

    def value(x: np.ndarray) -> np.ndarray:
        r, z = x.T
        return np.asarray(2.0 - r + 3.0 * z + r * z - 4.0 * z**2)

    assert continuation(samples, points) @ value(samples) == pytest.approx(value(points), abs=1e-9)
    assert continuation(samples, np.zeros((0, 2))).shape == (0, 200)


def test_samples_in_a_row_do_with_what_they_know() -> None:
    """Values along a line say nothing of those beside it, where they are taken to be the same."""
    offsets = np.stack([np.linspace(-1.0, 1.0, 8), np.full(8, 0.1)], axis=1)
    weights = fit_weights(offsets, np.ones(8))
    assert weights @ (1.0 + offsets[:, 0] ** 2) == pytest.approx(1.0, abs=1e-6)
