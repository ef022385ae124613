"""Loose lugs under light loads press on narrow arcs, which the usual cells do not follow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.joints.named_pins import clevis
from fea.core.requirement import MINOR_CASE, Requirement
from fea.solve.solve import solve
from fea.support.contact.contact_support import profile_of
from fea.support.contact.resolution import MAX_CELLS, RESOLUTIONS, ROUGH, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.variations import ResolutionComparison, compare, nowhere
from fea.support.lugs.lug import LugRange
from fea.support.records import JointResult
from fea.support.support import PinProblem

CLEARANCE = 5e-5  # of the diameters, m
FINE = Resolution(8, 144, 48)  # within 3 % of cells finer still at the loads below
LIGHT = 0.1, 0.01  # of 50 kN, with half angles of contact of 24 and 6 degrees


def loose(load: float) -> PinProblem:
    pull = clevis()
    (case,) = pull.cases
    lugs = tuple(replace(lug, clearance=CLEARANCE) for lug in pull.lugs)
    return replace(pull, lugs=lugs, cases=(replace(case, forces=load * case.forces),))


def on(cells: Resolution, load: float) -> tuple[ResolutionComparison, float]:
    """The stress on some cells with its error, and the half angle of contact, rad."""
    given = loose(load)
    model = ContactModel(profile_of(given.pin), given.material, given.lugs, cells)
    contact = model.solve(given.cases[0])
    (found,) = compare(model, [contact], Requirement(), vary=nowhere)
    return found, float(contact.contact_angle[0].min())


@pytest.fixture(scope="module")
def fine() -> dict[float, tuple[ResolutionComparison, float]]:
    return {load: on(FINE, load) for load in LIGHT}


@pytest.mark.slow
def test_the_error_of_cells_covers_that_on_narrow_arcs(
    fine: dict[float, tuple[ResolutionComparison, float]],
) -> None:
    off = []
    for load, (truth, _) in fine.items():
        for cells in (ROUGH, *RESOLUTIONS[:2]):
            found, _ = on(cells, load)
            for place in ("surface", "section", "beneath"):
                true, value = (getattr(x.stress, place) for x in (truth, found))
                assert abs(true / value - 1.0) < getattr(found.cells, place) + 0.03
            off.append(abs(found.stress.surface / truth.stress.surface - 1.0))
    assert max(off) > 0.5  # what the test is about


@pytest.mark.long
@pytest.mark.slow
def test_the_error_of_cells_covers_that_on_narrow_arcs_of_one_lug_with_round_edges() -> None:
    """The joint of benchmarks/joints/narrow_arcs.py that cells of contact err most on."""
    given = loose(LIGHT[1])
    free = zip(given.lugs, (0.0, CLEARANCE, 0.0), strict=True)
    lugs = tuple(replace(lug, clearance=c, edge_radius=1e-3) for lug, c in free)

    def found(cells: Resolution) -> ResolutionComparison:
        model = ContactModel(profile_of(given.pin), given.material, lugs, cells)
        contact = model.solve(given.cases[0])
        return compare(model, [contact], Requirement(), vary=nowhere)[0]

    truth = found(FINE)
    for cells in (ROUGH, RESOLUTIONS[0]):
        here = found(cells)
        for place in ("surface", "section", "beneath"):
            true, value = (getattr(x.stress, place) for x in (truth, here))
            assert abs(true / value - 1.0) < getattr(here.cells, place) + 0.03
        assert truth.stress.surface > 1.7 * here.stress.surface


@pytest.mark.slow
def test_the_half_angle_is_known_whatever_the_cells(
    fine: dict[float, tuple[ResolutionComparison, float]],
) -> None:
    """It is where a lug presses most; counted is the least of all lugs."""
    sector = 2.0 * np.pi / FINE.sectors
    for load, (truth, counted) in fine.items():
        assert counted - sector < truth.half_angle < counted + 2.0 * sector
        assert on(ROUGH, load)[0].half_angle == pytest.approx(truth.half_angle, rel=0.15)


@pytest.mark.long
@pytest.mark.slow
def test_cells_follow_narrow_arcs_to_the_tolerance(
    fine: dict[float, tuple[ResolutionComparison, float]],
) -> None:
    for load in LIGHT:
        (found,) = solve(loose(load), Requirement(tolerance=0.02))
        assert found.peak.verdict == "converged"
        truth = fine[load][0].stress.surface
        assert found.peak.max_von_mises == pytest.approx(truth, rel=0.03)


@pytest.mark.slow
@pytest.mark.long
def test_a_light_case_leaves_the_cells_of_a_heavy_one_as_they_are() -> None:
    """Cells that follow the arcs of the light case have fewer rings than the heavy one needs."""
    heavy, light = loose(1.0), loose(LIGHT[1])
    of_light = replace(light.cases[0], case="light")
    both = replace(heavy, cases=(heavy.cases[0], of_light))
    wanted = Requirement(tolerance=0.012)
    (alone,), (one, other) = solve(heavy, wanted), solve(both, wanted)
    assert one.peak.max_von_mises == alone.peak.max_von_mises
    assert one.peak.parts == alone.peak.parts
    assert one.peak.verdict == "converged"
    (as_alone,) = solve(light, wanted)
    assert other.peak.max_von_mises == pytest.approx(as_alone.peak.max_von_mises, rel=1e-6)


@pytest.mark.slow
def test_a_minor_case_stays_on_usual_cells_inside_its_stated_error(
    fine: dict[float, tuple[ResolutionComparison, float]],
) -> None:
    """The heavy case governs by far, whose numbers are those without it."""
    heavy, wanted = loose(1.0), Requirement(tolerance=0.02, required=2.0, every=False)
    cases = tuple(replace(loose(x).cases[0], case=f"{x:g}") for x in LIGHT)
    steel = replace(heavy.material, yield_strength=900e6)
    heavy = replace(heavy, material=steel)
    (alone,) = solve(heavy, wanted)
    one, *others = solve(replace(heavy, cases=(*heavy.cases, *cases)), wanted)
    assert one.peak.max_von_mises == pytest.approx(alone.peak.max_von_mises, rel=0.002)
    assert one.peak.verdict == "converged"
    for load, other in zip(LIGHT, others, strict=True):
        peak, truth = other.peak, fine[load][0].stress.surface
        assert MINOR_CASE in peak.reasons
        assert peak.verdict == "unconverged"
        assert peak.max_von_mises is not None
        assert peak.error_estimate is not None
        assert abs(truth - peak.max_von_mises) < peak.error_estimate


def test_arcs_decide_on_sectors_within_the_limit_of_cells() -> None:
    usual = RESOLUTIONS[1]
    assert usual.for_arcs(1.0, 24) is usual
    narrow = usual.for_arcs(0.2, 24)
    assert narrow.highest >= 8.0 / 0.2
    assert narrow.sectors == 2 * narrow.highest
    for half, rings in [(0.2, 24), (1e-3, 24), (1e-3, 60), (1e-9, 120)]:
        cells = usual.for_arcs(half, rings)
        assert cells is usual or rings * cells.sectors <= MAX_CELLS
        assert cells.sectors % 4 == 0  # cells twice as large have half of them, evenly


@pytest.mark.long
@pytest.mark.slow
def test_an_arc_that_no_cells_follow_has_an_error_that_says_so() -> None:
    (found,) = solve(loose(1e-3), Requirement(tolerance=0.02))
    assert found.peak.verdict == "unconverged"
    assert found.peak.parts is not None
    assert found.peak.max_von_mises is not None
    assert found.peak.parts.cells > 0.2 * found.peak.max_von_mises


@pytest.mark.slow
def test_the_range_over_clearance_covers_the_stress_on_narrow_arcs(
    fine: dict[float, tuple[ResolutionComparison, float]],
) -> None:
    """Without clearance arcs are wide, and usual cells are enough for all but the range."""
    load = LIGHT[-1]
    given = loose(load)
    open_ = LugRange(clearance=(0.0, CLEARANCE))
    lugs = tuple(replace(lug, clearance=0.0, range=open_) for lug in given.lugs)
    (found,) = solve(replace(given, lugs=lugs), Requirement(tolerance=0.02))
    assert isinstance(found.joint, JointResult)
    assert found.joint.range is not None
    (loosest,) = (x for x in found.joint.range.variations if x.length == CLEARANCE)
    truth = fine[load][0].stress
    assert loosest.max_von_mises < 0.8 * truth.surface
    assert loosest.interval is not None
    assert loosest.interval[1] > truth.surface
    assert found.joint.range.max_von_mises[1] > truth.surface
    assert loosest.beneath is not None
    assert 1.05 * loosest.beneath > truth.beneath  # which is known to 3 %
