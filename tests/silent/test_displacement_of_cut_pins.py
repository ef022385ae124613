"""Displacements of a pin with cuts were those of the pin without: the tip of a cantilever of 20 mm
moved by 0.1309 mm with and without a hole of 14 mm across it, in VTU files and on the page.

Independent values: beams of the section that two long flats leave (its area and moment of inertia
in closed form, its torsion constant from Prandtl's function by finite differences), and, slowly,
the whole pin as one solid, whose displacements know nothing of pieces.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.core.solution import Picture
from fea.cut.field import CutField
from fea.cut.region import zone
from fea.solve.solve import solve_pin
from geometry import Cut, CutPin, Flat, Hole, Pin, PinLike, Segment
from pinbase.arrays import Floats
from tests.support.each import sampled

E, NU = 2.1e11, 0.3
G = E / 2.0 / (1.0 + NU)
STEEL = Material("steel", E, NU, yield_strength=5e8)
D, R = 0.02, 0.01
LENGTH, AT = 0.21, 0.2  # of the bar, and where its load acts (the middle of its band)
BAR = Pin("bar", (Segment(0.19, D, name="shaft"), Segment(0.02, D, connection="B")))
LOW, HIGH, FLAT = 0.03, 0.15, 0.006  # flats from, to, and their distance from the axis
FLATS = CutPin(BAR, [Flat(LOW, HIGH, FLAT, a, 0.002) for a in (0.0, math.pi)])


def loaded(force: list[float], moment: list[float] | None = None) -> PinLoads:
    """At B of a clamped bar."""
    return PinLoads("c", ("B",), np.array([[force]]), np.array([[moment or [0.0, 0.0, 0.0]]]))


def shown(
    pin: PinLike, clamps: tuple[str, ...], loads: PinLoads, requirement: Requirement
) -> Picture:
    """The surface at its governing instant."""
    (solution,) = solve_pin(pin, STEEL, clamps, (loads,), requirement)
    assert solution.answer is not None
    picture = solution.answer.picture(solution.loads, solution.instant)
    assert picture is not None
    return picture


ALL, QUICK = loaded([200.0, 300.0, 2e4], [0.0, 0.0, 40.0]), Requirement(0.02, meshes=1)


def at_tip(picture: Picture) -> Floats:
    """Mean displacement of the free end's rim (3,) m, and its turn about z."""
    x = picture.points
    rim = (x[:, 2] > LENGTH - 1e-9) & (np.hypot(x[:, 0], x[:, 1]) > R - 1e-9)
    u, at = picture.displacement[rim], x[rim]
    spin = np.mean((at[:, 0] * u[:, 1] - at[:, 1] * u[:, 0]) / R**2)
    return np.append(u.mean(axis=0), spin)


def between(known: Floats, displacement: Floats, points: Floats) -> Floats:
    """Displacements at points: linear fits to what is known at the nearest nodes."""
    distance, near = (np.asarray(x) for x in cKDTree(known).query(points, 20))
    reach = distance[:, -1:]
    offsets = (known[near] - points[:, None]) / reach[..., None]
    weight = (1.001 - (distance / reach) ** 2)[..., None]
    terms = np.concatenate([np.ones((*near.shape, 1)), offsets], axis=2) * weight
    inverse = np.linalg.pinv(terms, rcond=1e-3)[:, :1]
    return np.asarray((inverse @ (displacement[near] * weight))[:, 0])


def left_by_flats() -> tuple[float, float, float]:
    """Area, and moments of inertia about y (across the flats' normal) and x, of |x| < FLAT."""
    a, h = math.asin(FLAT / R), FLAT
    area = 2.0 * h * math.sqrt(R**2 - h**2) + 2.0 * R**2 * a
    about_y = 0.5 * R**4 * (a - math.sin(4.0 * a) / 4.0)
    about_x = 4.0 / 3.0 * R**4 * (3.0 * a / 8.0 + math.sin(2.0 * a) / 4.0 + math.sin(4.0 * a) / 32)
    return area, about_y, about_x


def torsion_constant(cells: int = 240) -> float:
    """Of |x| < FLAT in a circle, by Prandtl's function on a square grid, zero outside."""
    h = 2.0 * R / cells
    x, y = np.meshgrid(*2 * [np.linspace(-R, R, cells + 1)], indexing="ij")
    inside = ((np.abs(x) < FLAT - 1e-9) & (np.hypot(x, y) < R - 1e-9)).ravel()
    one = sp.diags([1.0, -2.0, 1.0], [-1, 0, 1], (cells + 1, cells + 1))
    laplacian = (sp.kronsum(one, one) / h**2).tocsr()[inside][:, inside]
    phi = spsolve(laplacian.tocsc(), np.full(int(inside.sum()), -2.0))
    return float(2.0 * phi.sum() * h**2)


