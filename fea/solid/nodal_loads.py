"""Unit loads on the solid mesh: tractions at the nodes of facets, and consistent nodal forces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Unit, UnitLoad
from fea.core.tractions import Traction, closing_tractions, density_of, traction
from fea.solid.assembly import Discretisation
from fea.solid.boundary import Patch, SurfaceMesh, resultants
from geometry import Band, GeometryError, PinLike
from pinbase.arrays import Floats, Mask

RESULTANT_TOLERANCE = 1e-10  # of the nodal forces: error of their resultant due to round-off
# Largest difference of a band's area in the mesh, of its true area; chosen by judgement.
MAX_CURVED_AREA_LOSS = 0.01  # with curved facets
MAX_STRAIGHT_AREA_LOSS = 0.1  # with plane ones


@dataclass(frozen=True)
class NodalLoads:
    """L unit loads on a mesh, per unit of load.

    traction: (F, K, 3, L) Pa, at the nodes of the boundary's facets.
    forces: (N, 3, L) N, at the nodes.
    """

    traction: Floats
    forces: Floats


def nodal_loads(
    pin: PinLike,
    material: Material,
    space: Discretisation,
    boundary: SurfaceMesh,
    units: tuple[Unit, ...],
) -> NodalLoads:
    """The unit loads on bands of a pin, on any other surface (uniform forces only), and on the
    whole.

    Raises: SolveError when the mesh cannot represent a load, or a body load lacks the density.
    """
    lost = MAX_CURVED_AREA_LOSS if boundary.curved else MAX_STRAIGHT_AREA_LOSS
    t = np.zeros((*boundary.normals.shape, len(units)))
    F = np.zeros((*space.nodes.shape, len(units)))
    for name in dict.fromkeys(load.surface for load, _ in units):
        here = [k for k, (load, _) in enumerate(units) if load.surface == name]
        loads = [units[k] for k in here]
        if loads[0][0].kind == "body":
            F[..., here] = _body_forces(material, space, loads)
            continue
        # Surface by surface: a uniform traction where there is no band, otherwise that of the unit
        # load, corrected to the exact resultants on this mesh.
        patch, band = Patch(space, boundary, name), _band(pin, name)
        if band is not None and pin.revolved and abs(patch.area / band.area - 1.0) > lost:
            raise SolveError(
                f"pin {pin.name}: the area of surface {name} in the mesh is "
                f"{patch.area / band.area:.3f} of its true area; refine the mesh",
                "area-mismatch",
            )
        target = np.stack([_resultant(*unit) for unit in loads], axis=1)
        middle = 0.0 if band is None else band.middle
        if band is None:
            on = np.broadcast_to(target[:3] / patch.area, (*patch.points.shape, len(loads)))
        else:
            rough = [components(traction(pin, load), patch.points, load.n, p) for load, p in loads]
            on = patch.exactly(np.stack(rough, axis=-1), target, middle)
        f = patch.nodal_forces(on)
        _check(pin, name, resultants(space.nodes, f, middle) - target, f, 3 if band is None else 6)
        F[..., here] = f
        for i, k in enumerate(here):
            t[patch.rows, ..., k] = on[..., i]
    return NodalLoads(t, F)


def with_closing_tractions(
    pin: PinLike,
    space: Discretisation,
    boundary: SurfaceMesh,
    loads: NodalLoads,
    pressing: Mask | None = None,
) -> NodalLoads:
    """The loads with closing tractions on all bands, so that the sum has no resultants.

    pressing: (L,) whether each load is closed by pressures; none by default.

    Raises: SolveError when there is no band to carry them.
    """
    patches = {name: Patch(space, boundary, name) for name in pin.connections}
    out = NodalLoads(loads.traction.copy(), loads.forces.copy())
    pressing = np.zeros(loads.forces.shape[2], dtype=bool) if pressing is None else pressing
    for pressure in (False, True):
        here = np.flatnonzero(pressing == pressure)
        if not len(here):
            continue
        unit, F = _closing(pin, space, boundary, patches, pressure)
        has = resultants(space.nodes, F)
        amount = np.zeros((F.shape[2], len(here)))
        for _ in range(2):  # the second pass removes round-off
            left = resultants(space.nodes, loads.forces[..., here] + F @ amount)
            amount -= np.linalg.solve(has, left)
        out.traction[..., here] += unit @ amount
        out.forces[..., here] += F @ amount
    return out


def _closing(
    pin: PinLike,
    space: Discretisation,
    boundary: SurfaceMesh,
    patches: dict[str, Patch],
    pressure: bool,
) -> tuple[Floats, Floats]:
    """The closing tractions (F, K, 3, 6), Pa, and their nodal forces (N, 3, 6), N."""
    fields: list[Floats] = []
    for n, phase in ((1, 0), (1, 1), (0, 0), (0, 1)):
        for everywhere in closing_tractions(pin, n, phase, pressure):
            field = np.zeros(boundary.normals.shape)
            for t in everywhere:
                patch = patches[t.surface]
                field[patch.rows] = components(t, patch.points, n, phase)
            fields.append(field)
    unit = np.stack(fields, axis=-1)
    F = np.zeros((*space.nodes.shape, len(fields)))
    for patch in patches.values():
        F += patch.nodal_forces(unit[patch.rows])
    return unit, F


def components(t: Traction, x: Floats, n: int, phase: int) -> Floats:
    """The components (..., 3) along x, y and z, Pa, of a traction of harmonic n and a phase at
    points x (..., 3), m.
    """
    angle = np.arctan2(x[..., 1], x[..., 0])
    return vectors(t.at(x[..., 2]), n * angle - phase * np.pi / 2.0, angle, -1)


def vectors(amplitude: Floats, psi: Floats, angle: Floats, axis: int) -> Floats:
    """The vectors along x, y and z of a harmonic, from amplitudes along r, theta and z.

    psi: n theta - p pi / 2 of the harmonic, rad.
    angle: theta, rad.
    axis: the axis of the arrays that has the three components.
    """
    radial, round_, along = np.moveaxis(amplitude, axis, 0)
    radial, round_, along = radial * np.cos(psi), round_ * np.sin(psi), along * np.cos(psi)
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([radial * c - round_ * s, radial * s + round_ * c, along], axis=axis)


def _band(pin: PinLike, name: str) -> Band | None:
    try:
        return pin.band(name)
    except GeometryError:
        return None


def _resultant(load: UnitLoad, phase: int) -> Floats:
    """The force and moment (6,) of a unit load about the band's middle."""
    out = np.zeros(6)
    if load.kind in ("force", "pull"):
        out[phase if load.n else 2] = 1.0
    elif load.kind == "pressure" and load.n == 1:
        out[phase] = 1.0
    elif load.kind in ("moment", "tilt") and load.n:
        out[4 - phase] = 1.0 - 2.0 * phase  # about y, and about -x
    elif load.kind in ("moment", "twist"):
        out[5] = 1.0
    return out


