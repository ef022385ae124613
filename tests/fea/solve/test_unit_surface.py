"""What a view superposes beside what the models say of the same loads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Model, Requirement
from fea.core.solution import StressField
from fea.core.unit_surface import UnitSurface
from fea.core.voigt import von_mises
from fea.solid import field as solid_field
from fea.solid.field import SolidField
from fea.solve.solve import solve_pin
from geometry import Pin
from pinbase.arrays import Mask

INSTANT = 1
FORCES = np.array([[[30.0, -70.0, 20.0]], [[500.0, 200.0, -900.0]]])  # two instants, one band
MOMENTS = np.array([[[0.0, 0.0, 0.0]], [[1.0, -2.0, 3.0]]])


def loads(distribution: str) -> PinLoads:
    return PinLoads("c", ("P1",), FORCES, MOMENTS, distribution)  # type: ignore[arg-type]


def solved(pin: Pin, steel: Material, model: Model, acting: PinLoads) -> StressField:
    requirement = Requirement(model=model, meshes=1)
    (solution,) = solve_pin(pin, steel, ("start",), (acting,), requirement)
    assert solution.answer is not None
    return solution.answer


def superposed(surface: UnitSurface, amount: Floats, theta: float) -> tuple[Floats, Floats]:
    """Von Mises (P,) and displacement (P, 3) along r, theta, z, as the docstring says."""
    c, s = np.cos(surface.n * theta), np.sin(surface.n * theta)
    a, b = amount.T
    eight = np.concatenate([surface.stress, surface.displacement], axis=1)
    even, odd = eight @ (a * c + b * s), eight @ (a * s - b * c)
    found = np.where(surface.even, even, odd)
    return np.linalg.norm(found[:, :5], axis=1), found[:, 5:]


def near_places(points: Floats) -> Mask:
    """Points (P, 3) less than a tenth of the diameter from the clamp's rim, or a hundredth from
    where the load begins on the shaft.
    """
    r, z = np.hypot(*points[:, :2].T), points[:, 2]
    rim = np.hypot(r - 0.015, z) < 0.1 * 0.03 * (1.0 - 1e-6)
    load = np.hypot(r - 0.01, z - 0.04) < 0.01 * 0.02 * (1.0 - 1e-6)
    return np.asarray(rim | load)


@pytest.mark.parametrize("distribution", ["uniform", "cosine"])
def test_meridian_superposes_to_the_picture(
    cantilever_pin: Pin, steel: Material, distribution: str
) -> None:
    acting = loads(distribution)
    answer = solved(cantilever_pin, steel, "harmonic", acting)
    shown, picture = answer.surface(), answer.picture(acting, INSTANT)
    assert shown is not None
    surface = shown.unit
    assert surface.revolved
    assert picture is not None
    rings = picture.points.reshape(-1, 60, 3)  # points that coincide are one there
    stress = von_mises(picture.stress).reshape(-1, 60)
    moved = picture.displacement.reshape(-1, 60, 3)
    for sector in (0, 7, 31):
        theta = 2.0 * np.pi * sector / 60
        found, along = superposed(surface, shown.amounts(acting)[INSTANT], theta)
        first = [
            int(np.linalg.norm(surface.points - [np.hypot(x, y), 0.0, z], axis=1).argmin())
            for x, y, z in rings[:, 0]
        ]
        assert found[first] == pytest.approx(stress[:, sector], rel=1e-9)
        r, t, z = along[first].T
        x, y = np.cos(theta) * r - np.sin(theta) * t, np.sin(theta) * r + np.cos(theta) * t
        assert np.stack([x, y, z], axis=1) == pytest.approx(moved[:, sector], rel=1e-9, abs=1e-15)


def test_largest_is_the_maximum(cantilever_pin: Pin, steel: Material) -> None:
    acting = loads("cosine")
    answer = solved(cantilever_pin, steel, "harmonic", acting)
    shown = answer.surface()
    assert shown is not None
    for instant in (0, 1):
        around = shown.largest(acting, instant)
        largest = float(around[~shown.excluded].max())
        x, y, z = shown.location(acting, instant) or (0.0, 0.0, 0.0)
        meridian = shown.unit.points[~shown.excluded][around[~shown.excluded].argmax()]
        assert (np.hypot(x, y), z) == pytest.approx((meridian[0], meridian[2]))
        assert largest == pytest.approx(float(answer.maxima(acting)[instant]), rel=1e-9)
        assert float(around[shown.excluded].max()) > 0.0


def test_solid_superposes_to_the_picture(cantilever_pin: Pin, steel: Material) -> None:
    acting = loads("uniform")
    answer = solved(cantilever_pin, steel, "solid", acting)
    shown, picture = answer.surface(), answer.picture(acting, INSTANT)
    assert shown is not None
    surface = shown.unit
    assert not surface.revolved
    assert picture is not None
    found, along = superposed(surface, shown.amounts(acting)[INSTANT], 0.0)
    assert shown.largest(acting, INSTANT) == pytest.approx(found, rel=1e-9)
    assert np.array_equal(shown.excluded, near_places(surface.points))
    read = found[~shown.excluded]
    # the maximum is also looked for inside, on the rims of what is excluded
    assert 0.9 < read.max() / answer.maxima(acting)[INSTANT] <= 1.0 + 1e-9
    on = np.flatnonzero(~np.isnan(picture.envelope))
    assert found == pytest.approx(von_mises(picture.stress[on]), rel=1e-9)
    assert along == pytest.approx(picture.displacement[on], rel=1e-9, abs=1e-15)
    assert surface.points == pytest.approx(picture.points[on])
    corners = surface.points[surface.triangles]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    profile = cantilever_pin.segments
    round_ = sum(np.pi * s.diameter * s.length for s in profile)
    faces = 2.0 * np.pi * max(s.diameter for s in profile) ** 2 / 4.0
    assert 0.5 * area.sum() == pytest.approx(round_ + faces, rel=0.05)  # but for the fillet


def test_a_fine_mesh_is_shown_by_its_corners(
    cantilever_pin: Pin, steel: Material, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A quarter of the triangles, between vertices alone, with the numbers they had, but for the
    round-off of sums of six terms, whose order may depend on how many points there are.
    """
    answer = solved(cantilever_pin, steel, "solid", loads("uniform"))
    assert isinstance(answer, SolidField)
    every = answer.surface().unit
    monkeypatch.setattr(solid_field, "MAX_SHOWN_NODES", 100)
    shown = SolidField(replace(answer.solution)).surface()  # which keeps no surface from before
    corners = shown.unit
    assert 4 * len(corners.triangles) == len(every.triangles)
    assert corners.triangles.max() == len(corners.points) - 1
    row = {tuple(p): k for k, p in enumerate(every.points.tolist())}
    same = [row[tuple(p)] for p in corners.points.tolist()]
    assert len(same) < 0.3 * len(every.points)
    largest = np.abs(every.stress).max()
    np.testing.assert_allclose(corners.stress, every.stress[same], rtol=0.0, atol=1e-14 * largest)
    assert np.array_equal(shown.excluded, near_places(corners.points))


def test_a_beam_has_no_surface(cantilever_pin: Pin, steel: Material) -> None:
    answer = solved(cantilever_pin, steel, "beam", loads("uniform"))
    assert answer.surface() is None
