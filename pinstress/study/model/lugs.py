"""The lugs in which the pins of a study sit, or may sit."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial

from fea.core.material import Material
from fea.support.lugs.axial import axial_seats
from fea.support.lugs.fit import beyond_foundations, fitted, on_structure
from fea.support.lugs.lug import Bushing, Lug, LugRange, Shank
from fea.support.lugs.thermal import at_temperature
from geometry import ArgumentError, Band, Cut, Hole, Pin, PinLike, body_of_revolution
from geometry.shape.band_cuts import crosses_end
from pinbase.keys import key_part
from pinstress.study.model.pins import material
from pinstress.study.model.temperature import at_case, band_radius, rise_of, temperature_words
from pinstress.study.reading.file import Study
from pinstress.study.schema.iso286 import fit_of
from pinstress.study.schema.lugs import LugRangeTable, LugTable, ShankTable
from pinstress.study.schema.pins import PinTable

EYE_DIAMETER_RATIO = 2.5  # default outer diameter over the diameter of the band
# Distance from the bore's centre to where the link clamps the eye, over the outer diameter
CLAMP_DISTANCE_RATIO = 0.8
# Default length of a shank over the outer diameter: its end is so far from the bore that the way in
# which it is held does not matter.
SHANK_LENGTH_RATIO = 2.0


def lugs(
    study: Study, pin: PinLike, clamps: tuple[str, ...], case: str | None = None
) -> tuple[Lug, ...]:
    """Return the lugs that support a pin; empty if something else holds the pin.

    There is a lug for every connection, and for every surface of the structure that the study
    names.
    case: the case at whose temperature they are; None for the temperature of the study's
    dimensions.

    Raises: InputError for impossible lugs, and for a pin that lugs cannot support.
    """
    table, joints = study.table.pin[pin.name], study.table.analysis.joints
    if joints == "prescribed" or (not table.lug and (joints == "auto" or clamps)):
        return ()
    at = f"pin.{key_part(pin.name)}" + ".lug" * bool(table.lug)
    instead = 'or set analysis.joints = "prescribed"'
    if pin.cuts and (stated := [name for name, lug in table.lug.items() if lug.axial is not None]):
        raise study.error(
            f"pin {pin.name} has cuts, and its forces along the axis act evenly on the bands of "
            "its links: remove axial",
            f"{at}.{key_part(stated[0])}.axial",
            "axial-of-cut-pin",
        )
    pin = _in_contact(study, pin, f"remove its lugs, {instead}")
    if clamps:
        raise study.error(
            f"pin {pin.name} is clamped at {', '.join(clamps)}, and also supported by lugs: "
            f"remove the clamp or the lugs, {instead}",
            at,
            "clamped-in-lugs",
        )
    out = _fitting(study, pin, at, case)
    reason = beyond_foundations(pin, out) or _pressed_in_range(out)
    if joints == "foundation" and reason:
        raise study.error(
            f'pin {pin.name} on foundations: {reason}; use analysis.joints = "contact"',
            at,
            "beyond-foundations",
        )
    return out


def given_lugs(
    study: Study, pin: PinLike, holding: tuple[Lug, ...], case: str | None = None
) -> tuple[Lug, ...]:
    """Return the lugs of a pin that the study gives; checks use them whatever holds the pin.

    holding: the pin's `lugs`, if these hold it. case: as in `lugs`.

    Raises: InputError for impossible lugs.
    """
    given = study.table.pin[pin.name].lug
    profile = pin.profile
    if not given or profile is None:
        return ()
    every = holding or _fitting(
        study, profile, f"pin.{key_part(pin.name)}.lug", case, in_contact=False
    )
    return tuple(lug for lug in every if lug.connection in given)


def _fitting(
    study: Study, pin: Pin, at: str, case: str | None, in_contact: bool = True
) -> tuple[Lug, ...]:
    """Return a lug for every connection, and the lugs of the structure.

    at: their key. case: as in `lugs`. in_contact: as in `fitted`.

    Raises: InputError for impossible lugs.
    """
    table = study.table.pin[pin.name]
    made_of = material(study, table.material)
    out = []
    for connection in _held(pin, table):
        try:
            out.append(_lug(study, pin, connection, _given(table, connection), made_of))
        except ArgumentError as error:
            raise study.error(str(error), f"{at}.{key_part(connection)}", error.code) from None
    check = partial(_require_fit, study, pin, in_contact=in_contact)
    check(out, at)
    if not (rise := rise_of(study, case)):
        return tuple(out)
    hot = at_case(study, pin, out, str(case))
    shown = temperature_words(study, rise)
    at = f"case.{key_part(str(case))}.temperature"
    check(hot, at, f"{at}: pin {pin.name} at {shown}: ")
    return tuple(hot)


def _require_fit(
    study: Study, pin: Pin, lugs: list[Lug], at: str, when: str = "", in_contact: bool = True
) -> None:
    """Raise InputError for lugs that do not fit a pin, including at the ends of their ranges.

    at: the key of the lugs. when: a text before the message. in_contact: as in `fitted`.
    """
    made_of = material(study, study.table.pin[pin.name].material)
    try:
        for tried in (lugs, *_ends_of_clearance(lugs)):
            fitted(on_structure(pin, tried), made_of, tried, in_contact)
        axial_seats(pin, lugs)
    except ArgumentError as error:
        raise study.error(f"{when}{error}", at, error.code) from None


def with_given_lugs(study: Study, pins: Iterable[str]) -> tuple[str, ...]:
    """Return those of the pins for which the study gives lugs."""
    return tuple(name for name in pins if study.table.pin[name].lug)


def known_lugs(study: Study, pin: Pin, rise: float = 0.0) -> tuple[Lug, ...]:
    """Return the lugs of a pin that is known to sit in lugs.

    rise: of the temperature above that of the study's dimensions, K.

    Raises: ArgumentError for impossible lugs.
    """
    table = study.table.pin[pin.name]
    made_of = material(study, table.material)
    names = _held(pin, table)
    cold = (_lug(study, pin, name, _given(table, name), made_of) for name in names)
    return tuple(at_temperature(x, made_of, band_radius(pin, x), rise) for x in cold)


def _held(pin: Pin, table: PinTable) -> tuple[str, ...]:
    """Return the names of a pin's lugs, the structure's last."""
    return *pin.connections, *(name for name in table.lug if name not in pin.connections)


def _given(table: PinTable, connection: str) -> LugTable:
    return table.lug.get(connection, LugTable())


def _in_contact(study: Study, pin: PinLike, instead: str) -> Pin:
    """Return the profile of a pin that lugs can hold.

    instead: the remedy that messages name.

    Raises: InputError for a pin that lugs cannot hold.
    """
    table, joints = study.table.pin[pin.name], study.table.analysis.joints
    at = f"pin.{key_part(pin.name)}" + ".lug" * bool(table.lug)
    if pin.cuts and joints == "foundation":
        raise study.error(
            f"pin {pin.name} has cuts, which a beam on foundations leaves out; use "
            'analysis.joints = "contact"',
            at,
            "not-axisymmetric",
        )
    profile = pin.profile
    if profile is None:
        raise study.error(
            f"pin {pin.name} is from a file that is no profile; lugs require a profile, which may "
            f"have holes, flats, slots and passages: {instead}",
            at,
            "not-axisymmetric",
        )
    for cut, feature in pin.cuts.items():
        for name in dict.fromkeys((*profile.connections, *table.lug)):
            band = profile.band(name)
            if crosses_end(feature, profile, band.z0, band.z1):
                raise study.error(
                    f"pin {pin.name}: {cut} lies at the edge of the lug of {name}, where stress "
                    f"has no bound: {_clear_of(feature, band)}, {instead}",
                    at,
                    f"{feature.what}-at-end",
                )
    return profile


def _clear_of(cut: Cut, band: Band) -> str:
    """Return the remedy that keeps a cut clear of the edges of a lug."""
    low, high = cut.opens
    if isinstance(cut, Hole):
        return "move it"
    if low <= band.z0 and band.z1 <= high:
        return "it goes through the whole lug; end it inside of the lug or leave the lug out of it"
    if high <= band.z1 or band.z0 <= low:
        return "end it inside of the lug, by a tenth of its width, or outside of it"
    return "shorten it"


def _ends_of_clearance(lugs: list[Lug]) -> list[list[Lug]]:
    """Return the lugs at both ends of the ranges of clearance; a lug without a range keeps its
    clearance.
    """
    return [
        [replace(x, clearance=(x.range.clearance or (x.clearance,) * 2)[end]) for x in lugs]
        for end in (0, 1)
    ]


@dataclass(frozen=True)
class AssumedLugs:
    """Lugs in which a pin may sit that the study loads and clamps directly.

    pin: with its clamped segments as bands on which no link bears.
    assumed: whether the study gives no lug.
    why: the reason why there are none.
    """

    pin: Pin | None = None
    lugs: tuple[Lug, ...] = ()
    assumed: bool = True
    why: str = ""


def assumed_lugs(
    study: Study, pin: PinLike, clamps: tuple[str, ...], rise: float = 0.0
) -> AssumedLugs:
    """Return a lug for every connection, and a lug of the structure for every clamped segment.

    Values that the study omits have their defaults.
    rise: of the temperature above that of the study's dimensions, K.
    """
    profile = body_of_revolution(pin)
    if profile is None:
        return AssumedLugs(why="the pin has cuts or is from a file")
    clamped = [pin.surface(name) for name in clamps]
    bare = [name for name in clamped if name not in profile.labels]
    if bare:
        return AssumedLugs(why=f"no lug surrounds its clamp ({', '.join(bare)})")
    table = study.table.pin[pin.name]
    free = _freed(profile, clamped)
    names = dict.fromkeys([*free.connections, *clamped, *table.lug])
    if len(names) < 2:
        return AssumedLugs(why="one band alone does not show how the pin is supported")
    made_of = material(study, table.material)
    try:
        # Without friction, since a beam on foundations gives the range over these lugs.
        cold = (
            replace(_lug(study, profile, name, _given(table, name), made_of), friction=0.0)
            for name in names
        )
        assumed = tuple(
            at_temperature(lug, made_of, profile.band(lug.connection).radius, rise) for lug in cold
        )
    except ArgumentError as error:
        return AssumedLugs(why=str(error))
    return AssumedLugs(free, assumed, not table.lug)


def _freed(pin: Pin, clamped: list[str]) -> Pin:
    """Return the pin with its clamped segments as named segments on which no link bears."""
    segments = zip(pin.segments, pin.labels, strict=True)
    return replace(
        pin,
        segments=tuple(
            replace(s, name=label, connection=None) if label in clamped else s
            for s, label in segments
        ),
    )


def _lug(study: Study, pin: Pin, connection: str, given: LugTable, of_pin: Material) -> Lug:
    band = pin.band(connection)
    outer = given.outer_diameter or EYE_DIAMETER_RATIO * 2.0 * band.radius
    made_of = of_pin if given.material is None else material(study, given.material)
    fit = None if given.fit is None else _fit(connection, given.fit, 2.0 * band.radius)
    low, high = fit or given.range.clearance or (0.0, 0.0)
    middle = 0.0 if fit is None and low <= 0.0 <= high else (low + high) / 2.0
    bushing, pressed = _bushing(study, connection, given, 2.0 * band.radius)
    lug = Lug(
        connection,
        outer,
        made_of,
        middle if given.clearance is None else given.clearance,
        given.edge_radius,
        bushing=bushing,
        range=replace(_range(given.range, fit), interference=pressed),
        shank=None if given.shank is None else _shank(given.shank, outer),
        friction=given.friction,
        axial=(given.axial, given.axial) if isinstance(given.axial, str) else given.axial,
    )
    if given.tilt is not None:
        return replace(lug, tilt=_stiffness(given.tilt))
    held = given.shank is not None and given.shank.length is not None
    return replace(lug, tilt=_bending(lug, band, held))


def _bushing(
    study: Study, connection: str, lug: LugTable, bore: float
) -> tuple[Bushing | None, tuple[float, float] | None]:
    """Return the bushing of a lug and the range of its interference, m.

    bore: diameter of the lug's bore, m.

    Raises: ArgumentError for a range without a bushing, a range that excludes the interference, and
    a fit that may leave the bushing loose.
    """
    given, ends, what = lug.bushing, lug.range.interference, f"lug {connection}"
    if given is None:
        if ends is None:
            return None, None
        raise ArgumentError(
            f"{what}: range.interference is of a bushing; give lug.{key_part(connection)}.bushing, "
            "or a negative clearance where the pin itself is pressed in",
            "no-bushing",
        )
    if given.fit is not None:
        clearance = _fit(f"{connection}: bushing", given.fit, bore + 2.0 * given.thickness)
        if clearance[1] >= 0.0 and ends is None:
            raise ArgumentError(
                f"{what}: bushing: fit {given.fit} may leave it without interference; use a "
                "tighter fit, as H7/s6, or state range.interference",
                "loose-bushing",
            )
        ends = ends or (-clearance[1], -clearance[0])
    middle = 0.0 if ends is None else sum(ends) / 2.0
    pressed = middle if given.interference is None else given.interference
    if ends is not None and not min(ends) <= pressed <= max(ends):
        raise ArgumentError(
            f"{what}: the bushing's interference is not within its range.interference",
            "range-order",
        )
    return Bushing(given.thickness, material(study, given.material), pressed), ends


def _shank(given: ShankTable, outer: float) -> Shank:
    """Return the outline of a lug. outer: the outer diameter, m."""
    return Shank(
        given.shape,
        given.width or outer,
        given.length or SHANK_LENGTH_RATIO * outer,
        given.end or outer / 2.0,
        given.angle,
    )


def _fit(connection: str, classes: str, diameter: float) -> tuple[float, float]:
    """Return the least and the largest clearance (m) of a fit at a diameter (m)."""
    try:
        return fit_of(classes, diameter).clearance
    except ArgumentError as error:
        raise ArgumentError(f"lug {connection}: fit: {error}", error.code) from None


def _range(given: LugRangeTable, fit: tuple[float, float] | None) -> LugRange:
    tilt = None if given.tilt is None else (_stiffness(given.tilt[0]), _stiffness(given.tilt[1]))
    return LugRange(given.clearance or fit, given.stiffness, tilt)


def _stiffness(tilt: str | float) -> float:
    """Return the stiffness, N m/rad, of a tilt in words or as a number."""
    return {"guided": math.inf, "free": 0.0}[tilt] if isinstance(tilt, str) else tilt


def _bending(lug: Lug, band: Band, held: bool) -> float:
    """Return the stiffness, N m/rad, with which a lug on a band bends out of its plane.

    held: whether the shank states where it is held.
    """
    over_width = lug.outline(band.radius).bending if held else CLAMP_DISTANCE_RATIO
    return lug.material.youngs_modulus * band.length**3 / (12.0 * over_width)


def _pressed_in_range(lugs: Iterable[Lug]) -> str:
    """Return, as a reason against a beam on foundations, the first lug whose stated range of
    clearance includes an interference; empty if there is none.
    """
    for lug in lugs:
        if lug.range.clearance is not None and lug.range.clearance[0] < 0.0:
            return (
                f"lug {lug.connection} has an interference within its range, whose stress it does "
                "not include"
            )
    return ""
