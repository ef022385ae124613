"""The margin of an eye: the force on it against the force that a clause allows, with the work."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from assess.check import CheckText
from assess.clauses.eye import LoadedEye, PlateEye, place_of
from assess.margin import Margin, strength_key
from assess.situation import Situation
from assess.work import Work, WorkQuantity
from fea.core.material import Material
from pinbase.arrays import Floats

EyeCapacity = Callable[[PlateEye], Work]  # the force that an eye carries, N
MAX_TRANSVERSE_RATIO = 0.05  # transverse part of a force up to which axial clauses are applied
DIMENSION_NAMES = {"width": "outer_diameter", "thickness": "thickness", "pin": "diameter"}


@dataclass(frozen=True)
class Strengths:
    """The strengths of a lug's material that a clause needs, Pa; missing: keys of missing ones."""

    yields: float
    ultimate: float
    missing: tuple[str, ...] = ()


def strengths_of(material: Material) -> Strengths:
    """Return the yield and ultimate strength of a material, zero where missing."""
    both = {"yield": material.yield_strength, "ultimate": material.ultimate_strength}
    missing = tuple(strength_key(material.name, w) for w, x in both.items() if x is None)
    return Strengths(both["yield"] or 0.0, both["ultimate"] or 0.0, missing)


def not_axial(text: CheckText, s: Situation, loaded: LoadedEye) -> Margin | None:
    """Return a margin that states why a clause for axial pull cannot be applied (`lacks_pull`);
    None if it can.
    """
    need = lacks_pull(loaded)
    return text.lacks(s, need) if need else None


def lacks_pull(loaded: LoadedEye) -> str:
    """Return why a clause for axial pull cannot be applied to an eye: a force acts across the
    shank, or the force only pushes. Empty if it can be applied.
    """
    at = f"at lug {loaded.connection}"
    if loaded.transverse.max() > MAX_TRANSVERSE_RATIO * loaded.size.max():
        return (
            f"a force along the shank {at}, where it also acts across (clauses for that: code = "
            '"aircraft")'
        )
    if not loaded.axial.any():
        return f"a pull of the shank {at}, where the force only pushes it"
    return ""


def eye_margin(
    text: CheckText,
    s: Situation,
    loaded: LoadedEye,
    force: Floats,
    capacity: EyeCapacity,
    dimension: str,
) -> Margin:
    """Return the margin of the largest force on an eye.

    force: (T,) N at the instants of the loads. dimension: the dimension of the eye that is changed
    until the eye just passes; a larger dimension must give a larger capacity.
    """
    instant = int(force.argmax())
    largest, factor = float(force[instant]), s.factors.at(text.level)
    allowed, place = capacity(loaded.eye), place_of(s, loaded, instant)

    def utilisation(eye: PlateEye) -> float:
        value = capacity(eye).result.value
        return factor * largest / value if value > 0.0 else math.inf

    passing = loaded.eye.would_pass(dimension, utilisation) if largest > 0.0 else None
    of_size = (
        None if passing is None else WorkQuantity(DIMENSION_NAMES[dimension], passing, "length")
    )
    value, material = allowed.result.value, loaded.lug.name
    return text.margin(s, largest, value, place, material, loaded.basis, (allowed,), of_size)