def mohr(inertia: float) -> float:
    """Deflection of the tip by a unit force at AT, m/N: of bending, with the reduced section
    between LOW and HIGH, and of shear (Cowper's coefficient of a circle).
    """
    z = np.linspace(0.0, LENGTH, 200_001)
    stiffness = E * np.where((z > LOW) & (z < HIGH), inertia, math.pi * R**4 / 4.0)
    bending = np.trapezoid(np.maximum(AT - z, 0.0) / stiffness * (LENGTH - z), z)
    area = np.where((z > LOW) & (z < HIGH), left_by_flats()[0], math.pi * R**2)
    shear = np.trapezoid((z < AT) / (G * area * 0.886), z)
    return float(bending + shear)


def in_series(reduced: float, full: float, modulus: float) -> float:
    """Flexibility of a bar up to AT, of a section but for the one between LOW and HIGH."""
    return ((HIGH - LOW) / reduced + (AT - HIGH + LOW) / full) / modulus


@pytest.fixture(scope="module")
def bar_with_flats() -> CutField:
    """Pulled, twisted, and bent both ways at once: the answers do not mix."""
    (solution,) = solve_pin(FLATS, STEEL, ("start",), (ALL,), QUICK)
    assert isinstance(solution.answer, CutField)
    return solution.answer


def test_the_tip_moves_as_that_of_a_beam_of_the_reduced_section(bar_with_flats: CutField) -> None:
    """To 2 % of what all of it moves (ends of flats, load and clamp are no beam's); without the
    flats it is 9 to 55 % less.
    """
    area, about_y, about_x = left_by_flats()
    circle = math.pi * R**4 / 4.0
    x, y, z, spin = at_tip(bar_with_flats.picture(ALL, 0))
    expected = [
        200.0 * mohr(about_y), 300.0 * mohr(about_x), 2e4 * in_series(area, math.pi * R**2, E),
        40.0 * in_series(torsion_constant(), 2.0 * circle, G),
    ]  # fmt: skip
    assert [x, y, z, spin] == pytest.approx(expected, rel=0.02)
    uncut = [
        200.0 * mohr(circle), 300.0 * mohr(circle), 2e4 * AT / math.pi / R**2 / E,
        40.0 * AT / G / 2.0 / circle,
    ]  # fmt: skip
    assert (np.array(uncut) < 0.92 * np.array(expected)).all()


def test_there_is_no_jump_where_pieces_begin_and_end() -> None:
    """On the outline, between the last points of a piece and what lies beyond it."""
    pin = CutPin(BAR, [Hole(0.05, 0.014, 0.3), Hole(0.12, 0.008, 1.2)])
    (solution,) = solve_pin(pin, STEEL, ("start",), (ALL,), QUICK)
    answer = solution.answer
    assert isinstance(answer, CutField)
    picture = answer.picture(ALL, 0)
    largest, checked = np.linalg.norm(picture.displacement, axis=1).max(), 0
    sizes = [len(p.points) for p in answer.solution.pieces]
    own = np.repeat(np.arange(len(sizes) + 1), [len(picture.points) - sum(sizes), *sizes])
    for k, piece in enumerate(answer.solution.pieces, 1):
        for end in {piece.piece.z0, piece.piece.z1} - {0.0, LENGTH}:
            near = np.abs(picture.points[:, 2] - end) < 1e-9
            round_ = np.hypot(*picture.points[:, :2].T) > R - 1e-9
            here, there = (np.flatnonzero(near & round_ & x) for x in (own == k, own != k))
            if len(there) < 40:  # inside of another piece
                continue
            x, u = picture.points, picture.displacement
            jump = u[here] - between(x[there], u[there], x[here])
            assert np.linalg.norm(jump, axis=1).max() < 1.5e-3 * largest
            checked += 1
    assert checked >= 2


def test_the_view_has_the_same(bar_with_flats: CutField) -> None:
    """The page superposes unit fields; what it shows is what is in the VTU file."""
    surface = bar_with_flats.surface()
    seen = surface.unit.displacement @ surface.amounts(ALL)[0, :, 0]
    largest = np.linalg.norm(seen, axis=1).max()
    assert largest > math.hypot(*at_tip(bar_with_flats.picture(ALL, 0))[:3])
    assert np.abs(seen - bar_with_flats.picture(ALL, 0).displacement).max() < 1e-9 * largest


