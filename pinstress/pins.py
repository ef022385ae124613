"""From a study to pins and their materials."""

from __future__ import annotations

import re
from collections.abc import Iterator

from fea.material import Material
from geometry import CutPin, Flat, GeometryError, Hole, Pin, PinLike, Segment
from pinstress.schema_pins import PinTable
from pinstress.study import Study

TELL = 1e-3  # of the volume
METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}


def material(study: Study, name: str) -> Material:
    """A material of the study."""
    m = study.table.material[name]
    return Material(name, m.youngs_modulus, m.poisson_ratio, m.density, m.yield_strength)


def pin(study: Study, name: str) -> PinLike:
    """A pin of the study.

    Raises: InputError for a shape that cannot be, a file that holds none, or an unknown clamp;
    MeshError when a file's solid cannot be meshed.
    """
    p = study.table.pin[name]
    try:
        made = _from_file(study, name, p) if p.geometry is not None else _turned(name, p)
    except GeometryError as error:
        raise study.error(str(error), at=_key(name, str(error))) from None
    unknown: dict[str, str] = {}
    for key, clamp in _held(study, name):
        try:
            made.surface(clamp)
        except GeometryError as error:
            unknown[key] = str(error)
    if unknown:
        raise study.errors(list(unknown.values()), list(unknown))
    return made


def _held(study: Study, name: str) -> Iterator[tuple[str, str]]:
    """Everything that holds a pin anywhere, after its key."""
    clamps = {f"pin.{name}.clamp": study.table.pin[name].clamp}
    for case, table in study.table.case.items():
        clamps[f"case.{case}.clamp.{name}"] = table.clamp.get(name, [])
    for key, surfaces in clamps.items():
        for i, surface in enumerate(surfaces, 1):
            yield f"{key}[{i}]", surface


def _key(name: str, message: str) -> str:
    """The key of what geometry calls "segment 2", "hole 1" or "band foot" of a pin."""
    about = message.removeprefix(f"pin {name}")
    if band := re.match(r": band ([^:]+)", about):
        return f"pin.{name}.band.{band[1]}"
    if part := re.search(r"\b(segment|hole|flat)s? (\d+)", about):
        return f"pin.{name}.{part[1].replace('segment', 'profile')}[{part[2]}]"
    return f"pin.{name}.geometry"


def lost_shape(pin: PinLike) -> str:
    """What no error estimate knows of a mesh from a file, in words; empty where there is nothing
    of it.
    """
    if not pin.meshed:
        return ""
    from geometry.solid_body import SolidBody

    assert isinstance(pin, SolidBody)
    if pin.cut_off < TELL:
        return ""
    return (
        f"the sides of its elements are straight where its surface is round, which changes its "
        f"volume by about {pin.cut_off:.1%}, and no error estimate knows of it: give curved "
        "quadratic elements, finer ones, or a STEP file"
    )


def weight(pin: PinLike, density: float, gravity: float = 9.80665) -> float:
    """Weight (N) for a density in kg/m^3."""
    return density * gravity * pin.volume


def outline(pin: PinLike) -> list[tuple[float, float, float, str, str]]:
    """Cylinders to draw a pin by: length, diameter, bore (m), name, and "band" or "plain"; of a
    shape from a file its bands, and as much as there is between them.
    """
    profile = pin.profile if isinstance(pin, CutPin) else pin
    if isinstance(profile, Pin):
        return [
            (s.length, s.diameter, s.bore, label if s.connection or s.name else "",
             "band" if s.connection else "plain")
            for s, label in zip(profile.segments, profile.labels, strict=True)
        ]  # fmt: skip
    drawn: list[tuple[float, float, float, str, str]] = []
    at, end = pin.ends
    for name in pin.connections:
        band = pin.band(name)
        if band.z0 > at:
            drawn.append((band.z0 - at, 2 * band.radius, 0.0, "", "plain"))
        drawn.append((band.length, 2 * band.radius, 0.0, name, "band"))
        at = band.z1
    if end > at and drawn:
        drawn.append((end - at, drawn[-1][1], 0.0, "", "plain"))
    return drawn


def _turned(name: str, p: PinTable) -> Pin | CutPin:
    segments = tuple(
        Segment(s.length, s.diameter, s.bore, s.name, s.connection, s.fillet)
        for s in p.profile or ()
    )
    profile = Pin(name, segments, p.fillet)
    if not (p.hole or p.flat):
        return profile
    holes = tuple(Hole(h.z, h.diameter, h.angle) for h in p.hole)
    return CutPin(profile, holes, tuple(Flat(*f.z, f.distance, f.angle) for f in p.flat))


def _from_file(study: Study, name: str, p: PinTable) -> PinLike:
    from geometry.body_file import BodyFile, Place
    from pinstress.read_body import read_body  # which needs meshio and scikit-fem

    assert p.geometry is not None
    places = tuple(Place(n, b.z, b.surface, b.connection) for n, b in p.band.items())
    file = BodyFile(name, study.beside(p.geometry), METRES[p.geometry_unit], places)
    return read_body(file)
