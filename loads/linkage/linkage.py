"""A planar linkage as data, whose parts are checked for contradictions."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loads.linkage.parts import (
    GROUND,
    Body,
    Connection,
    Gear,
    Joint,
    Parallel,
    Point,
    Sharing,
    Slider,
    Teeth,
    Turn,
)
from pinbase.errors import CodedError, Place

Contradiction = tuple[str, str, Place]  # message, code and place of a LinkageError


class LinkageError(CodedError, ValueError):
    """The linkage as described cannot be analysed; the message says why and what would be right.

    several: the errors that this error combines; empty for a single error.
    """

    several: tuple[LinkageError, ...] = ()

    @classmethod
    def all(cls, errors: Sequence[LinkageError]) -> LinkageError:
        """One error that combines several; it has the code and place of the first."""
        error = LinkageError("; ".join(map(str, errors)), errors[0].code, errors[0].at)
        error.several = tuple(errors)
        return error

    @property
    def each(self) -> tuple[LinkageError, ...]:
        """The errors that this error combines, or this error alone."""
        return self.several or (self,)

    @property
    def codes(self) -> tuple[str, ...]:
        """The codes of the single errors."""
        return tuple(error.code for error in self.each)


@dataclass(frozen=True)
class Linkage:
    """Bodies, joints, sliders and turns in the position in which they are drawn.

    driven: names of the sliders and turns that drives prescribe; a structure has none.
    gravity: acceleration of free fall, world axes, m/s^2.

    Raises: LinkageError where the parts contradict each other.
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    driven: tuple[str, ...]
    sliders: tuple[Slider, ...] = ()
    turns: tuple[Turn, ...] = ()
    gravity: Point = (0.0, 0.0)
    sharing: tuple[Sharing, ...] = ()
    parallel: tuple[Parallel, ...] = ()
    teeth: tuple[Teeth, ...] = ()

    def __post_init__(self) -> None:
        if errors := [LinkageError(*contradiction) for contradiction in _contradictions(self)]:
            raise LinkageError.all(errors)

    @cached_property
    def connections(self) -> tuple[tuple[Joint, Connection], ...]:
        """Every connection with its joint, in the order of the joints."""
        return tuple((j, c) for j in self.joints for c in j.connections)

    @cached_property
    def forces(self) -> tuple[tuple[str, str], ...]:
        """Name and exerting body of every force between bodies: connections, then teeth."""
        teeth = tuple((t.name, t.bodies[0]) for t in self.teeth)
        return tuple((c.name, c.body) for _, c in self.connections) + teeth

    @property
    def rubs(self) -> bool:
        """Whether any slider or connection has friction."""
        return any(s.friction for s in self.sliders) or any(c.friction for _, c in self.connections)

    @cached_property
    def drives(self) -> tuple[Slider | Turn, ...]:
        """The sliders and turns that drives prescribe, in the order of `driven`."""
        known: dict[str, Slider | Turn] = {s.name: s for s in self.sliders}
        known |= {t.name: t for t in self.turns}
        return tuple(known[name] for name in self.driven)

    @cached_property
    def items(self) -> tuple[Body, ...]:
        """Everything with mass: the bodies, then each floating pin as a particle."""
        pins = (Body(_pin_item(j), j.mass, j.at) for j in self.joints if j.fixed_in is None)
        return self.bodies + tuple(pins)

    @cached_property
    def index(self) -> dict[str, int]:
        """Number of each item by its name; the ground comes after the last item."""
        rows = {item.name: i for i, item in enumerate(self.items)}
        return rows | {GROUND: len(rows)}

    @cached_property
    def rigid(self) -> dict[str, tuple[str, ...]]:
        """The bodies (or the ground) in the same weld as each body, itself included, by name."""
        names = [*(b.name for b in self.bodies), GROUND]
        groups: dict[str, tuple[str, ...]] = {name: (name,) for name in names}
        for body in self.bodies:
            if body.welded is not None and body.welded not in groups[body.name]:
                merged = groups[body.name] + groups[body.welded]
                groups |= dict.fromkeys(merged, merged)
        return groups

    def joint(self, name: str) -> Joint:
        """The joint of this name."""
        return self._joints[name]

    @cached_property
    def _joints(self) -> dict[str, Joint]:
        """The joints by name."""
        return {j.name: j for j in self.joints}

    def carrier(self, joint: Joint) -> str:
        """The item of which the pin is a part: a body, the ground, or itself when it floats."""
        return _pin_item(joint) if joint.fixed_in is None else joint.fixed_in

    def joints_on(self, body: str) -> tuple[Joint, ...]:
        """The joints at which a body (or the ground) turns, or whose pin is fixed in it."""
        return self._joints_on.get(body, ())

    @cached_property
    def _joints_on(self) -> dict[str, tuple[Joint, ...]]:
        """The joints by body, in their order."""
        joints: dict[str, tuple[Joint, ...]] = {}
        for joint in self.joints:
            for body in dict.fromkeys((joint.fixed_in, *(c.body for c in joint.connections))):
                if body is not None:
                    joints[body] = (*joints.get(body, ()), joint)
        return joints

    @cached_property
    def length_scale(self) -> float:
        """A typical distance between joints, m, which makes angles comparable to lengths."""
        ends = [p for s in self.sliders for p in (s.start, s.end)]
        at = np.array([j.at for j in self.joints] + ends)
        return float(np.linalg.norm(at - at.mean(axis=0), axis=1).mean()) or 1.0


