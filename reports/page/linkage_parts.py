"""The parts of the drawing of a linkage in one view: bodies, pins, supports, loads."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

import numpy as np

from pinbase.dimensions import Floats
from reports.data.mechanics import ReactionTable
from reports.format.drawing.svg_labels import label_offsets
from reports.format.drawing.zigzag import zigzag
from reports.page.linkage_panel import Instant, LinkagePanel, Points

ARROW_CLEARANCE = 12.0  # between the tip of an arrow and the place where its force acts
ARROW_LENGTHS = (22.0, 38.0)  # of the smallest and the largest force
MIN_LINK_WIDTH, MAX_LINK_WIDTH = 1.5, 12.0
PLAIN_LINK_WIDTH = 2.2  # of links without a known force
SUPPORT_HEIGHT = 19.0
SPRING_HALF_WIDTH = 5.0
AXIS_REACH, PIN_REACH = 24.0, 13.0  # half lengths of the axis of a joint and of its pin
MIN_AXIS_LENGTH = 1.0  # on the picture; of a shorter axis only the ring of the joint is drawn
END_ON_LENGTH = 0.25  # projection of a unit vector; shorter ones are drawn as seen end on
RING_SIZE = 18.0  # diameter of the ring of an arrow seen end on, with its line
TRIAD_REACH, TRIAD_LETTERS = 20.0, 27.0  # distances of arrow tips and letters from the origin


@dataclass(frozen=True)
class LoadArrow:
    """The arrow of an applied force or couple.

    tip, tail: its ends (2,), pixels.
    size: the magnitude of the force or couple.
    end_on: 1 where it points at the viewer, -1 where it points away, otherwise 0.
    couple: whether it is a couple, about the arrow, which then has two heads.
    """

    tip: Floats
    tail: Floats
    size: float
    end_on: int = 0
    couple: bool = False


def forces_at(table: ReactionTable, k: int) -> Floats:
    """Return the forces (C, 2 or 3) at the connections at an instant."""
    forces = table.forces.reshape(-1, *table.forces.shape[-2:])
    return np.asarray(forces[min(k, len(forces) - 1)])


def _widths(at: Instant) -> dict[tuple[str, str], float]:
    """Return the width of a body's line at each of its joints, by the force there."""
    if at.table is None:
        return {}
    sizes = np.linalg.norm(forces_at(at.table, at.k), axis=-1)
    ends = [(body, joint) for _, body, joint in at.skeleton.connections]
    forces = dict(zip(ends, sizes.tolist(), strict=False))
    most = max(forces.values(), default=0.0) or 1.0
    spread = MAX_LINK_WIDTH - MIN_LINK_WIDTH
    return {end: MIN_LINK_WIDTH + spread * force / most for end, force in forces.items()}


def sides(joints: Sequence[str]) -> list[tuple[str, str]]:
    """Return the sides of a body, from joint to joint."""
    return [*pairwise(joints), *([(joints[-1], joints[0])] if len(joints) > 2 else [])]


def bodies(at: Instant, panel: LinkagePanel, points: Points) -> Iterable[str]:
    """Yield the bodies, the farthest first.

    A body with more than two joints is drawn as an area. Each side is as wide as the smaller of the
    forces at its ends.
    """
    skeleton, widths = at.skeleton, _widths(at)
    index = {name: j for j, name in enumerate(skeleton.joints)}
    depth = panel.view.depth(skeleton.position[at.k])
    drawn = sorted(
        zip(skeleton.bodies, skeleton.links, strict=True),
        key=lambda one: float(np.mean([depth[index[name]] for name in one[1]] or [0.0])),
    )
    for body, joints in drawn:
        title = f"><title>{escape(body)}</title></path>"
        if len(joints) > 2:
            path = "L".join(f"{points[name][0]:.1f} {points[name][1]:.1f}" for name in joints)
            yield f'<path class="body" d="M{path}Z"{title}'
        for one, other in sides(joints):
            known = [widths[body, name] for name in (one, other) if (body, name) in widths]
            width = f' stroke-width="{min(known, default=PLAIN_LINK_WIDTH):.1f}"'
            yield line("link", points[one], points[other], width).replace("/>", title)
        if body in skeleton.stems:
            centre = panel.pixels(skeleton.centre[at.k, skeleton.bodies.index(body)])
            stem = f' stroke-width="{widths.get((body, joints[0]), PLAIN_LINK_WIDTH):.1f}"'
            yield line("link", points[joints[0]], centre, stem).replace("/>", title)
            yield f'<circle class="mass" cx="{centre[0]:.1f}" cy="{centre[1]:.1f}" r="4.5"/>'


