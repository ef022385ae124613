"""Points of sections and fields that are left out, and what is missed by that."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.unit_surface import UnitSurface
from fea.solve.solve import solve_pin
from geometry import Pin
from pinstress import load_study, run
from pinstress.analysis.thinning import STRESS_TOLERANCE, by_instants, meridian_points
from reports.data.surface import SurfaceCase
from tests.conftest import ROOT

STUDY = ROOT / "studies" / "one_pin.toml"


def test_a_thinned_meridian_has_the_same_stresses(cantilever_pin: Pin, steel: Material) -> None:
    forces = np.array([[[30.0, -70.0, 20.0]], [[500.0, 200.0, -900.0]]])
    acting = PinLoads("c", ("P1",), forces, distribution="cosine")
    requirement = Requirement(model="harmonic", meshes=1)
    (found,) = solve_pin(cantilever_pin, steel, ("start",), (acting,), requirement)
    assert found.answer is not None
    shown = found.answer.surface()
    assert shown is not None
    surface, left_out = shown.unit, shown.excluded
    largest = shown.largest(acting, 1)
    case = SurfaceCase("c", None, 1, shown.amounts(acting), np.array([0.0, 1.0]), left_out, largest)
    keep = meridian_points(surface, [case], np.arange(len(left_out)) == 7)
    assert keep[7]
    assert keep.sum() < 0.5 * len(keep)
    x = surface.points
    along = np.cumsum(np.linalg.norm(np.diff(x, axis=0, prepend=x[:1]), axis=1))
    lines = np.interp(along, along[keep], largest[keep])
    error = np.abs(lines - largest)[~left_out] / np.maximum(largest, 0.1 * largest.max())[~left_out]
    assert np.quantile(error, 0.98) < 2.0 * STRESS_TOLERANCE  # where it jumps there are two values
    r = np.interp(along, along[keep], x[keep, 0])
    assert np.abs(r - x[:, 0]).max() < 1e-3 * x[:, 0].max()


def test_a_solid_under_more_loads_than_instants_has_the_fields_of_these() -> None:
    """A pin with a hole in lugs has hundreds of unit loads, also in one case at rest: its report
    had 32 MB.
    """
    rng = np.random.default_rng(3)
    stress, moved = rng.normal(size=(7, 6, 40)), rng.normal(size=(7, 3, 40))
    points, triangles = rng.normal(size=(7, 3)), np.array([[0, 1, 2], [4, 5, 6]])
    unit = UnitSurface.in_space(points, triangles, stress, moved)
    none = np.zeros(7, dtype=bool)
    amounts = [np.stack([a, 0.0 * a], axis=2) for a in (rng.normal(size=(t, 40)) for t in (1, 3))]
    cases = [SurfaceCase("c", None, 0, a, np.ones(len(a)), none, np.ones(7)) for a in amounts]
    fewer, now = by_instants(unit, cases)
    assert fewer.stress.shape == (7, 5, 4)
    for case, was in zip(now, amounts, strict=True):
        assert fewer.stress @ case.amounts[:, :, 0].T == pytest.approx(unit.stress @ was[..., 0].T)
        assert fewer.displacement @ case.amounts[:, :, 0].T == pytest.approx(moved @ was[..., 0].T)
    assert by_instants(unit, cases * 10)[0] is unit


def test_a_run_has_sections_through_its_maxima_and_its_loads() -> None:
    results = run(load_study(STUDY))
    shown = {(s.pin, c.case): c for s in results.surfaces for c in s.cases}
    assert set(shown) == {(p.pin, p.case) for p in results.pins}
    for pin in results.pins:
        case = shown[pin.pin, pin.case]
        section = case.section
        assert section is not None
        assert pin.location is not None
        x, y, z = pin.location
        assert section.angle == pytest.approx(np.arctan2(y, x))
        k = int(np.abs(section.z - z).argmin())
        radii = section.inner[k] + section.part * (section.outer[k] - section.inner[k])
        j = int(np.abs(radii - np.hypot(x, y)).argmin())
        assert (section.z[k], radii[j]) == pytest.approx((z, np.hypot(x, y)))
        assert section.von_mises[0, k, j] == section.von_mises.max()
        assert section.von_mises.max() == pytest.approx(pin.max_von_mises, rel=1e-9)
        (load,) = [given for given in case.loads if not given.held]
        (link,) = [given for given in pin.loads if given.connection == load.connection]
        assert np.linalg.norm(load.forces[case.instant]) == pytest.approx(
            np.linalg.norm(link.force)
        )
