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
    """The models of a pin's first mesh, so that later loads are solved there alone."""

    def __init__(self) -> None:
        self._models: dict[tuple[object, ...], HarmonicModel] = {}

    def model(self, make: Callable[[], HarmonicModel], *key: object) -> HarmonicModel:
        """The model made before with the same key, otherwise a new one."""
        if key not in self._models:
            self._models[key] = make()
        return self._models[key]

    def fields(
        self, level: int, make: Callable[[], HarmonicModel], key: Key, request: UnitFields
    ) -> MeridianFields:
        """The requested unit fields of a mesh, which `key` names and `make` makes.

        level: 0 for the first mesh.
        """
        if level:
            return make().solve(*request)
        return self.model(make, *key).solve_more(*request)


class EveryMesh(FirstMesh):
    """Unit fields of all meshes that were solved last, of any pins.

    So other amounts of the same unit loads are only superposed.
    most: bytes that are kept, meshes included.
    """

    def __init__(self, most: int = 10**8) -> None:
        super().__init__()
        self._most, self._bytes = most, 0
        self._fields: OrderedDict[Key, tuple[MeridianFields, int]] = OrderedDict()
        self.solved = 0  # meshes

    def fields(
        self, level: int, make: Callable[[], HarmonicModel], key: Key, request: UnitFields
    ) -> MeridianFields:
        """The requested unit fields; a kept result equals a new one to the last bit."""
        loads, read, ends = request
        whole = (*key, loads, read.tobytes(), ends)
        entry = self._fields.pop(whole, None)
        if entry is None:
            fields = make().solve(*request)
            self.solved += 1
            entry = fields, _size(fields)
            self._bytes += entry[1]
        self._fields[whole] = entry
        while self._bytes > self._most and len(self._fields) > 1:
            self._bytes -= self._fields.popitem(last=False)[1][1]
        return entry[0]


def _size(fields: MeridianFields) -> int:
    """Bytes of the arrays, roughly."""
    of, forces, mesh = fields, fields.forces, fields.mesh
    parts: list[Any] = [of.points, of.stress, of.displacement, of.triangles, of.unread]
    if forces is not None:
        parts += [forces.data, forces.indices, forces.indptr]
    if mesh is not None:
        parts += [mesh.nodes, mesh.elements, mesh.axis, *mesh.edges.values()]
    return sum(part.nbytes for part in parts)