def line(kind: str, start: Floats, end: Floats, attributes: str = "") -> str:
    """Return a line.

    kind: its class in reports/templates/linkage.css. attributes: further ones of the SVG element.
    """
    (x1, y1), (x2, y2) = start, end
    return f'<path class="{kind}" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"{attributes}/>'


def axes(at: Instant, panel: LinkagePanel, points: Points) -> Iterable[str]:
    """Yield the axis of every joint that is not seen end on, and its pin."""
    for name, axis in zip(at.skeleton.joints, at.skeleton.axes[at.k], strict=True):
        along, here = panel.symbol * panel.direction(axis), points[name]
        if 2.0 * AXIS_REACH * np.linalg.norm(along) >= MIN_AXIS_LENGTH:
            yield line("axis", here - AXIS_REACH * along, here + AXIS_REACH * along)
            yield line("barrel", here - PIN_REACH * along, here + PIN_REACH * along)


def sliders(at: Instant, panel: LinkagePanel) -> Iterable[str]:
    """Yield the lines of sliders."""
    for ends in at.skeleton.slides.values():
        yield line("slide", *panel.pixels(ends[at.k]))


def springs(at: Instant, panel: LinkagePanel) -> Iterable[str]:
    """Yield the zigzags of springs between two points."""
    for name, ends in at.skeleton.springs.items():
        corners = zigzag(panel.pixels(ends[at.k]), panel.symbol * SPRING_HALF_WIDTH)
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in corners)
        yield f'<path class="spring" d="M{path}"><title>{escape(name)}</title></path>'


def pitches(at: Instant, panel: LinkagePanel) -> Iterable[str]:
    """Yield the pitch circles of gears and the lines of racks."""
    for curve in at.skeleton.pitch:
        start, end = panel.pixels(curve.ends[at.k])
        if curve.round:
            size = f'cx="{start[0]:.1f}" cy="{start[1]:.1f}" r="{panel.scale * curve.radius:.1f}"'
            yield f'<circle class="pitch" {size}/>'
        else:
            yield line("pitch", start, end)


def levers(at: Instant, panel: LinkagePanel, points: Points) -> Iterable[str]:
    """Yield a line from every force to the nearest joint of the body on which it acts."""
    skeleton = at.skeleton
    for load in skeleton.forces:
        if (joint := skeleton.lever(load, at.k)) is not None:
            acting = panel.pixels(load.position[min(at.k, len(load.position) - 1)])
            yield line("lever", points[skeleton.joints[joint]], acting)


def support(at: Floats, scale: float = 1.0) -> str:
    """Return the triangle of a fixed joint."""
    x, y = at
    half, high, over = 11.0 * scale, SUPPORT_HEIGHT * scale, 16.0 * scale
    return (
        f'<path class="ground" d="M{x:.1f} {y:.1f}l-{half:g} {high:g}h{2.0 * half:g}z'
        f'M{x - over:.1f} {y + high:.1f}h{2.0 * over:g}"/>'
    )


def support_foot(at: Floats, scale: float) -> list[Floats]:
    """Return the ends of the line on which a fixed joint stands."""
    return [at + scale * np.array([side, SUPPORT_HEIGHT]) for side in (-16.0, 16.0)]


