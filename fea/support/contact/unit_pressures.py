"""A pin in its lugs by the unit pressures of its rings: what loads and gaps do not change.

The flexibilities, and the stress under a pressure of each ring alone, on the first mesh, are found
once for a shape and its elasticity. Contact under other loads, with other clearances or strengths,
then takes an active set on rough cells, and its stress a superposition: a twentieth of a second.
Such stress is as far off as its one mesh and its cells are, alike before a change and after it, so
that it serves for ratios.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fea.core.material import Material
from fea.harmonic.fields import MeridianFields
from fea.harmonic.first_mesh import FirstMesh, Key, UnitFields
from fea.harmonic.model import HarmonicModel
from fea.support.contact.pressure_loads import PressureModes
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.lug import Lug, LugRange
from geometry import Pin
from pinbase.memo import Memo


class UnitMesh(FirstMesh):
    """The first mesh under unit pressures of single rings, whose fields a memo has."""

    def fields(
        self, make: Callable[[], HarmonicModel], key: Key, request: UnitFields
    ) -> MeridianFields:
        """The unit fields of the requested loads, where stress is read for a maximum."""
        return self._memo.get(
            ("unit pressures", request[0], *key), lambda: _where_read(make().solve(*request))
        )


def unit_model(
    pin: Pin,
    material: Material,
    lugs: tuple[Lug, ...],
    cells: Resolution,
    memo: Memo,
    together: bool = False,
) -> ContactModel:
    """The model of a pin in its lugs, whose flexibilities and unit fields a memo has by the pin's
    shape and by what is elastic.

    together: for pressures that are solved together, once.
    Raises: ArgumentError for lugs that do not fit the pin; MeshError, SolveError.
    """
    fitting = fitted(on_structure(pin, lugs), material, lugs)
    steel, eyes = material.elastic_part, tuple(map(_elastic_eye, lugs))

    def make() -> ContactModel:
        return ContactModel(pin, steel, eyes, cells, memo).without_meshes()

    model = memo.get(("unit contact", pin, steel, eyes, cells), make).varied(fitting)
    model.first = None if together else UnitMesh(memo)
    return model


def unit_patterns(model: ContactModel) -> PressureModes:
    """The pressure of each ring alone as a pattern, in all harmonics."""
    each = np.eye(len(model.rings))
    return PressureModes(model.pin, model.rings, (each,) * (model.cells.highest + 1))


def _elastic_eye(lug: Lug) -> Lug:
    """A lug by what its flexibility depends on alone."""
    bushing = lug.bushing and replace(lug.bushing, material=lug.bushing.material.elastic_part)
    return Lug(
        lug.connection, lug.outer_diameter, lug.material.elastic_part,
        edge_radius=lug.edge_radius, bushing=bushing, range=LugRange(),
    )  # fmt: skip


def _where_read(fields: MeridianFields) -> MeridianFields:
    """The fields on the surface and just beneath the rings, without displacements: a tenth of
    their memory.
    """
    points = np.r_[: fields.skin, len(fields.displacement) : len(fields.points)]
    return replace(
        fields,
        points=fields.points[points],
        stress=fields.stress[points],
        displacement=np.zeros((0, 3, len(fields.loads))),
        triangles=np.zeros((0, 3), dtype=np.int64),
        unread=np.flatnonzero(np.isin(points, fields.unread)),
        forces=None,
        mesh=None,
    )
