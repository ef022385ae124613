"""The sharp inner corners of cuts, where stress is unbounded, found on the mesh of a piece."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from fea.core.zone import Zone
from fea.cut.local_model import LocalModel
from fea.cut.parity import AXIS_NAMES
from fea.singular.williams import antiplane_exponent, plane_exponent
from fea.solid.boundary import MIN_SMOOTH_COSINE
from fea.solid.sharp_edges import turned_edges
from pinbase.arrays import Floats, Ints

# Least change of direction at an inner corner: less belongs to the facets of a curved wall. Chosen
# by judgement.
MIN_CORNER_TURN = math.radians(15.0)
RADIUS_ADVICE = {
    "flat": "a radius of the flat would make it finite",
    "slot": "a radius of the slot would make it finite",
    "hole": "a bottom_radius of the hole would make it finite",
    "passage": "a bottom_radius of the passage would make it finite",
    "recess": "a radius in the file would make it finite",
}


@dataclass(frozen=True)
class InnerCorner:
    """An inner corner as a singularity.

    distance: (P,) distance of points from the corner, over the radius of its zone.
    """

    singularity: Zone
    distance: Floats


def inner_corners(model: LocalModel, x: Floats, distance: float) -> tuple[InnerCorner, ...]:
    """The inner corners of a piece.

    x: (P, 3) m, points of the meshed part of the piece.
    distance: within which stress is not read, of a cut's size (at most the pin's diameter).
    """
    out = []
    for between, (nodes, angle) in sorted(_lines(model).items()):
        points = model.space.nodes[nodes]
        cut = next(filter(None, (model.piece.cut_at(name) for name in between)))
        reach = distance * model.piece.across(model.piece.cuts[cut])
        edge = math.isfinite(angle)
        nu = model.material.poisson_ratio
        at = points[0]
        singularity = Zone(
            r=float(np.hypot(at[0], at[1])),
            z=float(at[2]) + model.piece.origin,
            kind="sharp corner",
            between=between,
            theory=plane_exponent(angle, nu, "free", "free") if edge else None,
            torsion_theory=antiplane_exponent(angle, "free", "free") if edge else 0.0,
            radius=reach,
            advice=RADIUS_ADVICE[cut.split()[0]],
            angle=angle,
        )
        out.append(InnerCorner(singularity, np.asarray(cKDTree(points).query(x)[0]) / reach))
    return tuple(out)


def _lines(model: LocalModel) -> dict[tuple[str, str], tuple[Ints, float]]:
    """The nodes along inner corners and the mean angle, rad, of the material there.

    The keys are the names of the two faces that meet. The angle of a cone's tip is NaN.
    """
    names = np.full(len(model.faces.surface.facets), -1)
    boundaries = list(model.space.mesh.boundaries)
    for k, name in enumerate(boundaries):
        names[model.faces.surface.on(model.space, (name,))] = k
    mirror = np.array([model.faces.mirrored(name) for name in boundaries])
    cut = np.array([model.piece.cut_at(name) is not None for name in boundaries])
    edges = turned_edges(model.space, model.faces.surface)
    first_name, second_name = names[edges.facets]
    on_mirror = mirror[first_name] | mirror[second_name]
    # On a mirror plane only half of the corner is meshed, so its angle counts twice.
    angle = np.where(on_mirror, 2.0 * (np.pi + edges.turn), np.pi + edges.turn)
    sharp = (
        (cut[first_name] | cut[second_name])
        & (angle > np.pi + MIN_CORNER_TURN)
        & ~(mirror[first_name] & mirror[second_name])
    )
    rows_of: dict[tuple[str, str], list[int]] = {}
    for k in np.flatnonzero(sharp).tolist():
        pair = [boundaries[i] for i in (first_name[k], second_name[k]) if not mirror[i]]
        first, *other = sorted(pair)
        rows_of.setdefault(
            (first, other[0] if other and other[0] != first else "itself"), []
        ).append(k)
    out = {
        key: (np.unique(edges.nodes[rows]), float(angle[rows].mean()))
        for key, rows in rows_of.items()
    }
    return out | _tips(model)


def _tips(model: LocalModel) -> dict[tuple[str, str], tuple[Ints, float]]:
    """The nodes at the tips of cones: where normals of one smooth face diverge, away from its
    edges.
    """
    out = {}
    for reading in model.faces.readings:
        if not reading.face.name.endswith(" bottom"):
            continue
        corners = model.faces.surface.corners[reading.face.rows]
        normals = model.faces.surface.normals[reading.face.rows].copy()
        # On a mirror plane the normals of both halves average to one within it.
        for plane in model.piece.mirrors:
            axis = AXIS_NAMES.index(plane)
            normals[np.abs(model.space.nodes[corners][..., axis]) < 1e-12, axis] = 0.0
        where = np.searchsorted(reading.nodes, corners)
        total = np.zeros((len(reading.nodes), 3))
        np.add.at(total, where, normals)
        # The mean of unit normals is shorter than one where they diverge.
        mean = np.linalg.norm(total, axis=1) / np.bincount(where.ravel())
        tip = reading.nodes[mean < MIN_SMOOTH_COSINE]
        if len(tip):
            out[reading.face.name, "itself"] = (tip, math.nan)
    return out
