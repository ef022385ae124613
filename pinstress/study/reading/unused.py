"""Keys of a study that have no effect or contradict another key.

They cause a warning only, as sweeps and other choices may need them.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from loads.landing.requirements import DROP_RULES, required_velocity
from pinbase.errors import NumberInSI
from pinbase.keys import key_part, lug_key
from pinstress.study.schema.landing import DropCase
from pinstress.study.schema.lugs import LugTable
from pinstress.study.schema.tables import StudyTable
from pinstress.study.schema.units import UNIT_SYSTEMS, UnitSystem

VELOCITY_ROUND_OFF = 1e-6  # relative, of a converted velocity or of lift


def unused(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on every key that has no effect or contradicts another; it begins with the
    key.
    """
    lugs = {
        lug_key(name, connection): lug
        for name, pin in table.pin.items()
        for connection, lug in pin.lug.items()
    }
    given = table.lug_defaults or LugTable()
    if table.analysis.joints == "prescribed":
        keys = ["lug_defaults"] if lugs and given.axial is not None else []
        keys += [key for key, lug in lugs.items() if lug.axial not in (None, given.axial)]
        for key in keys:
            yield (
                f'{key}.axial: has no effect with analysis.joints = "prescribed", where forces '
                "along the axis act on the bands of the links; use other joints, or remove it"
            )
    yield from _of_codes(table)
    yield from _of_fillets(table)
    yield from _of_drops(table)
    yield from _of_mechanism(table)
    yield from _of_designs(table)
    for key, lug in lugs.items():
        low, high = lug.range.clearance or (-inf, inf)
        if lug.clearance is not None and not low <= lug.clearance <= high:
            yield (
                f"{key}.clearance: is not within its range.clearance, which is solved besides; "
                "change one of both"
            )
    heated = any(case.temperature is not None for case in table.case.values())
    if "reference_temperature" in table.analysis.model_fields_set and not heated:
        yield (
            "analysis.reference_temperature: has no effect, because no case has a temperature; "
            "give case.NAME.temperature, or remove it"
        )
    if lugs or not table.pin:
        return
    if table.lug_defaults is not None:
        yield (
            "lug_defaults: has no effect, because no pin has a lug: each is clamped, is from a "
            "file, or has lugs = false; give pin.NAME.lug, or remove it"
        )
    for name, case in table.case.items():
        if case.temperature is not None:
            yield (
                f"case.{key_part(name)}.temperature: has no effect, because it changes the fits of "
                "lugs alone, and no pin has a lug; give pin.NAME.lug, or remove it"
            )


