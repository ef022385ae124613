"""The pins of a study and their materials."""

from __future__ import annotations

from collections.abc import Iterator

from fea.core.material import Material
from geometry import Bottom, CutPin, Flat, GeometryError, Hole, Passage, Pin, PinLike, Segment, Slot
from geometry.shape.drill import FLAT_TIP_ANGLE
from geometry.shape.polyline import Bend, Stripe, pin_of_polyline, with_stripes
from loads import on_disk
from pinbase.errors import Place
from pinbase.keys import key_part
from pinstress.study.reading.errors import Wrong
from pinstress.study.reading.file import Study
from pinstress.study.schema.pins import BottomTable, HoleTable, PassageTable, PinTable

MIN_REPORTED_LOSS_OF_VOLUME = 1e-3  # relative to the volume
METRES_PER_UNIT = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}


def material(study: Study, name: str) -> Material:
    """Return a material of the study; the yield strength of a hardened one is that of its core."""
    m = study.table.material[name]
    at_yield = m.yield_strength if m.hardened is None else m.hardened.core
    strengths = at_yield, m.ultimate_strength, m.shear_strength, m.bearing_strength
    elastic = m.youngs_modulus, m.poisson_ratio, m.density
    return Material(
        name,
        *elastic,
        *strengths,
        tuple(m.hardening),
        m.ultimate_strain,
        failure_strain=m.failure_strain,
        thermal_expansion=m.thermal_expansion,
        strength_range=m.range.yield_strength,
    )


def pin(study: Study, name: str) -> PinLike:
    """Return a pin of the study.

    Raises: InputError for an impossible shape, a file without a solid, or an unknown clamp;
    MeshError if a solid cannot be cut or the solid of a file cannot be meshed.
    """
    p = study.table.pin[name]
    try:
        shape = _from_file(study, name, p) if p.geometry is not None else _turned(name, p)
    except GeometryError as error:
        raise study.error(str(error), _key(name, p, error.at), error.code) from None
    unknown: list[Wrong] = []
    for key, clamp in _clamps(study, name):
        try:
            shape.surface(clamp)
        except GeometryError as error:
            unknown.append(Wrong(str(error), at=key, code=error.code))
    if unknown:
        raise study.errors(unknown)
    return shape


def _clamps(study: Study, name: str) -> Iterator[tuple[str, str]]:
    """Yield all clamped surfaces of a pin, each with its key."""
    clamps = {f"pin.{key_part(name)}.clamp": study.table.pin[name].clamp}
    for case, table in study.table.case.items():
        clamps[f"case.{key_part(case)}.clamp.{key_part(name)}"] = table.clamp.get(name, [])
    for key, surfaces in clamps.items():
        for i, surface in enumerate(surfaces, 1):
            yield f"{key}[{i}]", surface


def _key(name: str, p: PinTable, at: Place) -> str:
    """Return the key of the part of a pin that an error of geometry refers to."""
    match at:
        case ("segment", int(i)):
            return (
                f"pin.{key_part(name)}.profile[{i}]"
                if p.profile is not None
                else f"pin.{key_part(name)}.meridian"
            )
        case ("key", str(key)):
            return f"pin.{key_part(name)}.{key}"
        case (str(kind), int(i)):
            return f"pin.{key_part(name)}.{kind}[{i}]"
        case ("band", str(band)):
            return f"pin.{key_part(name)}.band.{key_part(band)}"
    return f"pin.{key_part(name)}" + ".geometry" * (p.geometry is not None)


def shape_notes(pin: PinLike) -> str:
    """Return notes on the source of a pin's shape, and on errors of the shape that no error
    estimate includes; empty if there are none.
    """
    return "; ".join(filter(None, (pin.source, _lost_shape(pin))))


def _lost_shape(pin: PinLike) -> str:
    profile = pin.profile
    if profile is not None and profile.merged:
        return (
            f"diameters or bores that differ by up to {profile.merged / METRES_PER_UNIT['mm']:.2g} "
            "mm, less than a billionth of its smallest diameter, are taken as equal"
        )
    if not pin.meshed:
        return ""
    from geometry.imported.imported_pin import SolidBody

    assert isinstance(pin, SolidBody)
    if pin.cut_off < MIN_REPORTED_LOSS_OF_VOLUME:
        return ""
    return (
        f"the sides of its elements are straight where its surface is curved, which changes its "
        f"volume by about {pin.cut_off:.1%} and is not part of any error estimate: give curved "
        "quadratic elements, finer ones, or a STEP file"
    )


