"""The unit fields of a pin's first mesh under patterns of ring pressures that arise one after
another.
"""

from __future__ import annotations

from collections.abc import Callable

from fea.core.linear_solver import Solve
from fea.core.pin_loads import UnitLoad
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from pinbase.arrays import Floats
from pinbase.memo import Memo

Key = tuple[object, ...]
# Unit loads, additional points (P, 2) and ends of pressures: the arguments of HarmonicModel.solve.
UnitFields = tuple[tuple[UnitLoad, ...], Floats, tuple[tuple[float, float], ...]]


class FirstMesh:
    """The first mesh of a pin on which contact pressures act.

    Patterns of pressure are solved as they arise. There are a few hundred of them, whereas single
    rings with all their harmonics, from which any pattern could be superposed, are thousands.
    Fields are read once and belong to their loads alone: stresses that were read together are the
    same to the last bit only where the loads are the same. The factorisations of the mesh are kept,
    since most calls bring few new patterns.
    """

    def __init__(self, memo: Memo | None = None) -> None:
        self._memo = memo or Memo()
        self._fields: dict[Key, MeridianFields] = {}
        self._solvers: dict[Key, dict[int, Solve]] = {}  # by harmonic

    def fields(
        self, make: Callable[[], HarmonicModel], key: Key, request: UnitFields
    ) -> MeridianFields:
        """The unit fields of at least the requested loads.

        make: makes the model of the mesh.
        key: identifies the mesh.
        request: its points and ends of pressures must be the same in all requests for a mesh.
        """
        loads, read, ends = request
        known = self._fields.get(key)
        new = loads if known is None else tuple(x for x in loads if x not in known.loads)
        if known is None or new:
            model = self._memo.get(("model", *key), make)
            if known is not None:
                known.derived.clear()  # these fields are replaced, and derived data is as large
            fields = model.solve(new, read, ends, self._solvers.setdefault(key, {}))
            known = self._fields[key] = fields if known is None else known.joined(fields)
        return known