def _of_codes(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on every factor that only checks of codes use that are not chosen."""
    codes, given = table.analysis.codes, table.lug_defaults or LugTable()
    factors = ["lug_defaults.factors"] if "factors" in given.model_fields_set else []
    for name, pin in table.pin.items():
        factors += (
            [f"pin.{key_part(name)}.bending_factor"] if pin.bending_factor is not None else []
        )
        factors += [
            lug_key(name, connection, "factors")
            for connection, lug in pin.lug.items()
            if any(value is not None for _, value in lug.factors) and lug.factors != given.factors
        ]
    if "aircraft" not in codes:
        for key in factors:
            yield (
                f'{key}: has no effect, because only checks of the code "aircraft" have it; add '
                "that to analysis.code, or remove it"
            )
    if table.analysis.partial_factors.model_fields_set and not {"general", "civil"} & {*codes}:
        yield (
            "analysis.partial_factors: has no effect, because only checks of EN 1993 have them; "
            'add "civil" to analysis.code, or remove it'
        )
    if "aisc" in table.analysis.model_fields_set and "civil" not in codes:
        yield (
            'analysis.aisc: has no effect, because only checks of the code "civil" have it; add '
            "that to analysis.code, or remove it"
        )
    if table.analysis.design_factor is not None and "lifting" not in codes:
        yield (
            'analysis.design_factor: has no effect, because only checks of the code "lifting" have '
            "it; add that to analysis.code, or state fitting_factor, which multiplies the loads of "
            "all checks"
        )


def _of_fillets(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on every fillet of a segment that has no corner at its far end."""
    for name, pin in table.pin.items():
        segments = pin.profile or []
        for k, segment in enumerate(segments):
            after = segments[k + 1] if k + 1 < len(segments) else None
            both = {*segment.diameters, *(after.diameters if after else ())}
            if segment.fillet and (after is None or len(both) == 1):
                where = "nothing follows it" if after is None else "the next has its diameter"
                yield (
                    f"pin.{key_part(name)}.profile[{k + 1}].fillet: has no effect, because it is "
                    f"at the far end of the segment, where {where}; state it of the segment before "
                    "the corner, or remove it"
                )


def _of_drops(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on every key of a drop without effect, and on every value less severe than
    the drop's rule requires.
    """
    drops = {n: case for n, case in table.case.items() if isinstance(case, DropCase)}
    for name, case in drops.items():
        key = f"case.{key_part(name)}"
        if case.rule is not None:
            yield from _short_of_rule(key, case, case.rule, UNIT_SYSTEMS[table.units])
        if case.wing_loading is not None and case.rule != "23.473":
            yield (
                f'{key}.wing_loading: has no effect, because only the rule "23.473" has it; choose '
                "that, or remove it"
            )
        if case.tyre.at is None and "exponent" in case.tyre.model_fields_set:
            yield (
                f"{key}.tyre.exponent: has no effect on a tyre by a table; give at = [deflection, "
                "force] instead of the table, or remove it"
            )
        wheel = case.wheel
        for of_bending in ("mass", "damping") if wheel and wheel.stiffness is None else ():
            if wheel is not None and of_bending in wheel.model_fields_set:
                yield (
                    f"{key}.wheel.{of_bending}: has no effect, because the leg is rigid fore and "
                    f"aft; give {key}.wheel.stiffness, or remove it"
                )


def _short_of_rule(key: str, case: DropCase, rule: str, system: UnitSystem) -> Iterator[str]:
    """Yield a sentence on a velocity or a lift that a drop's rule does not allow."""
    if rule != "23.473" or case.wing_loading is not None:
        least = required_velocity(rule, case.wing_loading) * (1.0 - VELOCITY_ROUND_OFF)
        if case.velocity is not None and case.velocity < least:
            given, asked = (system.told(NumberInSI(v, "velocity")) for v in (case.velocity, least))
            yield (
                f'{key}.velocity: {given} is less than the {asked} of rule "{rule}"; give that at '
                "least, or remove one of both"
            )
    most = DROP_RULES[rule].lift
    if case.lift is not None and case.lift > most * (1.0 + VELOCITY_ROUND_OFF):
        yield (
            f"{key}.lift: {case.lift:.4g} of the weight is more than the {most:.4g} of rule "
            f'"{rule}"; give that at most, or remove one of both'
        )


def _of_mechanism(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on every spring without a force, or with a reference but no stiffness, and
    on every stop that nothing uses.
    """
    if (mechanism := table.mechanism) is None:
        return
    for kind, springs in (
        ("spring", mechanism.spring),
        ("torsion_spring", mechanism.torsion_spring),
    ):
        for name, spring in springs.items():
            key = f"mechanism.{kind}.{key_part(name)}"
            tables = [v for k in ("force", "couple", "damper") if (v := getattr(spring, k, None))]
            if not any((spring.stiffness, spring.preload, spring.damping, *tables)):
                yield (
                    f"{key}: has no effect without a force; give its stiffness, preload, damping "
                    "or a table, or remove it"
                )
            elif "reference" in spring.model_fields_set and not spring.stiffness:
                yield (
                    f"{key}.reference: has no effect, because the stiffness is 0; give {key}."
                    "stiffness, or remove it"
                )
    used = {name for case in table.case.values() for name in getattr(case, "hold", None) or ()}
    used |= {name for rule in mechanism.sharing for name in rule.parallel or ()}
    for name in mechanism.stop:
        if name not in used:
            yield (
                f"mechanism.stop.{key_part(name)}: has no effect, because no case holds it; name "
                "it in case.NAME.hold, or remove it"
            )


def _of_designs(table: StudyTable) -> Iterator[str]:
    """Yield a sentence on keys that belong to another sample of designs than the chosen one."""
    vary = table.vary
    if vary is None:
        return
    if vary.sample == "grid" and "count" in vary.model_fields_set:
        yield (
            "vary.count: has no effect on a grid, which has all combinations of the steps; choose "
            'another sample, such as sample = "sobol", or remove it'
        )
    for key, parameter in vary.parameters.items():
        if vary.sample != "grid" and parameter.steps is not None:
            yield (
                f"vary.parameters.{key_part(key)}.steps: has no effect, because sample = "
                f'"{vary.sample}" has vary.count designs; choose sample = "grid", or remove it'
            )