def _pin_item(joint: Joint) -> str:
    """Name of a floating pin as an item."""
    return f"pin {joint.name}"


def _contradictions(linkage: Linkage) -> Iterator[Contradiction]:
    """All contradictions between the parts of a linkage."""
    if not linkage.joints:
        yield "the linkage has no joints", "no-joints", ()
    bodies = {b.name: b for b in linkage.bodies}
    names = [c.name for j in linkage.joints for c in j.connections]
    names += [t.name for t in linkage.teeth]
    coordinates = [s.name for s in linkage.sliders] + [t.name for t in linkage.turns]
    for kind, kind_names in (
        ("body", [item.name for item in linkage.items]),
        ("joint", [j.name for j in linkage.joints]),
        ("connection or gear" if linkage.teeth else "connection", names),
        ("slider or turn", coordinates),
        ("drive", list(linkage.driven)),
    ):
        for name in sorted({n for n in kind_names if kind_names.count(n) > 1}):
            yield f"{kind} {name!r} is named twice; names must be unique", "duplicate-name", ()
    if GROUND in bodies:
        text = f"body {GROUND!r}: this name is reserved for the fixed frame; rename the body"
        yield text, "reserved-name", ("body", GROUND)
    yield from _joint_contradictions(linkage, bodies)
    yield from _slider_contradictions(linkage, bodies)
    for teeth in linkage.teeth:
        for gear in (side.body for side in teeth.sides if isinstance(side, Gear)):
            if gear in bodies and bodies[gear].inertia is None:
                text = f"body {gear}: a gear turns; give its inertia (0 is allowed)"
                yield text, "missing-inertia", ("body", gear)
    for name in linkage.driven:
        if name not in coordinates:
            text = f"drive {name!r}: there is no slider or turn of this name"
            yield text, "unknown-drive", ("drive", name)
    for share in linkage.sharing:
        for name in share.connections:
            if name not in names:
                text = f"sharing: there is no connection, gear or rack {name!r}"
                yield text, "unknown-connection", ("sharing",)
    for rule in linkage.parallel:
        yield from parallel_contradictions(rule, linkage.parallel, linkage.driven, coordinates)
    yield from _weld_contradictions(linkage, bodies)
    for body in linkage.bodies:
        if body.inertia is None:
            yield from _particle_contradictions(linkage, body)


def parallel_contradictions(
    rule: Parallel, rules: Sequence[Parallel], driven: Sequence[str], known: Collection[str]
) -> Iterator[Contradiction]:
    """Contradictions of a rule for drives in parallel.

    rules: all rules. driven: names of the drives. known: names of all sliders and turns.
    """
    names, at = ", ".join(rule.members), ("sharing",)
    for name in rule.members:
        if name not in known:
            yield f"sharing: there is no slider or turn {name!r}", "unknown-drive", at
        if sum(name in other.members for other in rules) > 1:
            yield f"sharing: {name} is in two rules; keep one", "shared-twice", at
    drives = [name for name in rule.members if name in driven]
    if driven and len(drives) != 1:
        text = f"sharing over {names}: exactly one of them must be driven, not {len(drives)}"
        yield f"{text}; the others follow it", "one-must-drive", at


