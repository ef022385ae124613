"""When meshes and cells are enough: where their error decides nothing that finer ones might."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.mesh_history import MeshHistory
from fea.core.mesh_result import MeshMaximum, ZoneMaximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement, accurate_enough
from fea.core.verdict import evidence_of, judge
from fea.core.zone import Zone
from fea.harmonic.evaluate import SECTION_MESHES
from fea.solve.refine import met
from fea.support.contact.cell_error import AtPlaces
from fea.support.contact.pressed_cases import Compared, with_minor
from fea.support.contact.variations import ResolutionComparison
from tests.support.each import each

STEEL = Material("steel", 210e9, 0.3, yield_strength=400e6)
CLAMP = Zone(0.01, 0.02, "edge of a clamp", ("held", "shaft"), 0.5, 0.5, 0.002, "none")
DECIDE = Requirement(goal="decide", required=2.0)  # a limit of 200 MPa


def mesh(maximum: float, felt: float, interval: tuple[float, float] | None = None) -> MeshMaximum:
    """Stresses in MPa; felt: next to a clamp's edge."""
    edge = ZoneMaximum(felt * 1e6, felt * 1e6, (0.0, 0.0, 0.0))
    ends = interval and (interval[0] * 1e6, interval[1] * 1e6)
    return MeshMaximum(1000, maximum * 1e6, 0, (0.0, 0.0, 0.0), (edge,), interval=ends)


def seen(*results: MeshMaximum, fewest: int = 3) -> MeshHistory:
    times = (0.1,) * len(results)
    meshes = replace(SECTION_MESHES, min_meshes=fewest)
    return MeshHistory("P", "c", "harmonic", results, times, meshes)


@each(
    ("felt", "maximum", "done"),
    [
        (90.0, 100.0, True),  # far below the limit
        (150.0, 100.0, True),  # also with the whole interval
        (500.0, 300.0, True),  # far above
        (90.0, 199.0, False),  # its error reaches the limit
        (250.0, 180.0, False),  # its interval does
    ],
)
def test_meshes_decide_as_soon_as_there_are_enough(felt: float, maximum: float, done: bool) -> None:
    """Two of a pin in contact, three of others: fewer can agree by chance."""
    ends = None if felt < maximum else (0.9 * maximum, 1.15 * maximum)
    first, second = mesh(maximum, felt, ends), mesh(1.002 * maximum, felt, ends)
    requirement = replace(DECIDE, tolerance=1e-3)
    assert accurate_enough(requirement, STEEL, seen(first, second, fewest=2)) is done
    assert not accurate_enough(requirement, STEEL, seen(first, fewest=2))
    assert not accurate_enough(requirement, STEEL, seen(first, second))
    assert not accurate_enough(
        replace(requirement, goal="value"), STEEL, seen(first, second, fewest=2)
    )


def test_a_surface_that_is_surely_below_the_sections_needs_no_finer_mesh() -> None:
    """Whatever is asked: the row is that of the sections."""
    first, second = mesh(100.0, 0.0), mesh(104.0, 0.0)
    here = seen(first, second, fewest=2)
    high = here.range[1]
    for section, done in ((1.001 * high, True), (0.999 * high, False)):
        requirement = Requirement(1e-4, section_stress={"c": section})
        assert accurate_enough(requirement, STEEL, here) is done
        assert ("surface-below-sections" in met(requirement, STEEL, here).codes) is done
    assert not accurate_enough(Requirement(1e-4, section_stress={"d": 2.0 * high}), STEEL, here)


def test_ends_that_change_from_mesh_to_mesh_widen_the_interval() -> None:
    before, last = mesh(100.0, 150.0, (92.0, 130.0)), mesh(100.0, 150.0, (94.0, 120.0))
    steady, moved = seen(last, last), seen(before, last)
    assert moved.relative == steady.relative
    ratio = 1.0 + moved.relative
    assert steady.range[1] == pytest.approx(120e6 * ratio)
    assert moved.range[1] == pytest.approx(130e6 * ratio)
    assert moved.range[0] == pytest.approx(92e6 * (1.0 - moved.relative))
    # the maximum was not governed by what is excluded before: nothing to compare with
    assert seen(mesh(100.0, 90.0), last).range == pytest.approx(steady.range)


