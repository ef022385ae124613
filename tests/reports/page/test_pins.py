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
from reports.data.results import LugSketch, PinShape, Results
from reports.data.row import Units
from reports.data.surface import LoadCourse, Surface
from reports.format.drawing.camera import View
from reports.page.lug_across import draw_across, most_loaded
from reports.page.pin_drawing import draw_pin
from reports.page.pins import governing_names, pin_parts
from reports.page.pins_reading import reading_parts, signs
from reports.page.stress_along import StressAlong, stress_along
from reports.page.stress_panel import StressPanel, ticks
from reports.tables.column import PinRow
from reports.tables.stress.joint import carrying_share
from tests.support.each import each
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
    # loads of 300 and -100 on the left, of 300 and 100 in the middle, along the force of each
    up = 300.0 / np.hypot(300.0, 100.0)
    assert np.array(along.line_loads) == pytest.approx(
        np.array([
            (0.0, 0.5, -300.0), (0.5, 1.0, 100.0), (1.25, 1.75, 300.0 * up),
            (1.75, 2.25, 100.0 * up),
        ])
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
    assert len(re.findall(r'class="surface"', svg)) == 2  # about what is not read
    assert ">max 2,000<" in svg
    assert ">allowed 1,000<" in svg


def in_lugs_of(outer: float, bushing: float = 0.0) -> PinShape:
    """The pin in lugs about its bands, from 0 to 1 and from 2 to 3."""
    lugs = (
        LugSketch("left", (0.0, 1.0), outer, 0.0, "steel", bushing=bushing),
        LugSketch("middle", (2.0, 3.0), outer, 0.0, "steel"),
    )
    return replace(SHAPE, lugs=lugs)


def rectangles(svg: str, kind: str) -> list[tuple[float, ...]]:
    """x, y, width and height of the rectangles of a class."""
    pattern = rf'<rect class="{kind}" x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"'
    return [tuple(map(float, found)) for found in re.findall(pattern, svg)]


@each("maximum", [324.5, 305.0, 300.1])
def test_the_allowed_stress_and_the_maximum_are_not_written_on_one_another(maximum: float) -> None:
    """On a short pin they were, where the maximum is a little larger."""
    none = np.zeros(0)
    along = StressAlong("c", 0.0, (), (), (none, none), (), 20.0, maximum, 300.0)
    svg = "".join(StressPanel(along, (40.0, 1.6, 58.0), 0.0).draw("MPa"))
    places = re.findall(r'<text x="(.*?)" y="(.*?)" text-anchor="(.*?)".*?>(max|allowed) ', svg)
    rows = {name: (float(x), float(y), anchor) for x, y, anchor, name in places}
    assert rows["max"][2] == "start"
    assert rows["max"][0] + 50.0 > rows["allowed"][0] - 60.0  # so that they share the width
    assert abs(rows["max"][1] - rows["allowed"][1]) >= 11.0


def test_the_allowed_stress_is_not_written_on_the_key_of_a_short_pin() -> None:
    known = (np.array([0.0, 20.0]), np.array([0.0, 280.0]))
    along = StressAlong("c", 0.0, (), (known,), known, (), 20.0, 280.0, 300.0)
    svg = "".join(StressPanel(along, (40.0, 1.6, 58.0), 0.0).draw("MPa"))
    (key,) = re.findall(r'y="([^"]*)"[^>]*>section<', svg)
    (allowed,) = re.findall(r'y="([^"]*)"[^>]*>allowed ', svg)
    assert float(allowed) - float(key) >= 12.0


def test_lugs_are_drawn_to_scale() -> None:
    """Width, gap and diameters of lugs and bushing, in the scale of the pin, about its axis."""
    svg = draw_pin(in_lugs_of(5.0, bushing=0.25), UNITS)
    above, below, other, _ = rectangles(svg, "lug")
    scale = above[2]  # the lug is 1 in wide
    assert other[0] - above[0] == pytest.approx(2.0 * scale, abs=0.02)  # from z = 0 to z = 2
    assert below[1] + below[3] - above[1] == pytest.approx(5.0 * scale, abs=0.03)
    hole = below[1] - above[1] - above[3]
    assert hole == pytest.approx((2.0 + 2.0 * 0.25) * scale, abs=0.03)
    ring, _ = rectangles(svg, "bushing")
    assert ring[3] == pytest.approx(0.25 * scale, abs=0.02)
    assert ring[1] + ring[3] == pytest.approx(above[1] + above[3] + 0.25 * scale, abs=0.03)


def test_the_load_per_length_is_on_the_side_that_carries() -> None:
    """A force down on the left presses from above; where it is negative, from below."""
    along = shown(of_one_pin((0.0, -400.0, 0.0), (0.0, 300.0, 0.0)))
    svg = draw_pin(in_lugs_of(5.0), UNITS, along=along)
    (path,) = re.findall(r'<path d="([^"]+)" class="pressure"', svg)
    bars = re.findall(r"M([\d.]+),([\d.]+)V([\d.]+)H([\d.]+)V", path)
    (first, negative, third, fourth) = (tuple(map(float, bar)) for bar in bars)
    lug = rectangles(svg, "lug")[0]
    left, scale = lug[0], lug[2]
    assert first[0] == pytest.approx(left, abs=0.02)
    assert first[3] == pytest.approx(left + 0.5 * scale, abs=0.02)
    assert third[0] == pytest.approx(left + 1.25 * scale, abs=0.02)
    assert first[1] == pytest.approx(lug[1] + lug[3], abs=0.02)  # from the pin's upper side
    assert first[2] < first[1]  # upwards, y being downwards
    assert negative[2] > negative[1] > first[1]
    assert third[2] > third[1]
    heights = [abs(bar[2] - bar[1]) for bar in (first, negative, third, fourth)]
    assert heights == pytest.approx(
        [heights[0], heights[0] / 3.0, heights[0], heights[0] / 3.0], abs=0.03
    )
    assert ">300.0 lbf/in<" in svg or ">300 lbf/in<" in svg
    tails = re.findall(r'class="load" d="M[\d.]+,([\d.]+)V([\d.]+)"', svg)
    assert float(tails[0][1]) < lug[1]  # the arrow ends at the lug, not in it


def test_the_most_loaded_lug_across_its_axis() -> None:
    """Pressure from below carries a force upwards; eye, bushing and pin in one scale."""
    results = of_one_pin((0.0, -400.0, 0.0), (0.0, 300.0, 0.0))
    surface_of_pin = results.surfaces[0]
    points = np.array([[1.0, 0.0, 0.25], [1.0, 0.0, 0.75], [1.0, 0.0, 2.25], [1.0, 0.0, 2.75]])
    sectors = 8
    pressure = np.zeros((4, sectors))
    pressure[2:, 6] = 100.0, 900.0  # at 270 degrees: from below, as y is upwards
    case = replace(
        surface_of_pin.cases[0], rings=np.arange(4), pressure=pressure, largest=np.ones(4),
        excluded=np.zeros(4, bool),
    )  # fmt: skip
    results = replace(results, surfaces=(replace(surface_of_pin, points=points, cases=(case,)),))
    shape = in_lugs_of(5.0)
    shape = replace(shape, lugs=(shape.lugs[0], replace(shape.lugs[1], bushing=0.25)))
    of = most_loaded(results, shape)
    assert of is not None
    assert (of.lug.connection, of.pin, of.z) == ("middle", 2.0, 2.75)
    assert of.arc == pytest.approx(45.0)
    assert of.force == pytest.approx((0.0, 400.0), abs=1e-9)  # of the made-up joint's middle lug
    svg = draw_across(results, shape, shown(results, shape))
    radii = dict(re.findall(r'<circle class="(\w+)" [^>]*?r="([\d.]+)"', svg))
    eye = float(radii["lug"])
    assert float(radii["pin"]) == pytest.approx(eye * 2.0 / 5.0, abs=0.02)
    assert float(radii["bushing"]) == pytest.approx(eye * 2.5 / 5.0, abs=0.02)
    (around,) = re.findall(r'<path class="around" d="([^"]+)"', svg)
    corners = np.array(
        [tuple(map(float, p.split(","))) for p in re.findall(r"[\d.]+,[\d.]+", around)]
    )
    assert (corners[:, 1] > 120.0).all()  # below the middle
    assert corners[:, 0].mean() == pytest.approx(120.0, abs=0.05)


def test_a_pin_without_results_is_its_profile() -> None:
    results = replace(of_one_pin(), pins=())
    assert stress_along(results, SHAPE) is None
    svg = draw_pin(SHAPE, UNITS)
    assert "polyline" not in svg
    assert 'class="load"' not in svg


@each("top", [1e-3, 0.7, 1.0, 9.99, 123.0, 4e5])
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
    failing = replace(results, pins=pins)
    assert governing_names(failing, "A") == {"landing", "retract"}
    part = next(part for part in pin_parts(failing, {}) if part.pin == "A")
    assert (part.outcome, part.outcomes) == ("fails", ("safe", "safe"))  # the stress alone is


def test_a_lug_carries_over_the_rings_that_push_with_its_force() -> None:
    results = in_lugs(make_results(), make_joint())
    row = results.pins[0]
    assert row.joint is not None
    shares = [carrying_share(PinRow(row, band)) for band in row.joint.bands]
    assert shares == [0.5, 1.0, 1.0]  # the left lug holds back on its second ring
    bare = replace(row.joint.bands[0], ends=())
    assert carrying_share(PinRow(row, bare)) is None


def test_conventions_are_said_where_they_are_needed() -> None:
    joined = reading_parts(of_one_pin(*FORCES))
    assert {"Drawing", "Loads", "Lugs", "Stress along the pin", "Places"} <= set(joined)
    bare = make_results()
    bare = replace(bare, pins=(with_values(bare.pins[0], singular_at=()),))
    assert not {"Lugs", "Singularities", "Places"} & set(reading_parts(bare))
    assert "right-handed" not in " ".join(joined.values())
    assert signs().count("marker-end") == 4


@each("peak", [(0.0, 1.0, 0.2), (-1.0, 0.0, 2.9), (0.6, -0.8, 1.5)])
def test_views_have_z_from_left_to_right_as_drawings(peak: tuple[float, float, float]) -> None:
    points = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0.0, 3.0)])
    view = View.of(points, np.array(peak))
    towards = view.eye - view.centre
    right = np.cross(view.up, towards)
    assert right[2] > 0.8 * np.linalg.norm(right)
    assert view.up[2] == pytest.approx(0.0)  # the axis is level
    assert towards[:2] @ np.array(peak[:2]) > 0.0  # from the side of the maximum
