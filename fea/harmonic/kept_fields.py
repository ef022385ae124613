"""Unit fields of a pin's meshes that are kept for loads, or designs, that come later."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from fea.core.pin_loads import UnitLoad
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from pinbase.arrays import Floats

Key = tuple[object, ...]
# Unit loads, points (P, 2) to read stress at, and ends of pressures, as of HarmonicModel.solve.
UnitFields = tuple[tuple[UnitLoad, ...], Floats, tuple[tuple[float, float], ...]]


class FirstMesh:
    """What is solved on the first mesh of a pin, so that loads that come later are solved on it
    alone.
    """

    def __init__(self) -> None:
        self._models: dict[tuple[object, ...], HarmonicModel] = {}

    def model(self, make: Callable[[], HarmonicModel], *key: object) -> HarmonicModel:
        """The one that was made before of the same, otherwise a new one."""
        if key not in self._models:
            self._models[key] = make()
        return self._models[key]

    def fields(
        self, level: int, make: Callable[[], HarmonicModel], key: Key, asked: UnitFields
    ) -> MeridianFields:
        """What is asked of the model of a mesh, which `key` names and `make` makes."""
        if level:
            return make().solve(*asked)
        return self.model(make, *key).solve_more(*asked)


class EveryMesh(FirstMesh):
    """Unit fields of all meshes that were solved last, of any pins, so that other amounts of the
    same unit loads are superposed only. most: bytes that are kept, meshes included.
    """

    def __init__(self, most: int = 10**8) -> None:
        super().__init__()
        self._most, self._bytes = most, 0
        self._fields: OrderedDict[Key, tuple[MeridianFields, int]] = OrderedDict()
        self.solved = 0  # meshes

    def fields(
        self, level: int, make: Callable[[], HarmonicModel], key: Key, asked: UnitFields
    ) -> MeridianFields:
        """As that of FirstMesh; what was kept is what would be found anew, to the last bit."""
        loads, read, ends = asked
        whole = (*key, loads, read.tobytes(), ends)
        found = self._fields.pop(whole, None)
        if found is None:
            fields = make().solve(*asked)
            self.solved += 1
            found = fields, _size(fields)
            self._bytes += found[1]
        self._fields[whole] = found
        while self._bytes > self._most and len(self._fields) > 1:
            self._bytes -= self._fields.popitem(last=False)[1][1]
        return found[0]


def _size(fields: MeridianFields) -> int:
    """Bytes of the arrays, roughly."""
    of, forces, mesh = fields, fields.forces, fields.mesh
    parts: list[Any] = [of.points, of.stress, of.displacement, of.triangles, of.unread]
    if forces is not None:
        parts += [forces.data, forces.indices, forces.indptr]
    if mesh is not None:
        parts += [mesh.nodes, mesh.elements, mesh.axis, *mesh.edges.values()]
    return sum(part.nbytes for part in parts)