def _body_forces(material: Material, space: Discretisation, units: list[Unit]) -> Floats:
    """The nodal forces (N, 3, L), N, of an acceleration of 1 m/s^2 on the whole body."""
    shapes = np.stack([np.asarray(part[0]) for part in space.basis.basis])  # (K, M or 1, Q)
    shapes = np.broadcast_to(shapes, (len(shapes), *space.weights.shape))
    shares = np.einsum("imq,mq->mi", shapes, space.weights)
    mass = density_of(material) * np.bincount(
        space.elements.ravel(), shares.ravel(), minlength=len(space.nodes)
    )
    directions = np.stack([np.eye(3)[p if load.n else 2] for load, p in units], axis=1)
    return np.asarray(mass[:, None, None] * directions)


def relative_resultant(pin: PinLike, resultant: Floats, F: Floats) -> Floats:
    """The forces and moments (6, L) relative to the sum of the magnitudes of nodal force
    components.

    Moments are also divided by the pin's length.
    F: (N, 3, L) N, nodal forces.
    """
    arm = np.repeat([1.0, pin.length], 3)
    return np.asarray(np.abs(resultant) / arm[:, None] / np.abs(F).sum(axis=(0, 1)))


def _check(pin: PinLike, name: str, wrong: Floats, F: Floats, rows: int) -> None:
    """Check that nodal forces have the resultants of their load up to round-off.

    Raises: SolveError.
    """
    if not relative_resultant(pin, wrong, F)[:rows].max() < RESULTANT_TOLERANCE:
        raise SolveError(
            f"pin {pin.name}: the nodal loads on {name} do not sum to its resultant",
            "resultant-mismatch",
        )
