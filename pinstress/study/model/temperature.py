"""The temperature of a case, and its effect on the fits of a pin's lugs."""

from __future__ import annotations

from collections.abc import Iterable

from fea.support.lugs.fit import on_structure
from fea.support.lugs.lug import Lug
from fea.support.lugs.thermal import at_temperature, bushing_opening_rise
from geometry import ArgumentError, Pin
from pinbase.keys import key_part
from pinstress.study.model.pins import material
from pinstress.study.reading.file import Study
from pinstress.study.schema.shown import listed
from pinstress.study.schema.thermal_units import shown_temperature

NOT_MODELLED = (
    "it is the same throughout; gradients, and what it changes of moduli and strengths, are left "
    "out"
)


def rise_of(study: Study, case: str | None) -> float:
    """Return the temperature of a case above that of the study's dimensions, K."""
    given = None if case is None else study.table.case[case].temperature
    return 0.0 if given is None else given - study.table.analysis.reference_temperature


def temperature_words(study: Study, rise: float) -> str:
    """Return as text the temperature that is `rise` (K) above that of the study's dimensions."""
    kelvin = study.table.analysis.reference_temperature + rise
    return shown_temperature(kelvin, study.system.imperial)


def band_radius(pin: Pin, lug: Lug) -> float:
    """Return the radius, m, of the band in a lug of a link or of the structure."""
    return on_structure(pin, [lug]).band(lug.connection).radius


def at_case(study: Study, pin: Pin, lugs: Iterable[Lug], case: str) -> list[Lug]:
    """Return the lugs of a pin at the temperature of a case.

    Raises: InputError for a material without thermal expansion, and for a pressed bushing that
    comes loose at this temperature.
    """
    rise, made_of = rise_of(study, case), material(study, study.table.pin[pin.name].material)
    at, out = f"case.{key_part(case)}.temperature", []
    for lug in lugs:
        try:
            hot = at_temperature(lug, made_of, band_radius(pin, lug), rise)
        except ArgumentError as error:
            raise study.error(
                f"{at}: {error}, on pin {pin.name}: state it, as in thermal_expansion = "
                '"11.7e-6 1/K", or remove the temperature',
                code=error.code,
            ) from None
        _require_bushing(study, pin, hot, case)
        out.append(hot)
    return out


def _require_bushing(study: Study, pin: Pin, lug: Lug, case: str) -> None:
    """Raise InputError for a pressed bushing that is loose in a lug at the temperature of a
    case.
    """
    rise = rise_of(study, case)
    opens, bushing = bushing_opening_rise(lug, rise), lug.bushing
    if opens is None or bushing is None:
        return
    needed, unit = -bushing.outgrown / study.system.factor("length"), study.system.length
    raise study.error(
        f"case.{key_part(case)}.temperature: the bushing in lug {lug.connection} of pin {pin.name} "
        f"is loose at {temperature_words(study, rise)}: its interference is used up at "
        f"{temperature_words(study, opens)}; it needs more than {needed:.3g} {unit}, or a material "
        "whose thermal_expansion is nearer to that of the lug",
        code="loose-bushing",
    )


def temperature_assumption(study: Study) -> tuple[str, ...]:
    """Return a sentence on the temperatures of the cases; empty if no case states one."""
    hot = [name for name, case in study.table.case.items() if case.temperature is not None]
    if not hot:
        return ()
    stated = "reference_temperature" in study.table.analysis.model_fields_set
    shown = (f"{name} ({temperature_words(study, rise_of(study, name))})" for name in hot)
    many = "s" * (len(hot) > 1)
    return (
        f"Dimensions, clearances and interferences are those at {temperature_words(study, 0.0)}"
        f"{'' if stated else ' (assumed)'}; the temperature{many} of case{many} "
        f"{listed(list(shown))} change{'s' * (not many)} fits in lugs alone: {NOT_MODELLED}.",
    )
