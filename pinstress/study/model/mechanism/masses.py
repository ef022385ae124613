"""Masses of bodies and of floating pins, and friction circles, in the plane and in space."""

from __future__ import annotations

import math

from loads import LinkageError
from pinstress.study.model.pins import pin
from pinstress.study.reading.damage import NO_CASE
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase, StaticCase
from pinstress.study.schema.mechanism import BodyTable
from pinstress.study.schema.space import SpaceBodyTable

STANDARD_GRAVITY = 9.80665


def friction_circle(friction: float | None, diameter: float | None) -> float:
    """Return the radius of the friction circle of a pin, m.

    friction: coefficient. diameter: m.
    """
    mu = friction or 0.0
    return 0.5 * (diameter or 0.0) * mu / math.hypot(1.0, mu)


def at_rest(study: Study) -> bool:
    """Return whether all cases of a study's mechanism are static, so that inertia does not
    matter.
    """
    cases = [case for case in study.table.case.values() if not isinstance(case, GivenCase)]
    still = all(isinstance(case, StaticCase) and case.ground_motion is None for case in cases)
    return bool(cases) and still and NO_CASE not in study.table.case


def body_mass(study: Study, name: str, body: BodyTable | SpaceBodyTable, gravity: float) -> float:
    """Return the mass of a body without a bar; zero if it is not stated and does not matter.

    gravity: its magnitude, m/s^2; 0 without gravity.

    Raises: LinkageError if the mass is missing but matters.
    """
    if body.mass is not None:
        return body.mass
    if body.weight is not None:
        return body.weight / (gravity or STANDARD_GRAVITY)
    if gravity or not at_rest(study):
        text = f"body {name}: give one of weight, mass or bar"
        raise LinkageError(text, "give-one", ("body", name))
    return 0.0


def pin_mass(study: Study, joint: str, weight: float | None, gravity: float) -> float:
    """Return the mass of a floating pin, kg: as stated, from the shape of the pin of that name, or
    zero.
    """
    if weight is not None:
        return weight / gravity
    if joint not in study.table.pin:
        return 0.0
    density = study.material_of(joint).density
    return density * pin(study, joint).volume if density else 0.0