def compared(surface: float, section: float, beneath: float, cells: AtPlaces) -> Compared:
    """Stresses in MPa, at one instant."""
    links = PinLoads("c", ("A",), np.zeros((1, 1, 3)))
    at = AtPlaces(1e6 * surface, 1e6 * section, 1e6 * beneath)
    found = ResolutionComparison(at, cells, links, ())
    return Compared(found, found)


@each(
    ("stress", "cells", "value", "decide"),
    [
        ((150.0, 100.0, 90.0), (0.01, 0.01, 0.01), True, True),  # little of the tolerance
        ((150.0, 100.0, 90.0), (0.05, 0.05, 0.05), False, True),  # safe by far
        ((196.0, 100.0, 90.0), (0.05, 0.05, 0.05), False, False),  # the limit is within the error
        ((150.0, 188.0, 90.0), (0.05, 0.08, 0.05), False, False),  # of the sections', too
        ((150.0, 150.0, 195.0), (0.05, 0.05, 0.05), False, False),  # and of what lies beneath
        ((150.0, 150.0, 250.0), (0.05, 0.05, 0.05), False, True),  # too much beneath, surely
        ((250.0, 150.0, 195.0), (0.05, 0.05, 0.05), False, True),  # fails, whatever lies beneath
        ((150.0, 100.0, 90.0), (0.01, 0.9, 0.01), False, True),  # sections may be more: 190 MPa
        ((150.0, 60.0, 90.0), (0.01, 0.9, 0.01), True, True),  # or surely not
    ],
)
def test_when_cells_are_fine_enough(
    stress: tuple[float, float, float],
    cells: tuple[float, float, float],
    value: bool,
    decide: bool,
) -> None:
    found = compared(*stress, AtPlaces(*cells))
    assert found.fine(STEEL, Requirement(tolerance=0.02)) is value
    assert found.fine(STEEL, DECIDE) is decide


@each(
    ("light", "error", "factors", "every", "minor"),
    [
        (80.0, 0.1, {}, False, ("light",)),  # at most 88 of at least 198 MPa
        (80.0, 0.3, {}, False, ()),  # perhaps 104
        (99.5, 0.0, {}, False, ()),  # half of 200 MPa, but not of 198
        (80.0, 0.1, {"light": 2.4}, False, ()),  # 105 of 198 MPa, for the same factor
        (80.0, 0.1, {"heavy": 1.5}, False, ()),  # 88 of 148 MPa
        (80.0, 0.1, {}, True, ()),  # its maximum is wanted
        (80.0, 0.01, {}, False, ()),  # and known to the tolerance
    ],
)
def test_a_case_is_minor_that_surely_has_less_than_half_of_another_for_its_factor(
    light: float, error: float, factors: dict[str, float], every: bool, minor: tuple[str, ...]
) -> None:
    found = {
        "light": compared(light, 0.5 * light, 0.5 * light, AtPlaces(error, 0.0, 0.0)),
        "heavy": compared(200.0, 100.0, 100.0, AtPlaces(0.01, 0.0, 0.0)),
    }
    wanted = with_minor(Requirement(required=2.0, factors=factors, every=every), found)
    assert tuple(wanted.minor) == minor
    goals = [wanted.of_case(case).goal for case in found]
    assert goals == ["decide" if case in minor else "value" for case in found]


def test_stress_beneath_contact_counts_for_what_is_minor_and_a_factor_is_needed() -> None:
    heavy = compared(200.0, 100.0, 100.0, AtPlaces(0.01, 0.0, 0.0))
    deep = compared(80.0, 40.0, 95.0, AtPlaces(0.1, 0.0, 0.1))
    both = {"light": deep, "heavy": heavy}
    assert not with_minor(Requirement(required=2.0, every=False), both).minor
    light = {**both, "light": compared(80.0, 40.0, 40.0, AtPlaces(0.1, 0.0, 0.1))}
    assert with_minor(Requirement(required=2.0, every=False), light).minor == ("light",)
    assert not with_minor(Requirement(every=False), light).minor


def test_two_meshes_may_be_too_few() -> None:
    last = mesh(100.0, 90.0)
    peak = judge(evidence_of(seen(last, last), (CLAMP,)), 0.02)
    assert peak.verdict == "unconverged"
    assert "too-few-meshes" in peak.reasons
    assert "only 2 meshes were solved" in peak.note
    enough = evidence_of(seen(last, last, fewest=2), (CLAMP,))
    assert judge(enough, 0.02).verdict == "converged"
