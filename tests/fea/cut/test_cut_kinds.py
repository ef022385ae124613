"""Local solids about flats, slots, blind holes and passages: beam theory, Kirsch, limits in which
one kind becomes another, symmetry, and inner corners that have no finite stress.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.voigt import VON_MISES
from fea.cut.inner_corners import inner_corners
from fea.cut.local_model import LocalModel, Read
from fea.cut.region import pieces, zone
from fea.solid.assembly import Discretisation
from fea.solve.solve import solve_pin
from geometry import Bottom, Cut, CutPin, Flat, Hole, Passage, Pin, Segment, Slot
from geometry.mesh.cut_piece import Piece, clipped, piece_mesh
from pinbase.arrays import Floats
from tests.support.each import sampled
from tests.support.pins.plain_pins import SHAFT

STEEL = Material("steel", 2.1e11, 0.3, yield_strength=5e8)
D, R, MIDDLE = 0.02, 0.01, 0.08
NOMINAL = 38.197e6  # of 1.5 kN in four-point bending over arms of 20 mm
HOLE = Hole(MIDDLE, 0.004)


def cut(*cuts: Cut, pin: Pin = SHAFT) -> CutPin:
    return CutPin(pin, cuts)


def piece(*cuts: Cut) -> Piece:
    (found,) = pieces(cut(*cuts), ())
    return found


def solved(about: Piece, stress: Callable[[Floats], Floats], finer: float = 1.0) -> Read:
    """Under a stress that is a function (.., 6) of points (.., 3), z from the middle of the
    shaft.
    """
    model = LocalModel(about, piece_mesh(about, finer), STEEL)
    x = model.faces.images + np.array([0.0, 0.0, about.origin - MIDDLE])
    return model.solve(stress(x)[..., None])


def component(k: int) -> Callable[[Floats], Floats]:
    def stress(x: Floats) -> Floats:
        out = np.zeros((*x.shape[:-1], 6))
        out[..., k] = 1.0
        return out

    return stress


def bent(x: Floats) -> Floats:
    """About y: 1 at x = R."""
    return component(2)(x) * x[..., :1] / R


def von_mises(read: Read) -> Floats:
    square = np.einsum("pil,ij,pjl->p", read.stress, VON_MISES, read.stress)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


BESIDE, OBLIQUE = replace(HOLE, offset=0.004), replace(HOLE, angle=0.3, tilt=0.5)
SLOT = Slot(MIDDLE - 0.004, MIDDLE + 0.004, 0.004)
TUNNEL = Passage(0.0, SHAFT.length, 0.004, 0.004)


@pytest.mark.parametrize(
    ("one", "k"),
    [
        (SLOT, 0),
        (Flat(MIDDLE - 0.01, MIDDLE + 0.01, 0.008), 1),
        (BESIDE, 1),  # in the frame of its piece, which its mirror planes turn
        pytest.param(TUNNEL, 2, marks=pytest.mark.slow),
    ],
)
def test_a_stress_along_the_walls_of_a_cut_is_not_changed_by_it(one: Cut, k: int) -> None:
    read = solved(piece(one), component(k), 1.5 if one is TUNNEL else 1.0)
    assert np.abs(read.difference).max() < (0.02 if one is TUNNEL else 2e-3)
    assert read.stress[read.cut, k, 0] == pytest.approx(1.0, abs=0.02)


def segment(d: float) -> tuple[float, float, float]:
    """Of a round section beyond a distance: area, static moment, second moment about the axis."""
    u = d + (R - d) * (np.arange(20000) + 0.5) / 20000
    w = 2.0 * np.sqrt(R**2 - u**2) * (R - d) / 20000
    return float(w.sum()), float((w * u).sum()), float((w * u * u).sum())


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("stress", [component(2), bent])
def test_amid_a_long_flat_stress_is_that_of_beams(
    count: int, stress: Callable[[Floats], Floats]
) -> None:
    """Tension and bending of the net section, whose centroid is not on the pin's axis for one."""
    d, long = 0.007, 3.0 * D
    flats = [Flat(MIDDLE - long / 2, MIDDLE + long / 2, d, k * math.pi, 0.001) for k in (0, 1)]
    area, first, second = segment(d)
    left = math.pi * R**2 - count * area
    offset = -first / left if count == 1 else 0.0
    own = math.pi * R**4 / 4.0 - count * second - left * offset**2
    force, moment = (0.0, math.pi * R**3 / 4.0) if stress is bent else (math.pi * R**2, 0.0)
    read = solved(piece(*flats[:count]), stress)
    x, _, z = read.points.T
    there = read.cut & (np.abs(x - d) < 1e-9) & (np.abs(z) < 0.2 * D)
    assert there.sum() > 5
    expected = force / left + (moment - force * offset) * (d - offset) / own
    found = read.stress[there]
    assert found[:, 2, 0].mean() == pytest.approx(expected, rel=0.006)
    assert np.abs(found[:, [0, 4], 0]).max() < 1e-6


