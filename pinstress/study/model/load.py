"""Reading of a study file, including the errors of its mechanism, its pins and the tables that it
names if its content has errors.
"""

from __future__ import annotations

import os
from functools import partial

from pinstress.study.reading import file
from pinstress.study.reading.damage import Damage
from pinstress.study.reading.errors import Errors, InputError
from pinstress.study.reading.file import Study
from pinstress.study.reading.toml_lines import Place
from pinstress.study.schema.cases import GivenCase

# Keys of a pin that do not affect its shape
NOT_OF_SHAPE = {"material", "clamp", "lug", "balance", "replaceable"}
NOT_OF_LOADS = NOT_OF_SHAPE - {"balance"}  # and do not affect the forces that a case gives


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read and validate a study file.

    Raises: InputError, which names the file, the keys and what would be right. If the content has
    errors, those errors of the mechanism, pins and tables of forces that do not follow from them
    are included.
    """
    try:
        return file.load_study(path)
    except InputError as error:
        if error.remainder is None:
            raise
        errors = Errors(error.remainder.study.path)
        errors.add(error)
        _add_errors(error.remainder.study, error.remainder.damage, errors)
        errors.tell()
        raise


def _add_errors(study: Study, damage: Damage, errors: Errors) -> None:
    """Add the errors of the mechanism, the pins and the given cases in what remains of a study.

    damage: the parts that the study lacks.
    """
    from pinstress.study.model.cases import case_loads
    from pinstress.study.model.mechanism.linkage import contradictions
    from pinstress.study.model.pins import pin

    if study.table.mechanism is not None:
        _, wrong = contradictions(study, damage)
        if wrong:
            errors.add(study.errors(wrong))
    damaged = {place[1:2] for place in _of_pins(damage, NOT_OF_SHAPE)}
    for name in study.table.pin:
        if not damaged & {(), (name,)}:
            errors.attempt(partial(pin, study, name))
    if _of_pins(damage, NOT_OF_LOADS):
        return  # the connections are not all known
    for name, case in study.table.case.items():
        if isinstance(case, GivenCase) and not damage.touches(("case", name)):
            errors.attempt(partial(case_loads, study, name, None))


def _of_pins(damage: Damage, but: set[str]) -> list[Place]:
    """Return the places that were removed from pins, except these keys of a pin."""
    removed = (place for place in damage.places if place[0] == "pin")
    return [place for place in removed if len(place) < 3 or place[2] not in but]