def load_arrows(at: Instant, panel: LinkagePanel) -> list[LoadArrow]:
    """Return the arrow of each applied force and couple; its length grows with its share of the
    largest force or couple.
    """
    short, long = ARROW_LENGTHS
    arrows = []
    forces = [(load.force, load.sizes, load.position) for load in at.skeleton.applied]
    couples = [(load.couple, load.sizes, load.position) for load in at.skeleton.couples]
    for loads, couple in ((forces, False), (couples, True)):
        known = [
            (vectors, sizes, places, min(at.k, len(sizes) - 1)) for vectors, sizes, places in loads
        ]
        largest = max((float(sizes[k]) for _, sizes, _, k in known), default=0.0)
        for vectors, sizes, places, k in known:
            size = float(sizes[k])
            if size == 0.0:
                continue
            along = panel.direction(vectors[k] / size)
            tip = panel.pixels(places[k]) - panel.symbol * ARROW_CLEARANCE * along
            tail = tip - panel.symbol * (short + (long - short) * size / largest) * along
            near = float(panel.view.depth(vectors[k]))
            end_on = int(np.sign(near)) if np.linalg.norm(along) < END_ON_LENGTH else 0
            arrows.append(LoadArrow(tip, tail, size, end_on, couple))
    return [*arrows, *_rings(at, panel, arrows)]


def _rings(at: Instant, panel: LinkagePanel, arrows: Sequence[LoadArrow]) -> Iterable[LoadArrow]:
    """Yield a ring for each force across the plane of a planar linkage, near its point of action,
    where the ring hides least.
    """
    points = panel.joints(at)
    lines = [[point, point] for point in points.values()]
    lines += [[points[a], points[b]] for joints in at.skeleton.links for a, b in sides(joints)]
    lines += [[arrow.tail, arrow.tip] for arrow in arrows]
    for load in at.skeleton.aside:
        k = min(at.k, len(load.sizes) - 1)
        if size := float(load.sizes[k]):
            place = panel.pixels(load.position[k])
            places, ring = place[None, None], np.full((1, 2), RING_SIZE)
            offsets = label_offsets(places, ring, np.array([lines]), ARROW_CLEARANCE, panel.size)
            centre = place + offsets[0]
            lines.append([centre, centre])
            yield LoadArrow(centre, centre, size, int(np.sign(panel.view.depth(load.force[k]))))


def draw_arrow(arrow: LoadArrow) -> str:
    """Return an arrow as SVG.

    An arrow along the view is a ring with a dot (its tip) or a cross (its tail); a couple has two
    rings.
    """
    if arrow.end_on:
        x, y = arrow.tip
        inside = '<circle class="head" r="2.6"/>' if arrow.end_on > 0 else ""
        cross = "" if arrow.end_on > 0 else '<path class="load end" d="M-5-5L5 5M5-5L-5 5"/>'
        place = f'transform="translate({x:.1f} {y:.1f})"'
        outer = '<circle class="load end" r="11.5"/>' if arrow.couple else ""
        return f'<g {place}>{outer}<circle class="load end" r="7.5"/>{inside}{cross}</g>'
    along = (arrow.tip - arrow.tail) / np.linalg.norm(arrow.tip - arrow.tail)
    across = np.array([-along[1], along[0]])
    neck = arrow.tip - 9.0 * along
    heads = []
    for tip in (arrow.tip, neck + 1.0 * along)[: 1 + arrow.couple]:
        foot = tip - 9.0 * along
        corners = [tip, foot + 6.0 * across, foot - 6.0 * across]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in corners)
        heads.append(f'<path class="head" d="M{path}Z"/>')
    return line("load", arrow.tail, neck) + "".join(heads)


def triad(panel: LinkagePanel, corner: Floats) -> Iterable[str]:
    """Yield the directions of x, y and z as arrows from a corner, pixels (2,)."""
    for name, axis in zip("xyz", np.eye(3), strict=True):
        along = panel.direction(axis)
        yield line("triad", corner, corner + TRIAD_REACH * along)
        x, y = corner + TRIAD_LETTERS * along
        yield f'<text class="letter" x="{x:.1f}" y="{y + 3.5:.1f}">{name}</text>'
