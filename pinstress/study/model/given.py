"""Cases of stated forces on pins, or of a table of them."""

from __future__ import annotations

from dataclasses import replace

from loads import Layout, Reactions, TableError, given_reactions, read_reactions
from pinbase.errors import ArgumentError
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.units import UNIT_SYSTEMS, to_si


def given_forces(study: Study, name: str, case: GivenCase) -> Reactions:
    """Return the forces of a case, in pin axes.

    Raises: TableError.
    """
    if case.table is None:
        forces, moments = (
            {c: tuple(values) for c, values in (given or {}).items()}
            for given in (case.forces, case.moments)
        )
        return given_reactions(name, forces, moments)
    known = {c for p in study.table.pin for c in study.connections(p)}
    layout = Layout(case.table_case or name, case.columns, case.labels, case.time_step)
    system = UNIT_SYSTEMS[case.table_units or study.table.units]

    def unit(written: str, dimension: str) -> float:
        if not written:
            return system.factor(dimension)
        try:
            return to_si(f"1 {written}", dimension, system)
        except ArgumentError as error:
            raise TableError(f"{case.table}: {error}", error.code) from None

    reactions = read_reactions(study.path_to(case.table), layout, unit, known)
    return replace(reactions, case=name)
