"""Cases of stated forces on pins, or of a table of them, and whether these are in equilibrium."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from loads import Layout, Reactions, TableError, given_reactions, read_reactions
from loads.coded import LoadsArgumentError
from pinstress.schema.cases import GivenCase
from pinstress.schema.units import SYSTEMS, to_si
from pinstress.study.errors import InputError
from pinstress.study.file import Study

BALANCED = 1e-3  # of the largest force: what rounded numbers leave
REACTED = 0.1  # of it: more is refused when the pin is solved


def given_case(study: Study, name: str, case: GivenCase) -> Reactions:
    """The forces of a case, in pin axes. Raises: TableError."""
    if case.table is None:
        forces, moments = (
            {c: tuple(values) for c, values in (given or {}).items()}
            for given in (case.forces, case.moments)
        )
        return given_reactions(name, forces, moments)
    known = {c for p in study.table.pin for c in study.connections(p)}
    layout = Layout(case.table_case or name, case.columns, case.labels, case.time_step)
    system = SYSTEMS[case.table_units or study.table.units]

    def unit(written: str, dimension: str) -> float:
        if not written:
            return system.factor(dimension)
        try:
            return to_si(f"1 {written}", dimension, system)
        except LoadsArgumentError as error:
            raise TableError(f"{case.table}: {error}", error.code) from None

    found = read_reactions(study.path_to(case.table), layout, unit, known)
    return replace(found, case=name)


def balance_warnings(study: Study) -> list[str]:
    """For every pin without a support whose given forces leave a resultant that is no round-off."""
    out = []
    for name, case in study.table.case.items():
        if not isinstance(case, GivenCase):
            continue
        try:
            found = given_case(study, name, case)
        except (TableError, InputError):
            continue  # whoever needs the case says what is wrong with it
        for pin, table in study.table.pin.items():
            links = study.connections(pin)
            here = [c for c in links if c in found.connections]
            if len(here) < 2 or study.clamps(pin, name) or set(table.lug) - set(links):
                continue
            forces = np.stack([found.in_pin_axes(c) for c in here], axis=1)
            left = np.linalg.norm(forces.sum(axis=1), axis=1).max()
            largest = np.linalg.norm(forces, axis=2).max()
            if BALANCED * largest < left <= REACTED * largest:
                unit, factor = study.system.force, study.system.factor("force")
                text = (
                    f"case.{name}: the forces on pin {pin} are not quite in equilibrium: "
                    f"{left / factor:.3g} {unit}, {left / largest:.1%} of the largest, are left, "
                    "which its bands share"
                )
                out.append(str(study.error(text)))
    return out
