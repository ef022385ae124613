"""The linkage of a study's mechanism."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

import numpy as np

from loads import (
    GROUND,
    Body,
    CodedError,
    Connection,
    Joint,
    Linkage,
    LinkageError,
    Slider,
    Teeth,
    Turn,
)
from loads.motion.mobility import Mobility, mobility, require_determined
from loads.space.linkage import SpaceLinkage
from pinbase.keys import key_part
from pinstress.study.model.mechanism.drawing import Drawing, joints_on, shown_length
from pinstress.study.model.mechanism.drives import mechanism_of, parallel_rules, sharing_rules
from pinstress.study.model.mechanism.fit import Fitting, reach
from pinstress.study.model.mechanism.gears import gears, rack
from pinstress.study.model.mechanism.joint_layout import Point, places
from pinstress.study.model.mechanism.masses import (
    STANDARD_GRAVITY,
    at_rest,
    friction_circle,
    pin_mass,
)
from pinstress.study.model.mechanism.parts import (
    body_anywhere,
    body_of,
    require_on_slider,
    slider_of,
    stop_turn,
    turn_by_any_angle,
    turn_of,
)
from pinstress.study.model.mechanism.space import determined_in_space, space_contradictions
from pinstress.study.reading.damage import Damage
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.drives import RotaryDrive, drive_name
from pinstress.study.schema.mechanism import MechanismTable

A = TypeVar("A")
B = TypeVar("B")


AnyLinkage = Linkage | SpaceLinkage


def any_linkage(study: Study) -> AnyLinkage:
    """Return the linkage of the study's mechanism, in a plane or in space.

    Raises: InputError with all its contradictions.
    """
    drawn, wrong = contradictions(study)
    if drawn is None:
        raise study.errors(wrong)
    return drawn


def linkage(study: Study) -> Linkage:
    """Return the linkage of the study's mechanism, which is in a plane.

    Raises: InputError with all its contradictions, or if it is in space.
    """
    drawn = any_linkage(study)
    if not isinstance(drawn, Linkage):
        text = "mechanism.dimension: this needs a linkage in a plane"
        raise study.error(text, code="wrong-dimension")
    return drawn


def contradictions(
    study: Study, damage: Damage | None = None
) -> tuple[AnyLinkage | None, list[Wrong]]:
    """Return the linkage of the study's mechanism, or None and all its contradictions.

    damage: the parts that the study lacks; contradictions that may follow from them are left out.
    """
    mechanism = mechanism_of(study)
    if isinstance(mechanism, MechanismTable):
        return _in_a_plane(study, mechanism, damage)
    if damage is not None and damage.touches(("mechanism",)):
        return None, []
    return space_contradictions(study)


def _in_a_plane(
    study: Study, mechanism: MechanismTable, damage: Damage | None
) -> tuple[Linkage | None, list[Wrong]]:
    """Return the linkage of a planar mechanism; arguments as in `contradictions`."""
    shown = partial(shown_length, study)
    at, errors = places(mechanism, shown)
    damage = Damage({}) if damage is None else damage
    wrong = [Wrong(str(error), code=error.code) for error in errors if not damage]
    for name in mechanism.joint.keys() - at.keys():
        damage.remove(("mechanism", "joint", name, "at"))
    anywhere = dict.fromkeys(mechanism.joint, (0.0, 0.0))
    drawing = Drawing(mechanism, anywhere | at, shown)
    assembled = _assembled(study, drawing)
    if isinstance(assembled, Linkage) and not errors:
        try:
            return _fitting(study, drawing, assembled).fitted(mechanism.fit_within, shown), []
        except LinkageError as error:
            return None, _wrong(error.each)
    if not isinstance(assembled, Linkage):
        wrong += _wrong([error for error in assembled if _certain(error, mechanism, damage)])
    return None, wrong


def _fitting(study: Study, drawing: Drawing, drawn: Linkage) -> Fitting:
    def draw(at: Mapping[str, Point]) -> Linkage:
        moved = _assembled(study, replace(drawing, at=dict(at)))
        if not isinstance(moved, Linkage):
            raise LinkageError.all(moved)
        return moved

    return Fitting(drawn, reach(drawing.mechanism, drawn), draw)


def _as_drawn(study: Study, mechanism: MechanismTable) -> Fitting:
    """Return a valid mechanism as drawn, ready to be fitted."""
    shown = partial(shown_length, study)
    drawing = Drawing(mechanism, places(mechanism, shown)[0], shown)
    drawn = _assembled(study, drawing)
    assert isinstance(drawn, Linkage)
    return _fitting(study, drawing, drawn)


def fit_note(study: Study) -> tuple[str, ...]:
    """Return a sentence on the joints that are moved to close loops; empty if no joint is moved."""
    mechanism = study.table.mechanism
    if not isinstance(mechanism, MechanismTable) or mechanism.fit_within is None:
        return ()
    return _as_drawn(study, mechanism).note(partial(shown_length, study))


def fit_offer(study: Study, error: CodedError) -> str:
    """Return the amount by which redundant links do not meet, and the fit_within that would let
    them meet, for an error that may be due to that; otherwise an empty text.
    """
    mechanism = study.table.mechanism
    unfit = error.code in ("does-not-close", "statically-indeterminate")
    if not unfit or not isinstance(mechanism, MechanismTable) or mechanism.fit_within is not None:
        return ""
    fitting = _as_drawn(study, mechanism)
    return fitting.offer(partial(shown_length, study), study.system.factor("length"))


# Codes of contradictions of a part that hold whatever else is missing from the mechanism. Those of
# OF_A_BODY hold if the body has at least that many joints, since more would not help.
OF_A_PART = {
    "duplicate-name", "reserved-name", "fixed-and-turning", "friction-floats", "same-body",
    "same-joint", "missing-inertia", "give-one",
}  # fmt: skip
OF_MASSES = {"particle", "missing-inertia", "give-one"}  # masses, which static cases do not need
OF_A_BODY = {"missing-centre": 3, "particle": 2}


def _certain(error: LinkageError, mechanism: MechanismTable, damage: Damage) -> bool:
    """Return whether an error cannot follow from what is missing from the mechanism."""
    part = ("mechanism", *error.at[:2])
    if error.code in OF_MASSES and damage.touches(("case",)) and not _moving(damage.raw):
        return False
    if not damage.touches(("mechanism",)):
        return True
    if error.code == "too-few-connections":
        return part not in damage.places and damage.children(part) in ([], ["at"])
    if damage.touches(part):
        return False
    if error.code in OF_A_BODY and str(error.at[1]) not in damage.names:
        joints = joints_on(mechanism, str(error.at[1]))
        return len(joints) >= OF_A_BODY[error.code] or not damage.touches(("mechanism", "joint"))
    return error.code in OF_A_PART


def _moving(raw: Mapping[str, Any]) -> bool:
    """Return whether a study, as written, has a case in which masses matter."""
    cases = raw.get("case")
    listed = cases.values() if isinstance(cases, dict) else ()
    kinds = {case.get("kind") for case in listed if isinstance(case, dict)}
    return not kinds.isdisjoint({"motion", "instant", "drop", "ground"})


def _wrong(errors: Iterable[LinkageError]) -> list[Wrong]:
    return [
        Wrong(
            f"mechanism: {problem}",
            at=".".join(key_part(str(part)) for part in ("mechanism", *problem.at)),
            code=problem.code,
        )
        for problem in errors
    ]


def determined(study: Study, mechanism: AnyLinkage) -> Mobility:
    """Return the mobility of a mechanism whose drives determine every position.

    Without drives every case may name locks instead, which are checked with the case.

    Raises: InputError if the drives do not, or if a sharing rule applies to no indeterminate force.
    """
    if isinstance(mechanism, SpaceLinkage):
        return determined_in_space(study, mechanism, _held_in_all(study))
    try:
        return mobility(mechanism) if _held_in_all(study) else require_determined(mechanism)
    except LinkageError as error:
        raise study.errors(_wrong(error.each)) from None


def _held_in_all(study: Study) -> bool:
    """Return whether a mechanism has no drives and every case names the locks that hold it."""
    cases = [case for case in study.table.case.values() if not isinstance(case, GivenCase)]
    holds = [getattr(case, "hold", None) is not None for case in cases]
    return not mechanism_of(study).drive and bool(holds) and all(holds)


def _assembled(study: Study, drawing: Drawing) -> Linkage | list[LinkageError]:
    """Return the linkage, or all its contradictions."""
    mechanism = drawing.mechanism
    g = float(np.hypot(*mechanism.gravity)) or STANDARD_GRAVITY
    wrong: list[LinkageError] = []

    def each(
        make: Callable[[A], B], of: Iterable[A], instead: Callable[[A], B] | None = None
    ) -> tuple[B, ...]:
        """Return the parts; `instead` replaces a faulty part, so that other errors are found."""
        parts = []
        for one in of:
            try:
                parts.append(make(one))
            except LinkageError as error:
                wrong.extend(error.each)
                parts += [] if instead is None else [instead(one)]
        return tuple(parts)

    bodies = each(lambda b: body_of(study, drawing, *b), mechanism.body.items(), body_anywhere)
    bodies = tuple(replace(b, welded=mechanism.body[b.name].welded_to) for b in bodies)
    jointless = {error.at[1] for error in wrong if not joints_on(mechanism, str(error.at[1]))}
    each(lambda s: require_on_slider(drawing, *s), mechanism.slider.items())
    sliders = tuple(slider_of(drawing, *s) for s in mechanism.slider.items())
    turning = [d for d in mechanism.drive if isinstance(d, RotaryDrive)]
    turns = each(lambda d: turn_of(study, drawing, d), turning, turn_by_any_angle)
    meshing = each(lambda g: gears(*g, drawing), mechanism.gear.items())
    meshing += each(lambda r: rack(*r, drawing, sliders), mechanism.rack.items())
    all_mesh = len(meshing) == len(mechanism.gear) + len(mechanism.rack)
    try:
        drawn = _linkage(study, drawing, g, bodies, sliders, turns, meshing)
    except LinkageError as error:
        return wrong + [
            e
            for e in error.each
            if (all_mesh or e.code != "unknown-connection")
            and not (e.code == "particle" and e.at[1] in jointless)
        ]
    return wrong or drawn


def _linkage(
    study: Study,
    drawing: Drawing,
    g: float,
    bodies: tuple[Body, ...],
    sliders: tuple[Slider, ...],
    turns: tuple[Turn, ...],
    teeth: tuple[Teeth, ...],
) -> Linkage:
    """Return the linkage of these parts; at rest, bodies need no inertia.

    Raises: LinkageError if they contradict each other.
    """
    mechanism = drawing.mechanism
    make = partial(
        Linkage,
        joints=tuple(
            Joint(
                name,
                drawing.at[name],
                tuple(
                    Connection(c, body, friction_circle(j.friction, j.diameter))
                    for c, body in j.connections.items()
                ),
                j.fixed_in,
                pin_mass(study, name, j.weight, g) if j.fixed_in is None else 0.0,
            )
            for name, j in mechanism.joint.items()
        ),
        sliders=sliders,
        turns=(*turns, *(stop_turn(*item) for item in mechanism.stop.items())),
        driven=tuple(drive_name(d) for d in mechanism.drive),
        gravity=mechanism.gravity,
        sharing=sharing_rules(mechanism.sharing),
        parallel=parallel_rules(mechanism.sharing),
        teeth=teeth,
    )
    try:
        return make(bodies=bodies)
    except LinkageError as error:
        if not at_rest(study):
            raise
        lacking = {e.at[1] for e in error.each if e.code in OF_MASSES}
    return make(
        bodies=tuple(replace(b, inertia=0.0) if b.name in lacking else b for b in bodies),
    )


def ground_joint(linkage: Linkage) -> str:
    """Return the joint about which moments on the ground are taken: the first joint that is
    fixed.
    """
    for joint in linkage.joints:
        if joint.fixed_in == GROUND or any(c.body == GROUND for c in joint.connections):
            return joint.name
    return linkage.joints[0].name
