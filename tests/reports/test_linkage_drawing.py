"""The drawing of a linkage: what stands where, on the first screen and on the page of `check`."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from reports.data.mechanics import AppliedForce, PitchCurve
from reports.data.overview import pin_lines
from reports.data.results import Results
from reports.page.linkage_drawing import ARROW_CLEARANCE, ARROW_LENGTHS, Instant, Mark, draw_linkage
from reports.page.pin_marks import governing_instant, pin_marks

SVG = "{http://www.w3.org/2000/svg}"


def of_class(drawing: ET.Element, name: str) -> list[ET.Element]:
    return [e for e in drawing.iter() if e.get("class") == name]


def numbers(element: ET.Element, key: str) -> list[float]:
    return [float(x) for x in re.findall(r"-?[\d.]+", element.get(key, ""))]


def centres(drawing: ET.Element) -> np.ndarray:
    return np.array(
        [[float(c.get(k, "nan")) for k in ("cx", "cy")] for c in of_class(drawing, "joint")]
    )


def test_pins_stand_at_their_joints(results: Results) -> None:
    """Every symbol is at the centre of the ring of its joint, and links to its part of the page."""
    at = governing_instant(results, pin_lines(results))
    assert at is not None
    assert at.table is not None
    joints = at.motion.joints
    ends = zip(at.table.connections, joints * len(at.table.connections), strict=False)
    connected = tuple((name, at.motion.bodies[0], joint) for name, joint in ends)
    at = replace(at, motion=replace(at.motion, connections=connected))
    marks = pin_marks(at, pin_lines(results), {p.pin: f"pin-{p.pin}" for p in results.pins})
    assert marks
    drawing = ET.fromstring(draw_linkage(at, marks, "a < b", "lbf"))
    pixels = dict(zip(joints, centres(drawing), strict=True))
    groups = [g for g in drawing.iter(f"{SVG}g") if g.get("transform")]
    assert len(groups) == len(marks)
    for group, mark in zip(groups, reversed(marks), strict=True):
        assert numbers(group, "transform") == pytest.approx(pixels[mark.joint])
        (link,) = group.iter(f"{SVG}a")
        assert link.get("href") == f"#pin-{mark.name}"
    assert drawing.get("aria-label") == "a < b"
    assert drawing.get("role") == "group"


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
    at = Instant(replace(motion, applied=forces), 0)
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


def test_gears_have_their_pitch_circle_to_scale(results: Results) -> None:
    """A wheel about one joint whose circle passes through another."""
    motion = results.motion[0]
    ends = motion.joint_position[:, :2]
    wheel = PitchCurve(motion.bodies[0], ends, True)
    at = Instant(replace(motion, pitch=(wheel,), applied=()), 0)
    drawing = ET.fromstring(draw_linkage(at, [], "x", "N"))
    (circle,) = of_class(drawing, "pitch")
    first, second = centres(drawing)[:2]
    assert [float(circle.get(k, "nan")) for k in ("cx", "cy")] == pytest.approx(first)
    assert float(circle.get("r", "nan")) == pytest.approx(np.hypot(*(second - first)), abs=0.2)
