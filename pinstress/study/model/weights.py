"""Warnings about stated weights of floating pins that differ from those of their shapes, and about
stated weights in a gravity that is not the earth's.
"""

from __future__ import annotations

import math

from pinbase.keys import key_part
from pinstress.study.model.mechanism.masses import STANDARD_GRAVITY
from pinstress.study.model.pins import pin, weight
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study

STATED_WEIGHT_TOLERANCE = 0.02  # relative to the weight of the pin's shape
GRAVITY_TOLERANCE = 0.02  # relative to standard gravity


def weight_warnings(study: Study) -> list[str]:
    """Return a warning for every joint whose stated weight differs from that of its pin's shape or
    is not used, and a warning if weights are stated in another gravity than the earth's.

    A warning on a difference gives both weights, and states which one is used.
    """
    mechanism = study.table.mechanism
    if mechanism is None:
        return []
    gravity = math.hypot(*mechanism.gravity) or STANDARD_GRAVITY
    warnings = []
    weighed = (one.weight for of in (mechanism.body, mechanism.joint) for one in of.values())
    share = gravity / STANDARD_GRAVITY
    if abs(share - 1.0) > GRAVITY_TOLERANCE and any(weight is not None for weight in weighed):
        said = (
            f"it is {share:.3g} times the standard one, and a stated weight is the one in this "
            "gravity, so it does not change with it; for a load factor state mass instead of weight"
        )
        warnings.append(str(study.error(f"mechanism.gravity: {said}")))
    for name, joint in mechanism.joint.items():
        if joint.weight is not None:
            said = _idle(name, joint.fixed_in) or _differs(study, name, joint.weight, gravity)
            warnings += (
                [str(study.error(f"mechanism.joint.{key_part(name)}.weight: {said}"))]
                if said
                else []
            )
    return warnings


def _idle(name: str, fixed_in: str | None) -> str:
    if fixed_in is None:
        return ""
    return (
        f"pin {name} is fixed in {fixed_in}, whose weight includes it, so this weight is not "
        "used; remove it"
    )


def _differs(study: Study, name: str, stated: float, gravity: float) -> str:
    if name not in study.table.pin:
        return ""
    density = study.material_of(name).density
    if not density:
        return ""
    try:
        computed = weight(pin(study, name), density, gravity)
    except InputError:
        return ""  # the error is reported where the pin is used
    if abs(stated - computed) <= STATED_WEIGHT_TOLERANCE * computed:
        return ""
    unit, factor = study.system.force, study.system.factor("force")
    return (
        f"{stated / factor:.4g} {unit} is stated, but the pin's shape and density give "
        f"{computed / factor:.4g} {unit}; the stated weight is used. Remove it to use the weight "
        "of the shape, or correct the shape or the density"
    )