def without_motion(points: Floats, u: Floats) -> Floats:
    """Displacements but for the rigid motion that fits them best."""
    modes = np.zeros((len(points), 3, 6))
    for a in range(3):
        b, c = (a + 1) % 3, (a + 2) % 3
        modes[:, a, a] = 1.0
        modes[:, b, 3 + a], modes[:, c, 3 + a] = -points[:, c] / D, points[:, b] / D
    flat = modes.reshape(-1, 6)
    return np.asarray(u - (flat @ np.linalg.lstsq(flat, u.ravel())[0]).reshape(u.shape))


THREE = Pin(
    "three",
    (
        Segment(0.02, D), Segment(0.02, D, connection="A"), Segment(0.04, D),
        Segment(0.02, D, connection="M"), Segment(0.04, D), Segment(0.02, D, connection="C"),
    ),
)  # fmt: skip
BENT = PinLoads("c", ("A", "M", "C"), 1e3 * np.array([[[-1.0, 0, 0], [2.0, 0, 0], [-1.0, 0, 0]]]))
BENT_UNDER = replace(BENT, distribution="cosine")
TWICE = Pin("t", (Segment(0.06, D, name="a"), Segment(0.02, D, connection="B"), Segment(0.06, D)))
ACROSS, ASKEW = Hole(0.05, 0.014, math.pi / 2.0), Hole(0.05, 0.012, 0.3)
BENDS, TWISTS = loaded([300.0, 0.0, 0.0]), loaded([100.0, 300.0, 0.0], [0.0, 0.0, 30.0])
WHOLE: dict[str, tuple[Pin, list[Cut], tuple[str, ...], PinLoads]] = {
    "a hole of 14 in 20, bent": (BAR, [ACROSS], ("start",), BENDS),
    "a hole of 14 in 20, pulled": (BAR, [ACROSS], ("start",), loaded([0.0, 0.0, 2e4])),
    "a hole askew, bent and twisted": (BAR, [ASKEW], ("start",), TWISTS),
    "one flat, pulled": (
        BAR, [Flat(0.06, 0.08, 0.006, 0.5, 0.001)], ("start",), loaded([0.0, 0.0, 2e4])
    ),
    "two pieces that overlap": (
        BAR, [Hole(0.05, 0.012, math.pi / 2.0), Hole(0.077, 0.01, 0.3)], ("start",), TWISTS
    ),
    "between two clamps": (
        TWICE, [Hole(0.035, 0.012, math.pi / 2.0)], ("start", "end"), loaded([300.0, 0.0, 5e3])
    ),
    "clamped at its other end": (
        Pin("e", (Segment(0.02, D, connection="B"), Segment(0.1, D))),
        [Hole(0.07, 0.014, math.pi / 2.0)], ("end",), BENDS,
    ),
    "not clamped": (THREE, [Hole(0.01, 0.01), Hole(0.06, 0.014, math.pi / 2.0)], (), BENT),
    "under bearing pressure": (THREE, [Hole(0.06, 0.012, math.pi / 2.0)], (), BENT_UNDER),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(WHOLE, every=8))
def test_all_of_the_surface_moves_as_that_of_the_whole_solid(name: str) -> None:
    """To 2 % of its largest displacement; of a pin that nothing clamps but for a rigid motion, and
    both ends of its axis stay where they are (to the change of its section's shape).
    """
    pin, cuts, clamps, loads = WHOLE[name]
    meshes = 2 if clamps and len(cuts) == 1 else 1
    local = shown(CutPin(pin, cuts), clamps, loads, QUICK)
    solid = shown(CutPin(pin, cuts), clamps, loads, Requirement(0.1, "solid", meshes=meshes))
    x, u = local.points, local.displacement
    there = np.ones(len(x), dtype=bool)
    if len(cuts) == 2 and clamps:  # each piece has the pin's outline where the other one's cut is
        (solution,) = solve_pin(CutPin(pin, cuts), STEEL, clamps, (loads,), QUICK)
        there = _own(solution.answer, len(x), x[:, 2])
    off = u - between(solid.points, solid.displacement, x)
    if not clamps:
        off = without_motion(x, off)
        for end in (x[:, 2].min(), x[:, 2].max()):
            middle = u[np.abs(x[:, 2] - end) < 1e-9].mean(axis=0)
            assert np.abs(middle).max() < 5e-3 * np.abs(u).max()
    assert np.linalg.norm(off, axis=1)[there].max() < 0.02 * np.linalg.norm(u, axis=1).max()


def _own(answer: object, count: int, z: Floats) -> Floats:
    """Points of which piece's cut is the nearer one."""
    assert isinstance(answer, CutField)
    first, second = answer.solution.pieces
    middle = 0.5 * (zone(first.piece)[1] + zone(second.piece)[0])
    rest = count - len(first.points) - len(second.points)
    own = np.repeat([0, 1, 2], [rest, len(first.points), len(second.points)])
    return np.asarray((own == 0) | ((own == 1) == (z <= middle)))
