"""Places without a bound: which there are, how strong, and what to do."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fea.core.material import Material
from fea.core.pin_loads import Distribution, PinLoads
from fea.singular.singularities import find_singularities, singularities_of
from fea.singular.williams import antiplane_exponent, plane_exponent
from fea.solve.solve import solve_pin
from geometry import GeometryError, Pin, Segment
from tests.support.each import each
from tests.support.errors import raises

NU = 0.3


def shouldered(fillet: float = 0.0, thick: float = 0.03, length: float = 0.02) -> Pin:
    """A root, a shaft of 20 mm and a loaded end."""
    return Pin(
        "P",
        (
            Segment(0.02, thick, name="root"),
            Segment(length, 0.02, name="shaft"),
            Segment(0.02, 0.02, connection="P1"),
        ),
        fillet=fillet,
    )


def test_a_free_pin_with_fillets_has_none() -> None:
    assert find_singularities(shouldered(0.005), (), (), NU) == ()


def test_a_sharp_shoulder() -> None:
    (singularity,) = find_singularities(shouldered(), (), (), NU)
    assert (singularity.kind, singularity.r, singularity.z) == ("sharp corner", 0.01, 0.02)
    assert set(singularity.between) == {"shoulder 1", "shaft"}
    assert singularity.theory == pytest.approx(0.4555, abs=5e-5)
    assert singularity.torsion_theory == pytest.approx(1.0 / 3.0)
    assert singularity.radius == pytest.approx(0.002)
    assert (
        singularity.advice
        == "a fillet of at least 0.1 x the smaller diameter here would make it finite"
    )


@pytest.mark.parametrize(
    ("pin", "limit", "largest"),
    [
        (shouldered(thick=0.022), "the height of the step, 0.05 x", 0.001),
        (shouldered(length=0.003), "half the length of shaft, 0.075 x", 0.0015),
    ],
)
def test_a_fillet_is_advised_that_fits(pin: Pin, limit: str, largest: float) -> None:
    (singularity,) = find_singularities(pin, (), (), NU)
    assert limit in singularity.advice
    mended = Pin("P", pin.segments, fillet=largest * (1.0 - 1e-12))
    assert find_singularities(mended, (), (), NU) == ()


def test_the_inner_corner_of_a_bore_has_no_fillet_to_advise() -> None:
    pin = Pin("P", (Segment(0.02, 0.03, bore=0.01), Segment(0.02, 0.02)), fillet=0.002)
    (singularity,) = find_singularities(pin, (), (), NU)
    assert (singularity.kind, singularity.r, singularity.z) == ("sharp corner", 0.005, 0.02)
    assert singularity.between == ("bore step 1", "bore segment 1")
    assert "bore_radius" in singularity.advice
    assert singularity.radius == pytest.approx(0.001)


def test_a_clamped_face_is_singular_at_its_rims() -> None:
    solid = find_singularities(shouldered(0.005), ("start",), (), NU)
    assert [(p.kind, p.r, p.z) for p in solid] == [("edge of a clamp", 0.015, 0.0)]
    assert solid[0].theory == pytest.approx(0.2888, abs=5e-5)
    assert solid[0].torsion_theory == 0.0
    assert solid[0].radius == pytest.approx(0.003)
    assert "replace the clamp" in solid[0].advice
    hollow = Pin("P", (Segment(0.1, 0.03, bore=0.01),))
    assert [p.r for p in find_singularities(hollow, ("start",), (), NU)] == [0.015, 0.005]


def test_a_clamped_face_is_harmless_without_lateral_contraction() -> None:
    assert find_singularities(shouldered(0.005), ("start",), (), 0.0) == ()


def test_a_clamped_band_in_the_middle_of_a_shaft() -> None:
    pin = Pin("P", (Segment(1, 2), Segment(1, 2, name="held"), Segment(1, 2)))
    singularities = find_singularities(pin, ("held",), (), NU)
    assert [(p.kind, p.r, p.z) for p in singularities] == [
        ("edge of a clamp", 1.0, z) for z in (1, 2)
    ]
    for singularity in singularities:
        assert singularity.theory == pytest.approx(0.5, abs=1e-12)
        assert singularity.torsion_theory == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize(("held", "angle", "z"), [("shaft", 270, 0.02), ("root", 90, 0.02)])
def test_a_clamp_that_ends_at_a_shoulder(held: str, angle: int, z: float) -> None:
    """Held at the inner corner, or at the rim beside it, which leaves the corner free."""
    singularities = find_singularities(shouldered(), (held,), (), NU)
    omega = math.radians(angle)
    (edge,) = [p for p in singularities if held in p.between and "shoulder 1" in p.between]
    assert (edge.kind, edge.z) == ("edge of a clamp", z)
    assert edge.theory == pytest.approx(plane_exponent(omega, NU, "clamped", "free"))
    assert edge.torsion_theory == pytest.approx(antiplane_exponent(omega, "clamped", "free"))
    sharp = [p for p in singularities if p.kind == "sharp corner"]
    assert len(sharp) == (held == "root")


def test_what_is_held_throughout_is_not_singular() -> None:
    """Neither a smooth seam between two held bands nor a rim between held surfaces."""
    singularities = find_singularities(shouldered(0.005), ("shaft", "P1", "end"), (), NU)
    assert [(p.kind, p.z) for p in singularities] == [("edge of a clamp", 0.025)]


def test_edges_of_uniform_tractions_are_logarithms() -> None:
    pin = Pin("P", tuple(Segment(1, 2, connection=c) for c in "ABCD"))
    singularities = find_singularities(pin, (), ("B", "C"), NU)
    assert [(p.kind, p.z) for p in singularities] == [("edge of a load", z) for z in (1, 2, 3)]
    for singularity in singularities:
        assert (singularity.theory, singularity.torsion_theory) == (0.0, 0.0)
        assert singularity.radius == pytest.approx(0.02)
        assert 'distribution = "cosine"' in singularity.advice
    assert find_singularities(pin, (), ("A",), NU)[0].z == 1.0  # and not the rim at z = 0


@each(
    ("force", "moment", "distribution", "told"),
    [
        ((0, 9, 0), (0, 0, 0), "uniform", ["transverse"]),
        ((0, 9, 9), (0, 0, 0), "uniform", ["transverse"]),
        ((0, 0, 0), (9, 0, 0), "uniform", ["moment"]),
        ((0, 9, 0), (9, 0, 0), "uniform", ["transverse", "moment"]),
        ((0, 9, 9), (9, 0, 9), "cosine", []),
    ],
)
def test_the_remedy_at_the_edge_of_a_load_is_that_of_what_acts(
    force: tuple[float, ...], moment: tuple[float, ...], distribution: Distribution,
    told: list[str], steel: Material,
) -> None:  # fmt: skip
    """A bearing pressure cures uniform tractions across the pin; along and about it they fade."""
    pin = Pin("P", (Segment(1, 2), Segment(1, 2, connection="B"), Segment(1, 2)))
    loads = PinLoads(
        "c", ("B",), np.array([[force]], float), np.array([[moment]], float), distribution
    )
    remedies = {
        "transverse": "a bearing pressure has no jump",
        "moment": "a moment across the axis",
    }
    zones = singularities_of(pin, steel, ("end",), (loads,))
    edges = [zone for zone in zones if zone.kind == "edge of a load"]
    assert [zone.z for zone in edges] == ([1, 2] if told else [])
    for zone in edges:
        assert [name for name, words in remedies.items() if words in zone.advice] == told


def test_a_load_up_to_a_fillet_jumps_at_its_tangent_point() -> None:
    pin = Pin("P", (Segment(2, 2, connection="B"), Segment(1, 3)), fillet=0.2)
    (singularity,) = find_singularities(pin, (), ("B",), NU)
    assert (singularity.kind, singularity.z, singularity.between) == (
        "edge of a load",
        1.8,
        ("B", "fillet 1"),
    )


def test_a_clamp_beside_a_load_is_a_clamp() -> None:
    singularities = find_singularities(shouldered(0.005), ("shaft",), ("P1",), NU)
    assert [(p.kind, p.z) for p in singularities] == [("edge of a clamp", z) for z in (0.025, 0.04)]


def test_the_excluded_distance_is_the_users() -> None:
    near, far = (find_singularities(shouldered(), (), ("P1",), NU, d) for d in (0.05, 0.2))
    assert [p.kind for p in near] == ["sharp corner", "edge of a load"]
    assert [p.radius for p in near] == pytest.approx([0.001, 0.0001])
    assert [p.radius for p in far] == pytest.approx([0.004, 0.0004])


def test_surfaces_go_by_the_names_of_the_study() -> None:
    pin = Pin("P", (Segment(1, 2, name="hub", connection="B"), Segment(1, 2)))
    assert find_singularities(pin, ("hub",), (), NU) == find_singularities(pin, ("B",), (), NU)
    with raises(GeometryError, "unknown-surface", "'rim'"):
        find_singularities(pin, ("rim",), (), NU)


@settings(max_examples=100, deadline=None)
@given(
    st.lists(st.sampled_from([2.0, 2.5, 3.0]), min_size=1, max_size=5),
    st.sampled_from([1e-7, 1e-3, 0.1, 0.25]),
)
def test_pins_with_fillets_have_no_sharp_corner(diameters: list[float], fillet: float) -> None:
    pin = Pin("H", tuple(Segment(1.0, d) for d in diameters), fillet=fillet)
    assert find_singularities(pin, (), (), NU) == ()


@pytest.mark.parametrize("rises", [True, False])
def test_a_fillet_lost_in_rounding_is_a_sharp_corner(rises: bool) -> None:
    segments = (Segment(1.0, 2.0), Segment(1.0, 3.0))
    pin = Pin("P", segments if rises else segments[::-1], fillet=1e-10)
    (singularity,) = find_singularities(pin, (), (), NU)
    assert singularity.kind == "sharp corner"
    assert singularity.advice.startswith("a fillet of at least 0.1 x")


def test_a_case_has_its_own_places(steel: Material) -> None:
    """Beside a case whose tractions shear, one of pressures has a maximum as it has by itself; its
    meshes are finer at the edges of loads then, so the values agree within their errors only.
    """
    pin = Pin("P", tuple(Segment(0.008, 0.02, connection=name) for name in "ABC"))
    forces = np.array([[[0.0, 1e4, 0.0], [0.0, -2e4, 0.0], [0.0, 1e4, 0.0]]])
    shears = PinLoads("shears", ("A", "B", "C"), forces)
    presses = PinLoads("presses", ("A", "B", "C"), forces, distribution="cosine")
    (alone,) = solve_pin(pin, steel, (), (presses,))
    one, other = solve_pin(pin, steel, (), (shears, presses))
    assert one.peak.verdict == "singular"
    assert other.peak.verdict == alone.peak.verdict == "converged"
    assert not other.peak.singular_at
    values, errors = zip(
        *((s.peak.max_von_mises or 0.0, s.peak.error_estimate or 0.0) for s in (alone, other)),
        strict=True,
    )
    assert abs(values[0] - values[1]) < sum(errors)
    assert alone.answer is not None
    assert other.answer is not None
    assert other.answer.maxima(presses)[0] == pytest.approx(values[1], rel=1e-12)


def test_in_torsion_eigenvalues_are_multiples_of_the_first() -> None:
    """A free corner of 270 deg has 2/3 and 4/3; a smooth surface held on one side 1/2 and 3/2."""
    (corner,) = find_singularities(shouldered(), (), (), NU)
    assert corner.torsion_theory == pytest.approx(1.0 - 2.0 / 3.0)
    assert corner.following_torsion == pytest.approx(4.0 / 3.0 - 1.0)
    pin = Pin("P", (Segment(0.02, 0.02, name="held"), Segment(0.02, 0.02, connection="P1")))
    singularities = find_singularities(pin, ("held",), (), NU)
    (smooth,) = (p for p in singularities if p.z == 0.02)
    assert smooth.torsion_theory == pytest.approx(1.0 - 1.0 / 2.0)
    assert smooth.following_torsion == pytest.approx(3.0 / 2.0 - 1.0)