@pytest.mark.slow
def test_a_passage_amid_a_stress_across_is_kirschs_hole() -> None:
    """In a disc of finite radius: its rim is pulled as a plate's would be, so that the parts of
    the hoop stress round the hole, even and with twice the angle, come from Lamé and from
    Michell's four functions r^2, r^-2, r^4 and 1.
    """
    rho = 0.1

    def rows(r: float) -> list[list[float]]:
        return [[-2.0, -6.0 / r**4, 0.0, -4.0 / r**2], [2.0, -6.0 / r**4, 6.0 * r**2, -2.0 / r**2]]

    _, b, c, _ = found = np.linalg.solve([*rows(rho), *rows(1.0)], [0.0, 0.0, 0.5, -0.5])
    twice = 2.0 * found[0] + 6.0 * b / rho**4 + 12.0 * c * rho**2
    even = 1.0 / (1.0 - rho**2)
    small = Passage(0.0, SHAFT.length, 0.1 * D, 0.0)
    read = solved(piece(small), component(0), 1.5)
    x, y, z = read.points.T
    amid = read.cut & (np.abs(z) < D)
    top, side = amid & (np.abs(x) < 1e-5), amid & (np.abs(y) < 1e-5)
    assert read.stress[top, 0, 0].mean() == pytest.approx(even - twice, rel=0.02)
    assert read.stress[side, 1, 0].mean() == pytest.approx(even + twice, rel=0.04)


@pytest.mark.slow
def test_a_deep_blind_hole_is_a_hole_at_its_mouth() -> None:
    """Through the pin but for a skin on the far side, of 1 % of the section, so far from the axis
    that the tension bends the shaft by up to 3 % more; and a small chamfer is none.
    """
    through = von_mises(solved(piece(HOLE), component(2), 1.5)).max()
    deep = replace(HOLE, depth=0.975 * D, bottom=Bottom(radius=0.001))
    read = solved(piece(deep), component(2), 1.5)
    mouth = read.points[:, 0] > 0.8 * R
    assert through < von_mises(read)[mouth].max() < 1.03 * through
    chamfered = von_mises(solved(piece(replace(HOLE, chamfer=0.0003)), component(2), 1.5)).max()
    assert chamfered == pytest.approx(through, rel=0.015)


def test_a_short_slot_is_a_hole() -> None:
    short = Slot(MIDDLE - 0.002, MIDDLE + 0.002, 0.004)
    slot, hole = (solved(piece(c), component(2), f) for c, f in ((short, 1.4), (HOLE, 1.0)))
    assert von_mises(slot).max() == pytest.approx(von_mises(hole).max(), rel=0.015)


KEYWAY = Slot(MIDDLE - 0.008, MIDDLE + 0.008, 0.005, 0.003, 0.3, 0.0006)
FLATS = tuple(Flat(MIDDLE - D / 2, MIDDLE + D / 2, 0.008, 0.3 + k * math.pi, 0.001) for k in (0, 1))


MOUTH = replace(HOLE, mouth_radius=0.0006)


def test_half_of_a_hole_with_rounded_mouths() -> None:
    """Cut from the whole after rounding: half of its volume, and the same surfaces."""
    half = piece(MOUTH)
    profile = clipped(SHAFT, half.z0, half.z1)
    cuts = {"hole 1": MOUTH.moved(half.z0, half.angle)}
    whole = replace(half, profile=profile, cuts=cuts, mirrors=("x", "y"))
    one, two = (piece_mesh(p, 1.0).mesh for p in (half, whole))
    volume, doubled = (float(Discretisation(mesh).weights.sum()) for mesh in (one, two))
    assert volume == pytest.approx(0.5 * doubled, rel=1e-3)
    assert set(one.boundaries) == set(two.boundaries)


