"""The pins on the page: their drawings with loads and stress, and a line for every case."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from math import cos, radians, sin

import numpy as np
import pytest

from fea.core.places import Places, SectionPlace, SurfacePlace
from fea.support.records import JointForces
from reports.data.results import PinShape, Results, Surface, Units
from reports.data.surface import LoadCourse
from reports.page.pin_drawing import draw_pin
from reports.page.pins import governing_names, pin_parts
from reports.page.pins_reading import reading_parts, signs
from reports.page.stress_along import StressAlong, stress_along
from reports.page.stress_panel import ticks
from reports.tables.column import PinRow
from reports.tables.stress.joint import carrying_share
from tests.support.results.judged_results import checks
from tests.support.results.made_up_joint import in_lugs, make_joint, surface_in
from tests.support.results.made_up_run import make_results
from tests.support.results.rows import with_values

UNITS = Units("in", "lbf", "psi", "s")
SHAPE = PinShape(
    "A",
    (
        (1.0, 2.0, 0.0, "left", "band"),
        (1.0, 3.0, 0.0, "", "plain"),
        (1.0, 2.0, 0.0, "middle", "band"),
    ),
    "steel",
    None,
)
COURSE = ((0.0, 0.0), (1.5, 2000.0), (3.0, 0.0))
SURFACE_PLACE = SurfacePlace(1500.0, 15.0, "converged", (0.0, 1.0, 0.5))
SECTION_PLACE = SectionPlace(
    2000.0, 10.0, "converged", 1.5, None, 0.0, 400.0, 123.4, 0.0, course=COURSE
)


def loads(*forces: tuple[float, float, float]) -> tuple[LoadCourse, ...]:
    """The forces of the bands, at z 0.5 and 2.5."""
    bands = (("left", 0.5), ("middle", 2.5))
    return tuple(
        LoadCourse(name, z, 1.0, np.array([force]), False)
        for (name, z), force in zip(bands, forces, strict=False)
    )


def surface(*forces: tuple[float, float, float]) -> Surface:
    """A cylinder whose stress rises from 100 at z = 0 to 1600 at z = 3; z = 1 is not read."""
    one = surface_in("retract")
    z = np.arange(4.0)
    case = replace(
        one.cases[0],
        largest=100.0 + 500.0 * z,
        excluded=z == 1.0,
        loads=loads(*forces),
    )
    points = np.stack([np.ones(4), 0.0 * z, z], axis=1)
    return replace(one, points=points, cases=(case,))


def of_one_pin(*forces: tuple[float, float, float], **changes: object) -> Results:
    found = make_results()
    places = Places("section", SURFACE_PLACE, SECTION_PLACE)
    values = {"location": (0.0, 1.0, 1.5), "max_von_mises": 2000.0, "error_estimate": 10.0}
    values |= {"safety_factor": 5.0, "required": 10.0, "places": places, "decided": False}
    found = in_lugs(found, make_joint(), **(values | changes))
    return replace(found, pins=found.pins[:1], shapes=(SHAPE,), surfaces=(surface(*forces),))


def shown(results: Results, shape: PinShape = SHAPE) -> StressAlong:
    along = stress_along(results, shape)
    assert along is not None
    return along


FORCES = ((0.0, -400.0, 0.0), (0.0, 300.0, 100.0))


def test_the_largest_force_lies_in_the_plane_of_the_drawing() -> None:
    for angle in (0.0, 37.0, 90.0, 120.0, 200.0, 300.0):
        c, s = cos(radians(angle)), sin(radians(angle))
        forces = ((500.0 * c, 500.0 * s, 0.0), (-200.0 * s, 200.0 * c, 0.0))
        along = shown(of_one_pin(*forces))
        first, second = along.loads
        assert abs(first.up) == pytest.approx(500.0)
        assert first.towards == pytest.approx(0.0, abs=1e-9)
        assert second.up == pytest.approx(0.0, abs=1e-9)
        # z to the right, u upwards: z x u towards the viewer, on which the second force lies
        u = np.array([cos(radians(along.angle)), sin(radians(along.angle)), 0.0])
        towards = np.cross([0.0, 0.0, 1.0], u) @ np.array(forces[1])
        assert second.towards == pytest.approx(towards)
        assert abs(towards) == pytest.approx(200.0)
        assert u[0] + u[1] >= 0.0


def test_a_pin_with_cuts_is_drawn_with_x_upwards() -> None:
    from tests.pinstress.study.model.test_drawn_cuts import shape

    cut = replace(SHAPE, cuts=shape().cuts)
    along = shown(of_one_pin(*FORCES), cut)
    assert along.angle == 0.0
    assert [load.towards for load in along.loads] == [-400.0, 300.0]


def test_curves_are_those_of_the_results() -> None:
    along = shown(of_one_pin(*FORCES))
    ((z, stress),) = along.surface
    assert z.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert stress[[0, 2, 3]].tolist() == [100.0, 1100.0, 1600.0]
    assert np.isnan(stress[1])  # an excluded zone is no point of the curve
    assert list(zip(*along.section, strict=True)) == list(COURSE)
    # line loads of 300, -100 on the left, 300, 100 in the middle, over a diameter of 2
    assert along.pressure == (
        (0.0, 0.5, 150.0), (0.5, 1.0, 50.0), (1.25, 1.75, 150.0), (1.75, 2.25, 50.0),
    )  # fmt: skip
    assert along.maximum == 2000.0
    assert along.allowed == pytest.approx(1000.0)
    assert along.top == 2000.0


def test_a_lug_without_a_link_has_its_reaction() -> None:
    joint = JointForces(
        np.zeros(1), None, np.zeros((1, 1)), np.zeros((1, 1)), ("left", "middle"),
        np.array([[[7.0, 24.0], [0.0, -400.0]]]),
    )  # fmt: skip
    results = of_one_pin((0.0, -400.0, 0.0))
    row = replace(results.pins[0], joint=replace(make_joint(), along=joint))
    only = replace(results.surfaces[0].cases[0], loads=loads((0, 0, 0), (0.0, -400.0, 0.0))[1:])
    surfaces = (replace(results.surfaces[0], cases=(only,)),)
    along = shown(replace(results, pins=(row,), surfaces=surfaces))
    assert sorted((x.z, x.size) for x in along.loads) == [(0.5, 25.0), (2.5, 400.0)]


def drawn(along: StressAlong) -> str:
    return draw_pin(SHAPE, UNITS, along=along)


def test_the_drawing_has_the_forces_with_their_sizes_and_directions() -> None:
    svg = drawn(shown(of_one_pin(*FORCES)))
    for words in (">400.0 lbf<", ">316.2 lbf<", ">90°<", ">z<"):
        assert words in svg
    tails = re.findall(r'class="load" d="M([\d.]+),([\d.]+)V([\d.]+)"', svg)
    assert len(tails) == 2
    (down, up) = sorted(tails, key=lambda x: float(x[0]))
    assert float(down[2]) > float(down[1])  # y is downwards: the arrow points down
    assert float(up[2]) < float(up[1])
    assert '<circle class="load"' in svg.replace("\n", "") or 'class="load" cx' not in svg
    sideways = drawn(shown(of_one_pin((0.0, -400.0, 0.0), (300.0, 0.0, 0.0))))
    assert sideways.count('<circle class="load"') == 1
    assert sideways.count('class="load" d=') == 1


def test_the_governing_place_and_the_curves_share_the_axis_of_the_pin() -> None:
    svg = drawn(shown(of_one_pin(*FORCES)))
    ends = re.findall(r'<rect x="([\d.]+)" y="[\d.]+" width="([\d.]+)"', svg)
    left, scale = float(ends[0][0]), float(ends[0][1])  # the first segment is 1 in long
    (mark,) = re.findall(r'class="governs" cx="([\d.]+)" cy="([\d.]+)"', svg)
    assert float(mark[0]) == pytest.approx(left + 1.5 * scale, abs=0.02)
    (section,) = re.findall(r'<polyline points="([^"]+)" class="section"', svg)
    points = [tuple(map(float, p.split(","))) for p in section.split()]
    assert [x for x, _ in points] == pytest.approx(
        [left, left + 1.5 * scale, left + 3.0 * scale], abs=0.06
    )
    assert points[1][1] == pytest.approx(float(mark[1]), abs=0.06)  # it is the row's stress
    (pressed,) = re.findall(r'<path d="([^"]+)" class="pressure"', svg)
    starts = [float(x) for x in re.findall(r"M([\d.]+),", pressed)]
    assert starts[2] == pytest.approx(left + 1.25 * scale, abs=0.02)
    assert len(re.findall(r'class="surface"', svg)) == 2  # about what is not read
    assert ">max 2,000<" in svg
    assert ">allowed 1,000<" in svg


def test_a_pin_without_results_is_its_profile() -> None:
    results = replace(of_one_pin(), pins=())
    assert stress_along(results, SHAPE) is None
    svg = draw_pin(SHAPE, UNITS)
    assert "polyline" not in svg
    assert 'class="load"' not in svg


@pytest.mark.parametrize("top", [1e-3, 0.7, 1.0, 9.99, 123.0, 4e5])
def test_ticks_are_round_and_few(top: float) -> None:
    found = ticks(top)
    assert 2 <= len(found) <= 5
    assert found[0] == 0.0
    assert top - found[-1] < found[1]
    assert {round(b - a, 12) for a, b in pairwise(found)} == {round(found[1], 12)}
    assert float(f"{found[1]:e}".partition("e")[0]) in (1.0, 2.0, 5.0)


def test_every_case_has_a_line_and_the_worst_is_the_first() -> None:
    results = make_results()
    parts = {part.pin: part for part in pin_parts(results, {})}
    assert len(parts) == 9
    a = parts["A"]
    assert a.table is not None
    assert a.table.head == ["case", "factor", "stress [psi]", "±", "z [in]", "time [s]"]
    assert [line[0] for line in a.table.body] == ["landing", "retract"]
    assert a.table.body[0][1:4] == ["19.1", "6,173", "0.50 %"]
    assert a.outcomes == ("safe", "safe")
    assert [case.governs for case in a.cases] == [True, False]
    assert parts["J"].outcomes[0] == "fails"
    assert governing_names(results, "A") == {"landing"}


def test_the_case_of_the_worst_check_governs_too() -> None:
    results, check = make_results(), checks()[0]
    pins = tuple(
        replace(p, worst=(replace(check, demand=2e5 if p.case == "retract" else 1e4),))
        for p in results.pins
    )
    assert governing_names(replace(results, pins=pins), "A") == {"landing", "retract"}


def test_a_lug_carries_over_the_rings_that_push_with_its_force() -> None:
    results = in_lugs(make_results(), make_joint())
    row = results.pins[0]
    assert row.joint is not None
    shares = [carrying_share(PinRow(row, UNITS, band)) for band in row.joint.bands]
    assert shares == [0.5, 1.0, 1.0]  # the left lug holds back on its second ring
    bare = replace(row.joint.bands[0], ends=())
    assert carrying_share(PinRow(row, UNITS, bare)) is None


def test_conventions_are_said_where_they_are_needed() -> None:
    joined = reading_parts(of_one_pin(*FORCES))
    assert {"Drawing", "Loads", "Lugs", "Stress along the pin", "Places"} <= set(joined)
    bare = make_results()
    bare = replace(bare, pins=(with_values(bare.pins[0], singular_at=()),))
    assert not {"Lugs", "Singularities", "Places"} & set(reading_parts(bare))
    assert "right-handed" not in " ".join(joined.values())
    assert signs().count("marker-end") == 4
