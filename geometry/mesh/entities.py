"""Curves and faces of gmsh's model: those that bound faces, and points on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pinbase.arrays import Floats

Entity = tuple[int, int]  # dimension and tag


def curves_of(gmsh: Any, faces: Sequence[int]) -> list[int]:
    """Tags of the curves that bound each of the faces, seams included; a curve may be repeated."""
    around = gmsh.model.getBoundary([(2, f) for f in faces], combined=False, oriented=False)
    return [int(curve) for _, curve in around]


def grid_on(gmsh: Any, entity: Entity, fractions: Floats) -> Floats:
    """Parameters (P, 1) of a curve or (P, 2) of a face's surface, at fractions of their ranges."""
    low, high = gmsh.model.getParametrizationBounds(*entity)
    along = (a + fractions * (b - a) for a, b in zip(low, high, strict=True))
    return np.stack(np.meshgrid(*along), axis=-1).reshape(-1, len(low))


def points_at(gmsh: Any, entity: Entity, at: Floats) -> Floats:
    """Points (P, 3) of an entity at parameters (P, 1) or (P, 2)."""
    return np.reshape(gmsh.model.getValue(*entity, at.ravel()), (-1, 3))


def along(gmsh: Any, curve: int, fractions: Floats) -> Floats:
    """Points (P, 3) of a curve at fractions of its range of parameters."""
    return points_at(gmsh, (1, curve), grid_on(gmsh, (1, curve), fractions))