def test_what_is_meshed_of_cuts() -> None:
    """By their symmetries: an eighth of opposite flats, a quarter of a keyway, half of a passage;
    two flats are symmetric about the plane amid them; a flat at the end reaches to it.
    """
    assert piece(*FLATS).mirrors == ("x", "y", "z")
    assert len(piece(*FLATS).cuts) == 2
    assert piece(FLATS[0]).mirrors == ("y", "z")
    assert piece(KEYWAY).mirrors == ("y", "z")
    assert piece(KEYWAY).angle == 0.3
    assert piece(TUNNEL).mirrors == ("y", "z")
    blind = Passage(0.0, MIDDLE, 0.004, 0.004, 0.3, "start")
    assert piece(blind).mirrors == ("y",)
    assert piece(blind).open_ends == (False, True)
    assert piece(replace(HOLE, depth=0.006)).mirrors == ("y", "z")
    assert piece(MOUTH).mirrors == ("x", "y", "z")
    assert piece(BESIDE).mirrors == ("y", "z")
    assert piece(OBLIQUE).mirrors == ("y",)
    assert piece(replace(OBLIQUE, offset=0.002)).mirrors == ()
    skew = piece(FLATS[0], replace(FLATS[0], angle=0.3 + math.pi / 2))
    assert skew.mirrors == ("y", "z")
    assert skew.angle == pytest.approx(0.3 + math.pi / 4)
    end = piece(Flat(0.14, 0.16, 0.008, 0.0, 0.001))
    assert end.z1 == pytest.approx(0.16)
    assert end.open_ends == (True, False)
    assert zone(end)[1] > 0.16
    both = piece(KEYWAY, Hole(MIDDLE + 0.015, 0.003, 1.0))
    assert list(both.cuts) == ["slot 1", "hole 1"]


@pytest.mark.slow
@pytest.mark.parametrize("cuts", sampled([[FLATS[0]], [BESIDE], [KEYWAY], [MOUTH]], every=3))
def test_parts_answer_as_the_whole(cuts: list[Cut]) -> None:
    """Each on a mesh of its own, in bending about an axis that is no axis of symmetry."""

    def skew(x: Floats) -> Floats:
        return component(2)(x) * (0.8 * x[..., :1] + 0.6 * x[..., 1:2]) / R

    part = piece(*cuts)
    z0, z1 = part.z0, part.z1
    moved = {f"{c.what} {i}": c.moved(z0, part.angle) for i, c in enumerate(cuts, 1)}
    half = replace(part, profile=clipped(SHAFT, z0, z1), cuts=moved, mirrors=("y",))
    found = [von_mises(solved(p, skew)).max() for p in (part, half)]
    assert found[1] == pytest.approx(found[0], rel=0.03)


CONE = Bottom(math.radians(118.0))
RIGHT = 1.5 * math.pi
TIPPED = replace(HOLE, depth=0.006, bottom=CONE)
ROUND: list[Cut] = [
    FLATS[0], SLOT, HOLE, replace(HOLE, mouth_radius=0.0006), replace(HOLE, chamfer=0.0005),
    replace(TIPPED, bottom=replace(CONE, radius=0.0006)),
]  # fmt: skip