def weight(pin: PinLike, density: float, gravity: float = 9.80665) -> float:
    """Return the weight (N) of a pin for a density in kg/m^3."""
    return density * gravity * pin.volume


def slenderness(pin: PinLike) -> float:
    """Return the length over the largest diameter of a band."""
    return pin.length / (2.0 * max(pin.band(name).radius for name in pin.connections))


def far_ends(pin: PinLike) -> tuple[tuple[float, float], ...]:
    """Return the diameter and bore (m) at the far end of each part that `outline` draws; empty if
    all are cylinders.
    """
    profile = pin.profile
    if profile is None or profile.stepped:
        return ()
    return tuple((s.diameters[1], s.bores[1]) for s in profile.segments)


def outline(pin: PinLike) -> list[tuple[float, float, float, str, str]]:
    """Return the cylinders or cones that draw a pin.

    Each has length, diameter, bore (m), name, and "band" or "plain". A shape from a file is drawn
    by its bands, and the space between them.
    """
    if (profile := pin.profile) is not None:
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
    profile = by_corners(name, p) if p.profile is None else _by_segments(name, p)
    if not (p.hole or p.flat or p.slot or p.passage):
        return profile
    cut = CutPin(
        profile,
        (
            *(_hole(h) for h in p.hole),
            *(Flat(*f.z, f.distance, f.angle, f.radius) for f in p.flat),
            *(Slot(*s.z, s.width, s.depth, s.angle, s.radius, s.ends == "round") for s in p.slot),
            *(_passage(h, profile.length) for h in p.passage),
        ),
    )
    cut.require_whole()
    return cut


def _hole(h: HoleTable) -> Hole:
    mouth = h.chamfer, h.mouth_radius
    return Hole(h.z, h.diameter, h.angle, h.depth, _bottom(h), *mouth, h.offset, h.tilt)


def _passage(h: PassageTable, length: float) -> Passage:
    if h.depth is None:
        return Passage(0.0, length, h.diameter, h.offset, h.angle)
    z = (0.0, h.depth) if h.end == "start" else (length - h.depth, length)
    return Passage(*z, h.diameter, h.offset, h.angle, h.end, _bottom(h))


def _bottom(h: BottomTable) -> Bottom:
    return Bottom(FLAT_TIP_ANGLE if h.tip_angle is None else h.tip_angle, h.bottom_radius)


def _by_segments(name: str, p: PinTable) -> Pin:
    segments = (
        Segment(
            s.length,
            s.diameters[0],
            name=None if s.ear_of else s.name,
            connection=s.name if s.ear_of else s.connection,
            fillet=s.fillet,
            edge_radii=_at_ends(s.edge_radius),
            bore_radii=_at_ends(s.bore_radius),
        ).with_diameters(s.diameters, s.bores)
        for s in p.profile or ()
    )
    return Pin(name, tuple(segments), p.fillet)


def _at_ends(radius: float | tuple[float, float]) -> tuple[float, float]:
    return radius if isinstance(radius, tuple) else (0.0, radius)


def by_corners(name: str, p: PinTable) -> Pin:
    """Return a pin whose outline is given by corners.

    Raises: GeometryError.
    """
    outside, bore = ([Bend(*x) for x in line or ()] for line in (p.meridian, p.bore_meridian))
    stripes = (Stripe(n, *b.z, b.connection) for n, b in p.band.items() if b.z is not None)
    return with_stripes(pin_of_polyline(name, outside, bore), stripes)


def _from_file(study: Study, name: str, p: PinTable) -> PinLike:
    from geometry.imported.body_file import BodyFile
    from geometry.imported.body_file import Place as Band
    from pinstress.study.model.imported_pin import read_body  # imports meshio and scikit-fem

    assert p.geometry is not None
    places = tuple(Band(n, b.z, b.surface, b.connection) for n, b in p.band.items())
    path = on_disk(study.path_to(p.geometry))
    file = BodyFile(name, path, METRES_PER_UNIT[p.geometry_unit], places)
    return read_body(file, (clamp for _, clamp in _clamps(study, name)))
