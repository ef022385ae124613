"""From a study to pins and their materials."""

from __future__ import annotations

from fea.material import Material
from geometry.pin import GeometryError, Pin, Segment
from pinstress.errors import InputError
from pinstress.study import Study


def material(study: Study, name: str) -> Material:
    """A material of the study."""
    m = study.table.material[name]
    return Material(name, m.youngs_modulus, m.poisson_ratio, m.density, m.yield_strength)


def pin(study: Study, name: str) -> Pin:
    """A pin of the study. Raises: InputError for a shape that cannot be, or an unknown clamp."""
    p = study.table.pin[name]
    segments = tuple(
        Segment(s.length, s.diameter, s.bore, s.name, s.connection, s.fillet) for s in p.profile
    )
    try:
        made = Pin(name, segments, p.fillet)
        for clamp in (
            *p.clamp,
            *(c for k in study.table.case.values() for c in k.clamp.get(name, ())),
        ):
            made.surface(clamp)
    except GeometryError as error:
        raise InputError(f"{study.path}: {error}") from None
    return made
