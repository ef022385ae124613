"""Derivatives of the stress of a pin in contact by its dimensions, for the least weight."""

from __future__ import annotations

import numpy as np

from fea.core.places import Place
from fea.support.support import Solution
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats
from pinbase.keys import key_part
from pinstress.analysis.remedies.joint_parameters import joint_parameters
from pinstress.analysis.remedies.sensitivities import differentiated_in_lugs
from pinstress.explore.size.scaled_study import hole_in_eye
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study

BAND_RATE_STEP = 3e-5  # relative step of a dimension to find its effect on a band's diameter


class UndifferentiatedError(Exception):
    """The error that a stress has no derivatives by dimensions, as for a pin with cuts and for some
    pins in contact.
    """


def by_contact(
    before: Study,
    study: Study,
    row: tuple[Task, Solution, Place],
    dimensions: tuple[Dimension, ...],
) -> Floats:
    """Return the relative derivatives (n,) of the largest stress of a place, 1/m.

    before, study: the study as given, and as changed. Eyes that are wider in the changed study,
    because they would have been too narrow, are assumed to grow with the pin.
    row: the task, its solution and the place.

    Raises: UndifferentiatedError.
    """
    task, joined, place = row
    keys, name = [d.key for d in dimensions], task.pin.name
    old, now = (x.table.pin[name].lug for x in (before, study))
    grown = {at for at in now if now[at].outer_diameter != old[at].outer_diameter}
    eyes = {at: f"lug.{key_part(at)}.outer_diameter" for at in grown}
    wanted = {*keys, *eyes.values()}
    lengths = [x.of_joint for x in joint_parameters(study, task) if x.of_joint.key in wanted]
    derivatives = differentiated_in_lugs(joined, task, lengths, alone=True, place=place)
    if derivatives is None:
        raise UndifferentiatedError
    by = derivatives.by_parameter
    slopes = np.array([by.get(key, 0.0) for key in keys])
    for at, key in eyes.items():
        ratio = (now[at].outer_diameter or 0.0) / hole_in_eye(study, name, at)
        slopes += by.get(key, 0.0) * ratio * _band_rates(task, dimensions, at)
    return slopes / derivatives.maximum


def _band_rates(task: Task, dimensions: tuple[Dimension, ...], connection: str) -> Floats:
    """Return the derivatives (n,) of the diameter on which a link bears, by the dimensions."""
    now, out = task.pin.band(connection).radius, []
    for d in dimensions:
        less = d.changed(d.value * (1.0 - BAND_RATE_STEP)).band(connection).radius
        out.append(2.0 * (now - less) / (d.value * BAND_RATE_STEP))
    return np.array(out)
