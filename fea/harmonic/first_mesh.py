"""Unit fields of a pin's first mesh under pressures of its rings that come one after the other."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from fea.core.pin_loads import UnitLoad
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel, Moved, superposed
from pinbase.arrays import Floats
from pinbase.memo import Memo

Key = tuple[object, ...]
# Unit loads, points (P, 2) to read stress at, and ends of pressures, as of HarmonicModel.solve.
UnitFields = tuple[tuple[UnitLoad, ...], Floats, tuple[tuple[float, float], ...]]
# Of displacements under all single rings that are kept.
MAX_KEPT_BYTES, FLOAT_BYTES = 250_000_000, 8


class FirstMesh:
    """The first mesh of a pin while contact holds it.

    Displacements under the pressure of each ring alone are solved once, and remembered for other
    loads of the links; fields under patterns of pressures are superposed from them. Where rings and
    harmonics are too many for that, patterns are solved as they are. Fields are read once, and
    belong to these loads alone: what was read together is the same to the last bit only where the
    loads are.
    """

    def __init__(self, memo: Memo | None = None) -> None:
        self._memo = memo or Memo()
        self._moved: dict[Key, list[Moved]] = {}
        self._fields: dict[Key, MeridianFields] = {}

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
            fields = model.read(self._superposed(model, key, new), read, ends)
            known = self._fields[key] = fields if known is None else known.joined(fields)
        return known

    def _superposed(self, model: HarmonicModel, key: Key, loads: tuple[UnitLoad, ...]) -> Moved:
        """The displacements under loads, superposed from those on single surfaces unless these are
        too many to be kept.
        """
        alone = dict.fromkeys(one for load in loads for one in load.single_surface_loads)
        if len(alone) * model.space.unknowns * FLOAT_BYTES > MAX_KEPT_BYTES:
            return model.moved(loads)
        parts = self._moved.setdefault(key, [])
        known = {load for part in parts for load in part.loads}
        new = [load for load in alone if load not in known]
        for n in sorted({load.n for load in new}):
            together = tuple(load for load in new if load.n == n)
            solve = partial(model.moved, together)
            parts.append(self._memo.get(("moved", together, *key), solve))
        return superposed(parts, loads)
