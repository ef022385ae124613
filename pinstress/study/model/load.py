"""Reading of a study file, with the errors of its mechanism and pins where its content has some."""

from __future__ import annotations

import os
from functools import partial

from pinstress.study.reading import file
from pinstress.study.reading.damage import Damage
from pinstress.study.reading.errors import Errors, InputError
from pinstress.study.reading.file import Study

# Keys of a pin on which its shape does not depend
NOT_OF_SHAPE = {"material", "lug", "balance", "replaceable"}


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read and validate a study file.

    Raises: InputError naming the file, the keys and what would be right; for content that is wrong,
    with the errors of mechanism and pins that do not follow from it.
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
    """Add the errors of the mechanism and the pins that remain of a study.

    damage: what the study lacks.
    """
    from pinstress.study.model.mechanism.linkage import contradictions
    from pinstress.study.model.pins import pin

    if study.table.mechanism is not None:
        _, wrong = contradictions(study, damage)
        if wrong:
            errors.add(study.errors(wrong))
    for name in study.table.pin:
        removed = (place for place in damage.places if place[:2] == ("pin", name))
        if all(len(place) > 2 and place[2] in NOT_OF_SHAPE for place in removed):
            errors.attempt(partial(pin, study, name))
