"""The hardened surfaces of a study's pins."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import groupby

from fea.core.hardened import Hardened
from fea.core.material import Material
from geometry import Pin, PinLike
from pinbase.keys import key_part
from pinstress.study.model.pins import material
from pinstress.study.reading.file import Study
from pinstress.study.schema.materials import HardenedTable

Stretch = tuple[float, float, HardenedTable | None, str]  # first and last z, m; table and its key


def pin_material(study: Study, pin: PinLike) -> Material:
    """Return the material of a pin, with the hardened stretches of its surface.

    Raises: InputError for a case that is as deep as the wall, for a pin that is not a plain body of
    revolution, and if the part that is not hardened has no yield strength, or a range of it.
    """
    name = study.table.pin[pin.name].material
    made_of, key = material(study, name), hardened_key(study, pin.name)
    if key is None:
        return made_of
    if not isinstance(pin, Pin):
        raise study.error(
            f"{key}: pin {pin.name} is not a body of revolution without holes, flats, slots or "
            "passages, whose stress by depth is known; give yield_strength, that of the core to "
            "be safe",
            at=f"pin.{key_part(pin.name)}",
            code="hardened-model",
        )
    hardened, bare = [], False
    for start, end, table, at in _stretches(study, pin):
        if table is None:
            bare = True
            continue
        _require_wall(study, pin, (start, end), table, at)
        hardened.append(Hardened(start, end, table.surface, table.core, table.depth))
    unhardened = study.table.material[name].yield_strength
    if bare and unhardened is None:
        raise study.error(
            f"{key}: the rest of pin {pin.name} has no yield strength; give "
            f"material.{key_part(name)}.yield_strength",
            at=f"pin.{key_part(pin.name)}",
            code="hardened-in-part",
        )
    if bare and made_of.strength_range is not None:
        raise study.error(
            f"material.{key_part(name)}.range.yield_strength: pin {pin.name} is hardened in part, "
            "and a range is of the yield strength of a whole pin; give the lower end as "
            "yield_strength",
            at=f"material.{key_part(name)}.range",
            code="hardened-in-part",
        )
    weakest = min([case.core for case in hardened] + ([unhardened] if bare and unhardened else []))
    return replace(
        made_of, yield_strength=weakest, hardened=tuple(hardened),
        unhardened=unhardened if bare else None,
        strength_range=None,  # the material's range, which applies to no part of the pin
    )  # fmt: skip


def hardened_key(study: Study, pin: str) -> str | None:
    """Return the first key that hardens a pin, or None."""
    table = study.table.pin[pin]
    for i, segment in enumerate(table.profile or (), 1):
        if segment.hardened is not None:
            return f"pin.{key_part(pin)}.profile[{i}].hardened"
    if table.hardened is not None:
        return f"pin.{key_part(pin)}.hardened"
    if study.table.material[table.material].hardened is not None:
        return f"material.{key_part(table.material)}.hardened"
    return None


def require_no_hardened(study: Study, pin: str, what: str) -> None:
    """Raise InputError for a pin with a hardened surface, if a method cannot use two strengths.

    what: the method, as the subject of a sentence.
    """
    if key := hardened_key(study, pin):
        raise study.error(
            f"{key}: {what} takes one yield strength for a pin, and pin {pin} has two; give "
            "yield_strength instead, that of the core to be safe",
            code="hardened-not-known",
        )


def require_strengths(study: Study, pins: Iterable[str]) -> None:
    """Raise InputError for pins without the single yield strength that reliability needs."""
    for name in dict.fromkeys(pins):
        material = study.table.pin[name].material
        require_no_hardened(study, name, "reliability")
        if study.table.material[material].yield_strength is None:
            raise study.error(
                f"material.{key_part(material)}: reliability needs its yield_strength, for the "
                f"factors of pin {name}",
                code="no-strength",
            )


def hardened_reason(key: str) -> str:
    """Return the reason why a method cannot use the two strengths of a pin. key: of its hardened
    table.
    """
    return f"{key} gives it two yield strengths; give yield_strength, that of the core to be safe"


def _stretches(study: Study, pin: Pin) -> list[Stretch]:
    """Return the stretches of a pin from its start to its end; neighbours hardened alike are
    joined.
    """
    table = study.table.pin[pin.name]
    everywhere, key = table.hardened, f"pin.{key_part(pin.name)}.hardened"
    if everywhere is None:
        everywhere, key = study.table.material[table.material].hardened, ""
        key = f"material.{key_part(table.material)}.hardened"
    if table.profile is None:
        return [(0.0, pin.length, everywhere, key)]
    ends = list(zip(pin.stations, pin.stations[1:], strict=False))
    of_each = [
        (*at, segment.hardened or everywhere, f"pin.{key_part(pin.name)}.profile[{i}].hardened"
         if segment.hardened else key)
        for i, (at, segment) in enumerate(zip(ends, table.profile, strict=True), 1)
    ]  # fmt: skip
    groups = [list(same) for _, same in groupby(of_each, key=lambda x: x[2])]
    return [(same[0][0], same[-1][1], *same[0][2:]) for same in groups]


def _require_wall(
    study: Study, pin: Pin, stretch: tuple[float, float], table: HardenedTable, key: str
) -> None:
    """Raise InputError for a case that is as deep as the wall of its stretch."""
    segments = zip(pin.segments, pin.stations, strict=False)
    walls = [min(s.walls) / 2.0 for s, z in segments if stretch[0] <= z < stretch[1]]
    if table.depth < min(walls):
        return
    length = study.system.length
    factor = study.system.factor("length")
    depth, wall = (f"{x / factor:.4g} {length}" for x in (table.depth, min(walls)))
    what = "wall" if any(any(s.bores) for s in pin.segments) else "radius"
    raise study.error(
        f"{key}.depth: the case, {depth} deep, leaves no core in pin {pin.name}, whose {what} is "
        f"{wall}; give a depth less than that, or one yield_strength for a pin hardened through",
        code="out-of-range",
    )
