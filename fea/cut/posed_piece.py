"""A piece about a pin's cuts to be solved, unless a memo has its fields."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from fea.core.pin_loads import Unit
from fea.core.zone import Zone
from fea.cut.local_fields import LocalFields
from fea.cut.local_model import LocalModel
from fea.cut.local_solution import LocalMesh, local_fields, section_points
from fea.harmonic.fields import MeridianFields
from pinbase.arrays import Floats
from pinbase.memo import Memo
from pinbase.records import digest


class PosedPiece:
    """A piece to be solved on one mesh, which is made only where the memo lacks what follows.

    Fields of unit loads serve all loads that lead to this mesh, such as those of other designs.
    """

    def __init__(self, mesh: LocalMesh, memo: Memo) -> None:
        self._mesh, self._memo, self._key = mesh, memo, digest(mesh.content)

    @cached_property
    def _model(self) -> LocalModel:
        return self._mesh.model()

    @property
    def section_points(self) -> Floats:
        """The points (r, z), m, at which the stress of the uncut pin is needed.

        Raises: MeshError.
        """
        key = "section points", self._key
        return self._memo.get(key, lambda: section_points(self._model))

    def fields(
        self,
        uncut: MeridianFields,
        at_points: Floats,
        units: tuple[Unit, ...],
        singularities: Sequence[Zone],
        distance: float,
        weight: Floats,
    ) -> LocalFields:
        """The unit fields of the piece; the arguments are those of local_fields.

        Raises: MeshError, SolveError.
        """
        solved = uncut.points, uncut.stress, uncut.displacement, uncut.loads, at_points
        content = digest((solved, units, tuple(singularities), distance, weight))

        def make() -> LocalFields:
            return local_fields(
                self._model, uncut, at_points, units, singularities, distance, weight
            )

        return self._memo.get(("local fields", self._key, content), make)
