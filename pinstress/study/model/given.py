"""Cases that state the forces on pins, or a table of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from loads import Reactions, TableError, given_reactions, tabled_reactions
from pinbase.errors import ArgumentError
from pinbase.keys import key_part
from pinstress.study.reading.case_tables import layout_of
from pinstress.study.reading.file import Study
from pinstress.study.reading.references import closed_message
from pinstress.study.schema.cases import GivenCase
from pinstress.study.schema.force_tables import unit_factor
from pinstress.study.schema.units import UNIT_SYSTEMS


def given_forces(study: Study, name: str, case: GivenCase) -> Reactions:
    """Return the forces of a case in pin axes, with those of the links that balance the others on
    their pin.

    Raises: TableError.
    """
    return _closed(study, name, _stated(study, name, case))


def _closed(study: Study, name: str, stated: Reactions) -> Reactions:
    """Return the reactions with those of the links that balance the others on their pin."""
    for pin, table in study.table.pin.items():
        others = [c for c in study.connections(pin) if c in stated.connections]
        if table.balance is None or not others:
            continue
        if table.balance in others:
            raise TableError(
                closed_message(f"case.{key_part(name)}: connection {table.balance}", pin),
                "balances-the-others",
            )
        columns = [stated.connections.index(c) for c in others]
        force = -stated.forces[:, columns].sum(axis=1, keepdims=True)
        torque = np.zeros_like(force)
        torque[:, :, 2] = -stated.moments[:, columns, 2].sum(axis=1, keepdims=True)
        stated = replace(
            stated,
            connections=(*stated.connections, table.balance),
            bodies=(*stated.bodies, ""),
            forces=np.concatenate([stated.forces, force], axis=1),
            moments=np.concatenate([stated.moments, torque], axis=1),
            turn=np.concatenate([stated.turn, np.zeros((len(stated.turn), 1))], axis=1),
        )
    return stated


def _stated(study: Study, name: str, case: GivenCase) -> Reactions:
    if case.table is None:
        forces, moments = (
            {c: tuple(values) for c, values in (given or {}).items()}
            for given in (case.forces, case.moments)
        )
        return given_reactions(name, forces, moments)
    known = {c for p in study.table.pin for c in study.connections(p)}
    system = UNIT_SYSTEMS[case.table_units or study.table.units]

    def unit(written: str, dimension: str) -> float:
        if not written:
            return system.factor(dimension)
        try:
            return unit_factor(written, dimension)
        except ArgumentError as error:
            raise TableError(str(error), error.code) from None

    return tabled_reactions(
        name,
        [
            (study.path_to(table.file), layout_of(case, table, case.table_case or name))
            for table in case.tables
        ],
        unit,
        known,
    )