def _joint_contradictions(linkage: Linkage, bodies: dict[str, Body]) -> Iterator[Contradiction]:
    """Contradictions of joints and their connections. bodies: by name."""
    for joint in linkage.joints:
        at = ("joint", joint.name)
        for c in joint.connections:
            key, what = (*at, "connections", c.name), f"connection {c.name}"
            if c.body not in (GROUND, *bodies):
                yield f"{what}: there is no body {c.body!r}", "unknown-body", key
            if c.body == joint.fixed_in:
                text = f"pin {joint.name} is fixed in {c.body}, so {c.body} cannot also turn on it"
                yield f"{what}: {text}", "fixed-and-turning", key
        what = f"joint {joint.name}"
        if joint.fixed_in not in (None, GROUND, *bodies):
            text = f"{what}: there is no body {joint.fixed_in!r}"
            yield text, "unknown-body", (*at, "fixed_in")
        if joint.fixed_in is None and any(c.friction for c in joint.connections):
            text = f"{what}: friction needs fixed_in, the body that carries the pin"
            yield f"{text}; a floating pin may turn with either", "friction-floats", at
        if joint.fixed_in is None and len(joint.connections) < 2:
            text = f"{what}: a floating pin needs at least two connections"
            yield text, "too-few-connections", at


def _slider_contradictions(linkage: Linkage, bodies: dict[str, Body]) -> Iterator[Contradiction]:
    """Contradictions of sliders and turns. bodies: by name."""
    pairs = [("slider", s.name, (s.base, s.moving)) for s in linkage.sliders]
    pairs += [("drive", t.name, (t.base, t.body)) for t in linkage.turns]
    for kind, name, pair in pairs:
        for body in pair:
            if body not in (GROUND, *bodies):
                yield f"{kind} {name}: there is no body {body!r}", "unknown-body", (kind, name)
        if pair[0] == pair[1]:
            text = f"{kind} {name}: {pair[0]} cannot move relative to itself; name two bodies"
            yield text, "same-body", (kind, name)
    for slider in linkage.sliders:
        if slider.axis == (0.0, 0.0):
            text = "its two points coincide, so they define no direction; give direction = [x, y]"
            yield f"slider {slider.name}: {text}", "no-direction", ("slider", slider.name)


def _weld_contradictions(linkage: Linkage, bodies: dict[str, Body]) -> Iterator[Contradiction]:
    """Contradictions of welded bodies. bodies: by name."""
    for body in linkage.bodies:
        what, key = f"body {body.name}", ("body", body.name, "welded_to")
        if body.welded == body.name:
            yield f"{what}: it cannot be welded to itself; name another body", "same-body", key
        elif body.welded is not None and body.welded not in (GROUND, *bodies):
            yield f"{what}: there is no body {body.welded!r} to weld it to", "unknown-body", key
        for end in () if body.welded is None else (body.name, body.welded):
            if end in bodies and bodies[end].inertia is None:
                text = f"body {end}: it is welded; give its inertia (0 is allowed)"
                yield text, "missing-inertia", ("body", end)


def _particle_contradictions(linkage: Linkage, body: Body) -> Iterator[Contradiction]:
    """Contradictions of a body without inertia that is neither a particle nor slides on ground."""
    slides = [s for s in linkage.sliders if body.name in (s.base, s.moving)]
    if any(GROUND in (s.base, s.moving) for s in slides):
        return
    joined = [j for j in linkage.joints for c in j.connections if c.body == body.name]
    carries = any(j.fixed_in == body.name for j in linkage.joints)
    single_connection = len(joined) == 1 and not slides and not carries
    if not single_connection or not np.allclose(joined[0].at, body.centre, atol=1e-9):
        text = (
            f"body {body.name}: a body without inertia is a particle, which must have exactly one "
            "connection, at its centre; give its inertia, or place its centre at that joint"
        )
        yield text, "particle", ("body", body.name)
    elif turned := [t.name for t in linkage.turns if body.name in (t.base, t.body)]:
        text = f"body {body.name}: {turned[0]} acts on its angle; give its inertia (0 is allowed)"
        yield text, "missing-inertia", ("body", body.name)
