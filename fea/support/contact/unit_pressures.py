"""A pin in its lugs by unit pressures on its rings, which do not depend on loads or gaps.

The flexibilities, and the stress on the first mesh under a pressure on each ring alone, are
computed once for a shape and its elasticity. Other loads, clearances or strengths then need only an
active set on rough cells and a superposition of stress, which take a twentieth of a second. Such
stress has the errors of its single mesh and of its cells. These are nearly the same before and
after a change, so that the stress serves for ratios.
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
    """The first mesh under unit pressures on single rings, whose fields a memo keeps."""

    def fields(
        self, make: Callable[[], HarmonicModel], key: Key, request: UnitFields
    ) -> MeridianFields:
        """The unit fields of the requested loads at the points where stress is read for a maximum.

        make: makes the model of the mesh. key: of the mesh in the memo.
        """
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
    """The model of a pin in its lugs whose flexibilities and unit fields a memo keeps, by the pin's
    shape and the elastic properties.

    together: whether stress is solved only once, for all pressures together, so that no unit fields
    are kept.

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
    """The patterns that consist of a pressure on one ring each, in all harmonics."""
    each = np.eye(len(model.rings))
    return PressureModes(model.pin, model.rings, (each,) * (model.cells.highest + 1))


def _elastic_eye(lug: Lug) -> Lug:
    """The lug with only the properties on which its flexibility depends."""
    bushing = lug.bushing and replace(lug.bushing, material=lug.bushing.material.elastic_part)
    return Lug(
        lug.connection, lug.outer_diameter, lug.material.elastic_part,
        edge_radius=lug.edge_radius, bushing=bushing, range=LugRange(),
    )  # fmt: skip


def _where_read(fields: MeridianFields) -> MeridianFields:
    """The fields at the points of the surface and just beneath the rings, without displacements,
    which take a tenth of the memory.
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
