"""The drawing of a linkage: what stands where, on the first screen and on the page of `check`."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from reports.data.motion import AppliedForce, PitchCurve
from reports.data.overview import pin_lines
from reports.data.results import Results
from reports.data.skeleton import AppliedCouple, planar_skeleton
from reports.format.drawing.projection import isometric, three_views
from reports.page.linkage_drawing import LETTER, draw_linkage
from reports.page.linkage_panel import Instant, Mark
from reports.page.linkage_parts import ARROW_CLEARANCE, ARROW_LENGTHS, AXIS_REACH
from reports.page.overview import overview_part
from reports.page.paper import document
from reports.page.pin_marks import governing_instant, pin_marks
from tests.support.results.space_results import landing_gear, rssr

SVG = "{http://www.w3.org/2000/svg}"


def of_class(drawing: ET.Element, name: str) -> list[ET.Element]:
    return [e for e in drawing.iter() if e.get("class") == name]


def numbers(element: ET.Element, key: str) -> list[float]:
    return [float(x) for x in re.findall(r"-?[\d.]+", element.get(key, ""))]


def centres(drawing: ET.Element) -> np.ndarray:
    return np.array(
        [[float(c.get(k, "nan")) for k in ("cx", "cy")] for c in of_class(drawing, "joint")]
    )


def linked(results: Results) -> tuple[Instant, list[Mark]]:
    """The linkage of the results and their pins on it, with links to their parts of the page."""
    at = governing_instant(results, pin_lines(results))
    assert at is not None
    assert at.table is not None
    joints = at.skeleton.joints
    ends = zip(at.table.connections, joints * len(at.table.connections), strict=False)
    connected = tuple((name, at.skeleton.bodies[0], joint) for name, joint in ends)
    at = replace(at, skeleton=replace(at.skeleton, connections=connected))
    return at, pin_marks(at, pin_lines(results), {p.pin: f"pin-{p.pin}" for p in results.pins})


def test_pins_stand_at_their_joints(results: Results) -> None:
    """Every symbol is at the centre of the ring of its joint, and links to its part of the page."""
    at, marks = linked(results)
    assert marks
    drawing = ET.fromstring(draw_linkage(at, marks, "a < b", "lbf"))
    pixels = dict(zip(at.skeleton.joints, centres(drawing), strict=True))
    groups = [g for g in drawing.iter(f"{SVG}g") if g.get("transform")]
    assert len(groups) == len(marks)
    for group, mark in zip(groups, reversed(marks), strict=True):
        assert numbers(group, "transform") == pytest.approx(pixels[mark.joint])
        (link,) = group.iter(f"{SVG}a")
        assert link.get("href") == f"#pin-{mark.name}"
    assert drawing.get("aria-label") == "a < b"
    assert drawing.get("role") == "group"


def test_the_caption_names_the_case_that_is_drawn(results: Results) -> None:
    """It named that of the worst pin, of which a case of given forces has no linkage."""
    worst = pin_lines(results)[0].row.case
    motion = tuple(x for x in results.motion if x.case != worst)
    (drawn,) = {x.case for x in motion}
    screen = overview_part(replace(results, motion=motion), {}, "")
    assert f"Linkage in case {drawn};" in screen["linkage"]
    assert screen["caption"].startswith(f"Case {drawn}. ")


def test_on_paper_the_linkage_has_no_links(results: Results) -> None:
    """Of links with a tabindex only the ends were removed: a PDF was refused as damaged."""
    drawing = draw_linkage(*linked(results), "", "lbf")
    screen = overview_part(results, {}, "") | {"linkage": drawing}
    printed = document(results, {}, screen)["overview"]["linkage"]
    names = [[e.tag for e in ET.fromstring(d).iter()] for d in (drawing, printed)]
    assert f"{SVG}a" in names[0]
    assert sorted(names[1]) == sorted([x for x in names[0] if x != f"{SVG}a"] + [f"{SVG}style"])


def test_arrows_are_as_long_as_their_forces(results: Results) -> None:
    """Down and to the right on the page, at twice and once the force, off the place by a mark."""
    motion = replace(results.motion[0], time=None)
    place = motion.joint_position[:1, 0]
    body = next(
        b for b, on in zip(motion.bodies, motion.links, strict=True) if motion.joints[0] in on
    )
    forces = (
        AppliedForce(body, place, np.array([[0.0, -200.0]])),
        AppliedForce(body, place, np.array([[100.0, 0.0]])),
    )
    at = Instant(planar_skeleton(replace(motion, applied=forces)), 0)
    drawing = ET.fromstring(draw_linkage(at, [Mark(motion.joints[0], "<J>")], "x", "N"))
    short, long = ARROW_LENGTHS
    x, y = centres(drawing)[0]
    down, right = (numbers(path, "d") for path in of_class(drawing, "load"))
    head = 9.0  # whose base is the end of the line
    assert down == pytest.approx(
        [x, y - ARROW_CLEARANCE - long, x, y - ARROW_CLEARANCE - head], abs=0.11
    )
    reach = short + (long - short) / 2.0
    assert right == pytest.approx(
        [x - ARROW_CLEARANCE - reach, y, x - ARROW_CLEARANCE - head, y], abs=0.11
    )
    texts = ["".join(t.itertext()) for t in drawing.iter(f"{SVG}text")]
    assert texts == ["<J>", "200.0 N", "100.0 N"]
    assert drawing.get("role") == "img"


def test_no_label_hides_its_arrow(results: Results) -> None:
    """The size of a force that points up and to the right is not above and to the right of its
    tail.
    """
    motion = replace(results.motion[0], time=None)
    place = motion.joint_position[:1, 0]
    body = next(
        b for b, on in zip(motion.bodies, motion.links, strict=True) if motion.joints[0] in on
    )
    force = AppliedForce(body, place, np.array([[100.0, 100.0]]))
    at = Instant(planar_skeleton(replace(motion, applied=(force,))), 0)
    drawing = ET.fromstring(draw_linkage(at, [], "x", "N"))
    (arrow,) = (numbers(path, "d") for path in of_class(drawing, "load"))
    (label,) = of_class(drawing, "force")
    middle = np.array([float(label.get(k, "nan")) for k in ("x", "y")]) - [0.0, 5.0]
    along = np.linspace(arrow[:2], arrow[2:], 20)
    half = 0.5 * np.array([LETTER[0] * len("141.4 N"), LETTER[1]])
    assert not (np.abs(along - middle) < half).all(axis=1).any()


def test_a_side_force_is_a_ring_with_its_tip_or_its_tail(results: Results) -> None:
    """A dot for z, towards the reader, a cross for -z; beside its point, off all joints."""
    motion = replace(results.motion[0], time=None)
    place = motion.joint_position[:1, 0]
    body = next(
        b for b, on in zip(motion.bodies, motion.links, strict=True) if motion.joints[0] in on
    )
    up = AppliedForce(body, place, np.array([[0.0, 100.0]]))
    sides = [AppliedForce(body, place, np.array([[0.0, 0.0, z]])) for z in (20.0, -30.0)]
    skeleton = planar_skeleton(replace(motion, applied=(up,), aside=tuple(sides)))
    drawing = ET.fromstring(draw_linkage(Instant(skeleton, 0), [], "x", "N"))
    rings = [g for g in drawing.iter(f"{SVG}g") if of_class(g, "load end")]
    towards, away = ([e.get("class") for e in ring] for ring in rings)
    assert towards == ["load end", "head"]
    assert away == ["load end", "load end"]
    (cross,) = of_class(rings[1], "load end")[1:]
    assert cross.tag == f"{SVG}path"
    texts = ["".join(t.itertext()) for t in drawing.iter(f"{SVG}text")]
    assert texts == ["100.0 N", "20.00 N", "30.00 N"]
    joints = centres(drawing)
    dot, tail = (np.array(numbers(ring, "transform")) for ring in rings)
    for centre in (dot, tail):
        assert np.abs(centre - joints[0]).max() < 40.0
        assert np.linalg.norm(joints - centre, axis=1).min() > 9.0
    assert np.abs(dot - tail).max() > 9.0


def test_gears_have_their_pitch_circle_to_scale(results: Results) -> None:
    """A wheel about one joint whose circle passes through another."""
    motion = results.motion[0]
    ends = motion.joint_position[:, :2]
    wheel = PitchCurve(motion.bodies[0], ends, True)
    at = Instant(planar_skeleton(replace(motion, pitch=(wheel,), applied=())), 0)
    drawing = ET.fromstring(draw_linkage(at, [], "x", "N"))
    (circle,) = of_class(drawing, "pitch")
    first, second = centres(drawing)[:2]
    assert [float(circle.get(k, "nan")) for k in ("cx", "cy")] == pytest.approx(first)
    assert float(circle.get("r", "nan")) == pytest.approx(np.hypot(*(second - first)), abs=0.2)


@pytest.mark.parametrize(
    "up", [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, -1.0), (-1.0, 0.0, 0.0)]
)
def test_an_isometric_view_shortens_all_axes_alike(up: tuple[float, float, float]) -> None:
    """By sqrt(2/3), with the vertical upwards and the others 120 degrees away; seen from above."""
    view = isometric(up)
    vertical = view(np.array(up))
    assert vertical == pytest.approx([0.0, np.sqrt(2.0 / 3.0)])
    axes = view(np.eye(3))
    assert np.linalg.norm(axes, axis=1) == pytest.approx(np.sqrt(2.0 / 3.0))
    others = axes[np.abs(up) < 0.5]
    assert np.abs(others @ vertical) == pytest.approx(1.0 / 3.0)  # 2/3 cos 60 or 120 degrees
    assert view.depth(np.array(up)) == pytest.approx(1.0 / np.sqrt(3.0))


def test_three_views_are_those_of_a_drawing() -> None:
    """Point (1, 2, 3): from the front x and z, from the right y and z, from above x and y."""
    point = np.array([1.0, 2.0, 3.0])
    front, side, top = three_views((0.0, 0.0, 1.0))
    assert [view(point).tolist() for view in (front, side, top)] == [[1, 3], [2, 3], [1, 2]]
    assert [view.depth(point) for view in (front, side, top)] == [-2.0, 1.0, 3.0]
    front, side, top = three_views((0.0, 1.0, 0.0))  # of a plane x-y that is lifted
    assert [view(point).tolist() for view in (front, side, top)] == [[1, 2], [-3, 2], [1, -3]]


def test_a_linkage_in_space_is_drawn_in_four_views() -> None:
    """Its pixels are one scale times the projections, in three views the same scale."""
    skeleton = rssr().space[0]
    k, marks = 9, [Mark(joint, joint) for joint in skeleton.joints]
    drawing = ET.fromstring(draw_linkage(Instant(skeleton, k), marks, "RSSR", "N"))
    panels = [drawing, *of_class(drawing, "view")]
    views = [isometric(skeleton.up), *three_views(skeleton.up)]
    scales = []
    for panel, view in zip(panels, views, strict=True):
        rings = [e for e in panel if e.get("class") == "joint"]
        pixels = np.array([[float(e.get(key, "nan")) for key in ("cx", "cy")] for e in rings])
        exact = view(skeleton.position[k]) * [1.0, -1.0]
        scale = _scale(pixels, exact)
        shift = pixels - scale * exact
        assert np.abs(shift - shift.mean(axis=0)).max() < 0.11  # pixels have one decimal
        scales.append(scale)
    assert scales[1:] == pytest.approx([scales[1]] * 3, rel=0.003)
    titles = ["".join(e.itertext()) for e in of_class(drawing, "view-title")]
    assert titles == ["Front (x, z)", "Right side (y, z)", "Top (x, y)"]
    texts = ["".join(e.itertext()) for e in drawing.iter(f"{SVG}text")]
    assert all(texts.count(joint) == 4 for joint in skeleton.joints)


def _scale(pixels: np.ndarray, exact: np.ndarray) -> float:
    """The factor of the best fit of a scale and a shift."""
    a, b = pixels - pixels.mean(axis=0), exact - exact.mean(axis=0)
    return float((a * b).sum() / (b * b).sum())


def test_axes_of_pins_are_along_their_directions() -> None:
    """Of the joints with an axis; one that is seen end on is its ring alone."""
    skeleton = rssr().space[0]
    drawing = ET.fromstring(draw_linkage(Instant(skeleton, 9), [], "RSSR", "N"))
    view = isometric(skeleton.up)
    lines = [numbers(e, "d") for e in drawing if e.get("class") == "axis"]
    for found, axis in zip(lines, ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]), strict=True):
        x1, y1, x2, y2 = found
        along = 2.0 * AXIS_REACH * view(np.array(axis))
        assert [x2 - x1, y1 - y2] == pytest.approx(along.tolist(), abs=0.11)
    front, side, top = of_class(drawing, "view")
    assert [len(of_class(panel, "axis")) for panel in (front, side, top)] == [2, 1, 1]


def test_loads_in_space_say_their_size_once_and_point_where_they_push() -> None:
    gear = landing_gear()
    skeleton = gear.space[0]
    (load,) = skeleton.applied
    at = Instant(skeleton, 5, gear.reactions[0])
    drawing = ET.fromstring(draw_linkage(at, [], "gear", "N"))
    arrow = next(numbers(e, "d") for e in drawing if e.get("class") == "load")
    seen = isometric(skeleton.up)(load.force[5])
    direction = np.array([arrow[2] - arrow[0], arrow[1] - arrow[3]])
    assert direction / np.hypot(*direction) == pytest.approx(seen / np.hypot(*seen), abs=0.02)
    texts = ["".join(e.itertext()) for e in drawing.iter(f"{SVG}text")]
    assert [text for text in texts if text.startswith(f"{load.sizes[5]:,.0f}"[:4])] != []
    assert len(of_class(drawing, "mass")) == 4  # the wheel's, in every view
    assert len(of_class(drawing, "ground")) == 12


def test_a_load_along_the_view_is_a_ring() -> None:
    """With a dot where it points at the viewer, with a cross where it points away."""
    skeleton = landing_gear().space[0]
    load = skeleton.applied[0]
    for sign in (1.0, -1.0):
        force = np.zeros_like(load.force)
        force[:, 2] = sign * 1e3
        at = Instant(replace(skeleton, applied=(replace(load, force=force),)), 0)
        drawing = ET.fromstring(draw_linkage(at, [], "gear", "N"))
        panels = of_class(drawing, "view")
        rings = [len(list(panel.iter(f"{SVG}g"))) - 1 for panel in panels]
        assert rings == [0, 0, 1]
        ends = of_class(panels[2], "load end")
        assert len(ends) == (1 if sign > 0.0 else 2)
        assert len(of_class(panels[2], "head")) == (1 if sign > 0.0 else 0)


def test_a_couple_has_two_heads_along_its_axis_and_its_own_unit() -> None:
    gear = landing_gear()
    skeleton = gear.space[0]
    axle = skeleton.axes[:, 3]
    couple = AppliedCouple("wheel", skeleton.position[:, 3], 2500.0 * axle)
    at = Instant(replace(skeleton, applied=(), couples=(couple,)), 20)
    drawing = ET.fromstring(draw_linkage(at, [], "gear", "N", "mm"))
    x1, y1, x2, y2 = next(numbers(e, "d") for e in drawing if e.get("class") == "load")
    seen = isometric(skeleton.up)(axle[20])
    assert np.array([x2 - x1, y1 - y2]) / np.hypot(x2 - x1, y2 - y1) == pytest.approx(
        seen / np.hypot(*seen), abs=0.02
    )
    assert len([e for e in drawing if e.get("class") == "head"]) == 2
    assert "2,500 N·mm" in ["".join(t.itertext()) for t in drawing.iter(f"{SVG}text")]


def test_springs_are_zigzags_between_their_points() -> None:
    """In every view, and with their names for a pointer."""
    at = Instant(landing_gear(3).space[0], 0)
    ends = np.array([[0.0, 0.0, 900.0], [200.0, 90.0, -600.0]])[None].repeat(3, axis=0)
    at = replace(at, skeleton=replace(at.skeleton, springs={"rope <1>": ends}))
    drawing = ET.fromstring(draw_linkage(at, [], "", "N"))
    springs = of_class(drawing, "spring")
    assert len(springs) == 4
    assert [title.text for spring in springs for title in spring] == ["rope <1>"] * 4
    lug = at.skeleton.joints.index("stay lug")
    joint = of_class(drawing, "joint")[lug]
    there = [float(joint.get(key, "nan")) for key in ("cx", "cy")]
    assert numbers(springs[0], "d")[-2:] == pytest.approx(there, abs=0.11)
