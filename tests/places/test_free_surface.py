"""Where the surface of a pin in its lugs is read, beside loops written from the definition."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.pressed import ARC_ANGLES, ARC_COUNT, UNREAD_EDGE_RINGS, PressedArcs
from fea.core.voigt import von_mises
from fea.harmonic.beneath import ARC_STRIDE, _distance, depths
from fea.harmonic.free_surface import FreeSurface, SurfacePoints, surface_points
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.harmonic.superposition import Circumference
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import stacked
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from pinbase.arrays import Mask

STEEL = Material("steel", 210e9, 0.3)
D = 0.02


@dataclass(frozen=True)
class Solved:
    """At two instants, of unlike size and direction."""

    contact: JointContact
    of: SurfacePoints
    free: FreeSurface

    @property
    def pressed(self) -> PressedArcs:
        assert self.contact.loads.pressed is not None
        return self.contact.loads.pressed

    def cells(self, instant: int) -> tuple[Mask, Floats]:
        """Which have pressure, (R, M), and how deep (BINS, M), in degrees, arcs are in them made
        wider by a sector, which whole arcs have.
        """
        found = self.contact.contact[instant]
        sectors = found.pressure.shape[1]
        middles = np.degrees(self.contact.angles + found.angle)
        off = np.abs((np.degrees(ARC_ANGLES)[:, None] - middles + 180.0) % 360.0 - 180.0)
        return found.pressure > 0.0, 180.0 / sectors + math.ceil(360.0 / sectors) - off

    @property
    def ends(self) -> tuple[Floats, Floats]:
        """Of the rings, (R,) m."""
        bands = self.contact.bands
        return bands.z - bands.length / 2.0, bands.z + bands.length / 2.0


@pytest.fixture(scope="module", params=[0.0, 5e-4], ids=["sharp", "rounded"])
def solved(request: pytest.FixtureRequest) -> Solved:
    return with_edges(request.param)


def with_edges(radius: float, fillet: float = 5e-4) -> Solved:
    """The pin in lugs with edges of a radius, m, the first of them beside a fillet of another."""
    pin = Pin(
        "P",
        (
            Segment(0.004, 1.3 * D),
            Segment(0.0012, D),
            Segment(0.010, D, connection="L"),
            Segment(0.001, D),
            Segment(0.020, D, connection="M"),
            Segment(0.010, D, connection="R"),
            Segment(0.010, D),
        ),
        fillet,
    )
    lugs = [Lug(c, 2.5 * D, STEEL, edge_radius=radius, tilt=1e5) for c in "LMR"]
    share = np.array([-0.55, 1.0, -0.45])[:, None] * 50e3
    along = np.array([[1.0, 0.0, 0.0], [0.4 * math.cos(0.3), 0.4 * math.sin(0.3), 0.0]])
    model = ContactModel(pin, STEEL, lugs, Resolution(6, 36, 12))
    loads = PinLoads("c", ("L", "M", "R"), along[:, None, :] * share[None], times=np.arange(2.0))
    contact = model.solve(loads)
    problem = SectionProblem(model.pin, STEEL, (), (contact.loads,), (), model.first)
    fields = harmonic_solution(problem, 0, 1.0).fields
    assert contact.loads.pressed is not None
    of = surface_points(fields, contact.loads.pressed.rings, 0.3)
    return Solved(contact, of, FreeSurface(of, contact.loads.pressed))


def next_to(of: Solved, ring: int, way: int) -> int | None:
    """The ring that begins where one ends, that way; None across a gap."""
    start, end = of.ends
    other = ring + way
    if not 0 <= other < len(start):
        return None
    gap = start[ring] - end[other] if way < 0 else start[other] - end[ring]
    return other if abs(gap) < 1e-9 else None


def shutting(of: Solved, pressed: Mask, r: float, middle: float) -> Mask:
    """Cells (M,) that keep a point of the outline from being read: of the ring on which it is, and
    of the last pressed ones that it is beside.
    """
    (start, end), bands = of.ends, of.contact.bands
    out = np.zeros(pressed.shape[1], dtype=bool)
    for ring in range(len(start)):
        own, off = float(bands.length[ring]), abs(r - float(bands.radius[ring]))
        if off <= 1e-3 * own and start[ring] < middle < end[ring]:
            out |= pressed[ring]
        for way, away in ((-1, start[ring] - middle), (1, middle - end[ring])):
            other = next_to(of, ring, way)
            felt = own if other is None else min(own, float(bands.length[other]))
            if 0.0 < away < felt and off <= felt:
                out |= pressed[ring] if other is None else pressed[ring] & ~pressed[other]
    return out


def test_the_free_surface_is_that_of_its_definition(solved: Solved) -> None:
    """Pressed are cells with p > 0, with a sector more on both sides, and beyond the last pressed
    ring its own length, or that of the next. What is in that, deeper than half an arc, is not read;
    all else is, but where a lug's edge stands for it.
    """
    of, free = solved.of, solved.free
    stands = {k for cusp in of.cusps.values() for k in cusp.between.tolist()}
    plain = [k for k in np.flatnonzero(of.relieved < 0).tolist() if k not in of.cusps]
    points = np.sort(np.random.default_rng(0).choice(plain, 300, replace=False))
    partly = 0
    for instant in range(2):
        pressed, depth = solved.cells(instant)
        found = free.read(points, np.full(len(points), instant))
        masked = free.masked(points)
        for k, read, some in zip(points.tolist(), found, masked, strict=True):
            shut = shutting(solved, pressed, float(of.fields.points[k, 0]), float(of.middle[k]))
            deep = depth[:, shut].max(axis=1) if shut.any() else np.full(ARC_COUNT, -np.inf)
            assert not read[deep > 0.5].any()
            if k not in stands:
                assert read[deep < -0.5].all()
            assert some or read.all()
            partly += int(0 < read.sum() < ARC_COUNT)
    assert partly > 100


def test_the_edges_of_lugs_are_read_where_all_beside_them_is(solved: Solved) -> None:
    """And then instead of what is between, which feels the last step of the pressure."""
    of, free = solved.of, solved.free
    assert of.cusps or not solved.pressed.rings.edge.any()  # rings may be too long for a fit
    for instant in range(2):
        seen = np.zeros(ARC_COUNT, dtype=bool)
        for edge, cusp in of.cusps.items():
            (read,) = free.read(np.array([edge]), np.array([instant]))
            each = free.read(cusp.near, np.full(len(cusp.near), instant))
            assert np.array_equal(read, each.all(axis=0))
            inner = free.read(cusp.between, np.full(len(cusp.between), instant))
            assert not (inner & read).any()
            seen |= read
        assert seen.any() or not of.cusps


def test_the_edge_of_a_lug_beside_a_fillet_is_not_extrapolated() -> None:
    """A fit between the two takes the fillet's stress for a cusp. What is between is not read
    instead: it feels the last step of the pressure.
    """
    found = with_edges(1e-4, fillet=1.1e-3)
    of, free = found.of, found.free
    (near,) = [k for k, cusp in of.cusps.items() if not cusp.fits]
    cusp = of.cusps[near]
    assert cusp.place == pytest.approx((D / 2, 0.0052 + 1e-4))
    assert near in of.fields.unread
    assert not set(of.cusps) - {near} & set(of.fields.unread.tolist())
    for instant in range(2):
        (beside,) = free.read(np.array([near]), np.array([instant]))
        inner = free.read(cusp.between, np.full(len(cusp.between), instant))
        beyond = free.read(cusp.near, np.full(len(cusp.near), instant))
        assert beyond[:, beside].all()
        assert not inner[:, beside].any()


def test_pressed_surface_is_read_away_from_the_edges_of_lugs(solved: Solved) -> None:
    """Amid rings, as the stress without the pressure's own: all round, but for those
    under the rounding of a lug, and the pressed ones beside it, from which contact has not receded.
    """
    of, free, rings = solved.of, solved.free, solved.pressed.rings
    points = np.flatnonzero(of.relieved >= 0)
    assert set(of.relieved[points].tolist()) == set(range(len(rings)))
    bands = solved.contact.bands
    off = np.abs(of.fields.points[points, 1] - bands.z[of.relieved[points]])
    assert (off <= 0.201 * bands.length[of.relieved[points]]).all()
    for instant in range(2):
        pressed, depth = solved.cells(instant)
        found = free.read(points, np.full(len(points), instant))
        for k, read in zip(points.tolist(), found, strict=True):
            ring = int(of.relieved[k])
            own = np.flatnonzero(rings.band == rings.band[ring])
            shut = np.full(pressed.shape[1], rings.edge[ring])
            for side in (own.tolist(), own[::-1].tolist()):
                rounded = 0
                while rounded < len(side) and rings.edge[side[rounded]]:
                    rounded += 1
                reached = pressed[side[: rounded + 1]].any(axis=0)
                if ring in side[: rounded + UNREAD_EDGE_RINGS]:
                    shut |= pressed[ring] & reached
            deep = depth[:, shut].max(axis=1) if shut.any() else np.full(ARC_COUNT, -np.inf)
            assert not read[deep > 0.5].any()
            assert read[deep < -0.5].all()


def test_arcs_of_stacked_loads_follow_each_other(solved: Solved) -> None:
    both = [solved.contact.loads.at(np.array([t])) for t in (1, 0, 1)]
    made = stacked(both)
    assert made.pressed is not None
    assert np.array_equal(made.pressed.on, solved.pressed.on[[1, 0, 1]])
    assert not np.array_equal(solved.pressed.on[0], solved.pressed.on[1])


def test_depths_are_how_far_stress_exceeds_any_limit(solved: Solved) -> None:
    """All over the section and round it, from the highest stress down: what reaches at least so
    far.
    """
    fields, loads = solved.of.fields, solved.contact.loads
    rows = np.flatnonzero(~np.isin(np.arange(len(fields.points)), fields.unread))
    stress = von_mises(Circumference(fields, loads).stress(rows, 0, ARC_ANGLES[::ARC_STRIDE]))
    away = _distance(fields.points[rows], solved.pressed, 0)
    found = depths(fields, loads, 0, (), 0.0)
    for limit in np.quantile(stress, [0.3, 0.7, 0.99, 0.9999]).tolist():
        expected = float(away[stress > limit].max(initial=0.0))
        assert max((d for x, d in found if x > limit), default=0.0) == pytest.approx(expected)
