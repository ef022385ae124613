"""What the solid model says of a pin's cases on one mesh."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.answer import Picture
from fea.envelope import envelope
from fea.look import Inside, Look
from fea.material import Material
from fea.memory import require_memory
from fea.pin_loads import Floats, PinLoads, UnitLoad
from fea.rims import all_round, rim
from fea.sharp_edges import sharp_edges
from fea.solid import SolidModel, UnitFields, acting
from fea.zones import Place, clamp_rims, outside
from geometry import CutPin, Pin, PinLike
from geometry.elements import Element
from geometry.meshing import solid_mesh
from geometry.pin import FACES
from geometry.solid_mesh import MeshSize

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class SolidSolution:
    """Unit fields on one mesh, and which of their points are in each singular place."""

    fields: UnitFields
    places: tuple[Place, ...]
    within: tuple[Mask, ...]

    @property
    def outside(self) -> Mask:
        """Points that are in no singular place."""
        out = np.ones(len(self.fields.points), dtype=bool)
        for mask in self.within:
            out &= ~mask
        return out


def solid_solution(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    places: tuple[Place, ...],
    size: MeshSize,
    distance: float,
    element: Element = "curved",
    memory: float | None = None,
) -> SolidSolution:
    """All unit loads of the cases on a mesh, which is finer at edges of bands and clamps.

    places: of a body of revolution; those of any other are found on its mesh, `distance` (of the
    diameter) wide. memory: as in fea.ladder.Asked. Raises: MeshError, SolveError.
    """
    names = tuple(dict.fromkeys(name for c in cases for name in c.surfaces))
    edges = tuple(z for name in names for z in (pin.band(name).z0, pin.band(name).z1))
    profile = pin.profile if isinstance(pin, CutPin) else pin
    if isinstance(profile, Pin):
        turned = tuple(name for name in clamps if name in (*FACES, *profile.labels))
        edges += tuple(z for _, z in clamp_rims(profile, turned))
    mesh = solid_mesh(pin, size, tuple(dict.fromkeys(edges)), element)
    units = acting(cases) or ((UnitLoad(names[0], "force", 1), 0),)  # of which there is nought
    model = SolidModel(pin, mesh, material, clamps)
    require_memory(pin.name, model.unknowns, memory)
    if isinstance(pin, Pin):
        rims = [all_round(rim(pin, p, p.radius)) for p in places]
        fields = model.solve(units, np.concatenate([np.zeros((0, 3)), *rims]))
        r, z = np.hypot(*fields.points[:, :2].T), fields.points[:, 2]
        return SolidSolution(fields, places, tuple(~outside((p,), r, z) for p in places))
    fields = model.solve(units)
    edge = sharp_edges(fields.space, fields.surface, clamps)
    found = edge.places(fields.points, distance)
    return SolidSolution(fields, tuple(p for p, _ in found), tuple(mask for _, mask in found))


class SolidAnswer:
    """What a solution says of any loads made of its unit loads (fea.answer)."""

    def __init__(self, solution: SolidSolution) -> None:
        self.solution = solution

    def maxima(self, loads: PinLoads) -> Floats:
        """Largest von Mises stress (T,) Pa at every instant outside the places."""
        return envelope(self.solution.fields, loads, self.solution.outside).maxima

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The body at one instant, with its envelope over all."""
        fields = self.solution.fields
        top = envelope(fields, loads)
        c = fields.coefficients(loads)[instant]
        over_all = np.full(len(fields.space.nodes), np.nan)
        over_all[fields.surface.nodes] = top.field
        return Picture(
            points=fields.space.nodes,
            cells=fields.space.elements,
            cell_type="tetra10" if fields.space.quadratic else "tetra",
            displacement=fields.displacement @ c,
            stress=fields.stress @ c,
            envelope=over_all,
        )


def solid_look(
    solution: SolidSolution, earlier: Mapping[str, Look], ratio: float, loads: PinLoads
) -> Look:
    """Maximum outside the places and what is inside; exponents from the growth since the `earlier`
    look at the same case, on a mesh `ratio` times coarser.
    """
    fields, before = solution.fields, earlier.get(loads.case)
    top = envelope(fields, loads, solution.outside, solution.within)
    exponents: list[float | None] = [None] * len(top.inside)
    if before is not None and len(before.places) == len(top.inside):
        exponents = [
            float(np.log(now / then.maximum) / np.log(ratio)) if now > then.maximum > 0.0 else None
            for (now, _), then in zip(top.inside, before.places, strict=True)
        ]
    return Look(
        unknowns=fields.space.unknowns,
        maximum=top.maximum,
        instant=top.instant,
        location=top.location,
        places=tuple(
            Inside(value, value, at, s)
            for (value, at), s in zip(top.inside, exponents, strict=True)
        ),
        scatter=top.scatter,
    )
