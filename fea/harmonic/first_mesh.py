"""Unit fields of a pin's first mesh under pressures of its rings that come one after the other."""

from __future__ import annotations

from collections.abc import Callable

from fea.core.linear_solver import Solve
from fea.core.pin_loads import UnitLoad
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from pinbase.arrays import Floats
from pinbase.memo import Memo

Key = tuple[object, ...]
# Unit loads, points (P, 2) to read stress at, and ends of pressures, as of HarmonicModel.solve.
UnitFields = tuple[tuple[UnitLoad, ...], Floats, tuple[tuple[float, float], ...]]


class FirstMesh:
    """The first mesh of a pin while contact holds it.

    Patterns of pressures are solved as they come. They are a few hundred, where single rings with
    all their harmonics, of which any pattern could be superposed, are thousands. Fields are read
    once, and belong to these loads alone: what was read together is the same to the last bit only
    where the loads are. Factors of the mesh are kept, since most calls bring few new patterns.
    """

    def __init__(self, memo: Memo | None = None) -> None:
        self._memo = memo or Memo()
        self._fields: dict[Key, MeridianFields] = {}
        self._solvers: dict[Key, dict[int, Solve]] = {}  # by harmonic

    def fields(
        self, make: Callable[[], HarmonicModel], key: Key, request: UnitFields
    ) -> MeridianFields:
        """The unit fields of at least the requested loads; `key` names the mesh, `make` makes it.

        Points and ends are the same in all requests.
        """
        loads, read, ends = request
        known = self._fields.get(key)
        new = loads if known is None else tuple(x for x in loads if x not in known.loads)
        if known is None or new:
            model = self._memo.get(("model", *key), make)
            if known is not None:
                known.derived.clear()  # they are replaced, and what is derived has their size
            fields = model.solve(new, read, ends, self._solvers.setdefault(key, {}))
            known = self._fields[key] = fields if known is None else known.joined(fields)
        return known