@pytest.mark.parametrize(
    ("one", "expected"),
    [
        (replace(FLATS[0], radius=0.0), {("flat 1 end", "flat 1 floor"): RIGHT}),
        (replace(KEYWAY, radius=0.0), {("slot 1 floor", "slot 1 wall"): RIGHT}),
        (
            TIPPED,
            {
                ("hole 1 bottom", "hole 1 wall"): RIGHT - math.radians(31.0),
                ("hole 1 bottom", "itself"): math.nan,
            },
        ),
        (KEYWAY, {}),
        *(
            pytest.param(one, {}, marks=[pytest.mark.slow, *[pytest.mark.long] * (k % 3 > 0)])
            for k, one in enumerate(ROUND)
        ),
    ],
)
def test_sharp_inner_corners_are_found(one: Cut, expected: dict[tuple[str, str], float]) -> None:
    """Of a flat, a keyway and a drill's tip by their angles; none where they are rounded."""
    about = piece(one)
    model = LocalModel(about, piece_mesh(about, 1.0), STEEL)
    corners = inner_corners(model, model.faces.points, 0.1)
    found = {c.singularity.between: c.singularity.angle for c in corners}
    assert found == pytest.approx(expected, rel=0.01, nan_ok=True)
    for corner in corners:
        size = min(one.size, D)
        assert corner.singularity.radius == pytest.approx(0.1 * size)
        assert corner.distance.min() < 1e-6
        assert corner.singularity.kind == "sharp corner"


def bending(force: float = 1500.0, axial: float = 0.0) -> PinLoads:
    forces = force * np.array([[1.0, 0, 0], [-1.0, 0, 0], [-1.0, 0, 0], [1.0, 0, 0]])
    forces[:, 2] = [-axial, 0.0, 0.0, axial]
    return PinLoads("bending", SHAFT.connections, forces[None])


def peak(pin: CutPin, requirement: Requirement) -> Maximum:
    return solve_pin(pin, STEEL, (), (bending(),), requirement)[0].peak


def test_a_sharp_flat_is_singular_and_says_what_would_help() -> None:
    found = peak(cut(replace(FLATS[0], radius=0.0, angle=0.0)), Requirement(0.05))
    assert (found.model, found.verdict) == ("harmonic+local", "singular")
    (zone_,) = (z for z in found.singular_at if z.governs)
    assert zone_.between == ("flat 1 end", "flat 1 floor")
    assert zone_.exponent_theory == pytest.approx(0.4555, abs=1e-3)
    assert zone_.excluded == pytest.approx(0.1 * D)
    assert zone_.advice == "a radius of the flat would make it finite"
    assert "flat 1 end / flat 1 floor" in found.note
    assert found.interval is not None
    assert found.max_von_mises is not None
    assert found.interval[0] < found.max_von_mises < found.interval[1]
    nominal = 1.0 / 0.9  # of the net section, near its corners more than that
    assert 0.9 * nominal * NOMINAL < found.max_von_mises < 1.6 * nominal * NOMINAL


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize(
    "one",
    [
        Slot(MIDDLE - 0.01, MIDDLE + 0.01, 0.006, 0.0035, 0.0, 0.0012),
        Flat(MIDDLE - D / 2, MIDDLE + D / 2, 0.007, 0.0, 0.002),
        Hole(MIDDLE, 0.006, 0.0, 0.005, Bottom(radius=0.0012)),
        BESIDE,
        OBLIQUE,
    ],
)
def test_beside_the_whole_solid(one: Cut) -> None:
    """On its finest mesh, within both errors."""
    local = peak(cut(one), Requirement(0.02))
    whole = peak(cut(one), Requirement(0.02, "solid"))
    assert (local.model, local.verdict) == ("harmonic+local", "converged")
    assert whole.model == "solid"
    assert local.max_von_mises is not None
    assert whole.max_von_mises is not None
    apart = abs(local.max_von_mises - whole.max_von_mises)
    assert apart < (local.error_estimate or 0.0) + (whole.error_estimate or 0.0)


@pytest.mark.slow
def test_a_blind_passage_leaves_the_pin_beyond_it_alone() -> None:
    """It lies under loaded bands, and the maximum is where the pin without it has it."""
    root = Pin(
        "root",
        (Segment(0.03, 0.03, name="root"), Segment(0.03, D, connection="A"), Segment(0.06, D)),
        fillet=0.002,
    )
    loads = PinLoads("case", ("A",), np.array([[[1000.0, 0.0, 0.0]]]))
    drilled = cut(Passage(0.05, root.length, 0.004, 0.0, 0.0, "end"), pin=root)
    found = [solve_pin(pin, STEEL, ("start",), (loads,))[0].peak for pin in (root, drilled)]
    assert [p.model for p in found] == ["harmonic", "harmonic+local"]
    values = [p.max_von_mises for p in found]
    assert values[0] == pytest.approx(values[1], rel=0.01)
