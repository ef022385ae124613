"""The text of the `[pin.NAME]` of a study for a body from a CAD file."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from geometry import Bottom, Cut, Flat, GeometryError, Hole, Passage, Pin, Recess, Segment, Slot
from geometry.imported.body_file import BodyFile
from geometry.imported.recognise import NotTurnedError, RecognisedProfile
from geometry.shape.drill import FLAT_TIP_ANGLE
from pinbase.keys import key_part
from pinstress.study.model.imported_pin import plain_vector, require_readable, turned_apart
from pinstress.study.model.pins import METRES_PER_UNIT
from pinstress.study.reading.errors import InputError
from pinstress.study.schema.shown import printable
from pinstress.study.schema.types import usable_name


def imported_text(path: Path, name: str | None, unit: str, material: str) -> str:
    """Return the TOML of the pin in a CAD file.

    name: of the pin, by default the file's.
    unit: of length in the file; the text uses it, too.

    Raises: InputError for a file that cannot be read, has no solid or several, or is not a turned
    part, and for a name that cannot be used.
    """
    name = path.stem if name is None else name
    for what, given in (("--pin", name), ("--material", material)):
        try:
            usable_name(given)
        except ValueError as error:
            raise InputError(f"{what}: {error}", code="unusable-name") from None
    file = BodyFile(name, path, METRES_PER_UNIT[unit], ())
    try:
        with suppress(PermissionError):  # require_readable reports it
            if not path.exists():
                raise GeometryError(f"file {path} does not exist", "no-such-file")
        require_readable(file)
        if file.meshed:
            raise GeometryError(
                f"{path.name} is not a CAD file (STEP, BREP, IGES) whose faces could be recognised",
                "not-cad",
            )
        profile = turned_apart(file)
        if any(isinstance(cut, Recess) for cut in profile.cuts):
            why = "some of its faces belong to no hole, flat, slot or passage"
            raise NotTurnedError(file.name, path.name, why)
        return _text(file, profile, unit, material)
    except NotTurnedError as error:
        raise InputError(
            f"{error}; it can be used as it is: geometry = {json.dumps(path.name)}",
            code=error.code,
        ) from None
    except GeometryError as error:
        raise InputError(str(error), code=error.code) from None


def _text(file: BodyFile, profile: RecognisedProfile, unit: str, material: str) -> str:
    pin, table = profile.pin(file.name), f"pin.{key_part(file.name)}"
    lines = [
        f"# From {printable(json.dumps(file.path.name, ensure_ascii=False))}:",
        f"# the axis is along {plain_vector(profile.along)} of the file, and",
        f"# z = 0 is {profile.start:g} {unit} along it; angles count from "
        f"{plain_vector(profile.x)}.",
        f"[{table}]",
        f"material = {json.dumps(material, ensure_ascii=False)}  # a [material] of the study",
        "profile = [",
        *(f"  {{ {', '.join(_segment(s, file.unit, unit))} }}," for s in pin.segments),
        "]",
        *_listed(pin, file.unit, unit),
    ]
    for cut in profile.cuts:
        lines += ["", f"[[{table}.{cut.what}]]", *_cut(cut, file.unit, unit)]
    return "\n".join(lines) + "\n"


def _segment(s: Segment, one: float, unit: str) -> Iterator[str]:
    yield f"length = {_length(s.length, one, unit)}"
    yield f"diameter = {_lengths(s.diameters, one, unit)}"
    if any(s.bores):
        yield f"bore = {_lengths(s.bores, one, unit)}"
    if s.fillet:
        yield f"fillet = {_length(s.fillet, one, unit)}"
    for key, radii in (("edge_radius", s.edge_radii), ("bore_radius", s.bore_radii)):
        if any(radii):
            yield f"{key} = [{_length(radii[0], one, unit)}, {_length(radii[1], one, unit)}]"


def _listed(pin: Pin, one: float, unit: str) -> Iterator[str]:
    """Yield comments that list the cylinders on which links may bear."""
    yield '# Links bear on cylinders: give the segment connection = "NAME", or split it first.'
    for i, (s, band) in enumerate(zip(pin.segments, pin.bands, strict=True), 1):
        if not s.cone and band.length > pin.tolerance:
            z0, z1 = (_number(z, one) for z in (band.z0, band.z1))
            size = _number(s.diameter, one)
            yield f"#   segment {i}: diameter {size} {unit}, straight from z = {z0} to {z1} {unit}"


def _cut(cut: Cut, one: float, unit: str) -> Iterator[str]:
    """Yield the keys of a cut, except those with default values."""

    def given(**lengths: float | None) -> Iterator[str]:
        for key, si in lengths.items():
            if si:
                yield f"{key} = {_length(si, one, unit)}"

    def ends() -> str:
        return f"z = [{', '.join(_length(z, one, unit) for z in cut.extent)}]"

    if isinstance(cut, Flat):
        yield ends()
        yield from given(distance=cut.distance, radius=cut.radius)
    elif isinstance(cut, Slot):
        yield ends()
        yield from given(width=cut.width, depth=cut.depth, radius=cut.radius)
        if not cut.round_ends:
            yield 'ends = "square"'
    elif isinstance(cut, Hole):
        yield from given(z=cut.z, diameter=cut.diameter, depth=cut.depth, chamfer=cut.chamfer)
        yield from given(mouth_radius=cut.mouth_radius, offset=cut.offset)
        if cut.tilt:
            yield f"tilt = {_angle(cut.tilt)}"
        yield from _bottom(cut.bottom, one, unit)
    elif isinstance(cut, Passage):
        if cut.mouth != "both":
            yield f'end = "{cut.mouth}"'
            yield from given(depth=cut.z1 - cut.z0)
        yield f"offset = {_length(cut.offset, one, unit)}"
        yield from given(diameter=cut.diameter)
        yield from _bottom(cut.bottom, one, unit)
    yield f"angle = {_angle(cut.angle)}"


def _bottom(bottom: Bottom, one: float, unit: str) -> Iterator[str]:
    if bottom.tip < FLAT_TIP_ANGLE:
        yield f"tip_angle = {_angle(bottom.tip)}"
    if bottom.radius:
        yield f"bottom_radius = {_length(bottom.radius, one, unit)}"


def _angle(angle: float) -> str:
    return f'"{round(math.degrees(angle), 6) + 0.0:.10g} deg"'


def _lengths(both: tuple[float, float], one: float, unit: str) -> str:
    a, b = (_length(x, one, unit) for x in both)
    return a if a == b else f"[{a}, {b}]"


def _length(si: float, one: float, unit: str) -> str:
    return f'"{_number(si, one)} {unit}"'


def _number(si: float, one: float) -> str:
    return f"{si / one:.9g}"
