"""The stress where a pressure ends on a smooth surface: bounded, but dependent on direction.

Close to such an edge a body is a half-plane with a pressure p on one half of its surface, whose
stress is the same at all distances. With x along the surface away from the pressure, y into the
body and chi the angle from x to y,

    s_xx, s_yy = -p (chi +- sin chi cos chi) / pi        s_xy = -p sin^2 chi / pi

and the largest von Mises stress is often below the edge, at vanishing distance. The elements that
touch the edge are as wrong on the finest mesh as on the first, so they are not read. Instead, since
p is known, its field is subtracted from the stress in elements farther away. The remainder is
smooth and is extrapolated to the edge. There the field is added again, in each direction.

Source: Johnson, Contact Mechanics, 2.5, a strip under pressure whose other end is far away.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fea.core.local_fit import fit_weights
from fea.core.material import Material
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline
from fea.harmonic.surface_stress import in_axes
from pinbase.arrays import Floats, Ints

# Chosen by judgement; tests/fea/harmonic/test_jumps.py compares their effect with exact stresses.
EDGE_DIRECTIONS = 25  # from the surface on one side of the edge to that on the other
UNUSABLE_ELEMENTS = 1.5  # distance from the edge, in elements, within which no stress is used
UNREAD_ELEMENTS = 3.0  # distance, in elements, within which stress is not read
CONTINUATION_SAMPLES = 45  # nearest usable samples, from which the smooth part is extrapolated


@dataclass(frozen=True)
class Jump:
    """The end of a pressure on a smooth outline, and how stress is read there.

    r, z: m.
    before, after: the edges of the outline that meet there.
    normal: (2,) outwards.
    reach: distance, m, within which no other points inside the body are read.
    samples: (S,) numbers, among the 3 M of the mesh, of the samples that are extrapolated; weights:
    (S,) theirs.
    field: (D, 6) the stress that a unit pressure on `before` adds to the extrapolated stress, by
    direction.
    """

    r: float
    z: float
    before: int
    after: int
    normal: Floats
    reach: float
    samples: Ints
    weights: Floats
    field: Floats

    def stress(self, sampled: Floats, traction: Floats) -> Floats:
        """The stress (D, 6, K), Pa, at the jump in all D directions.

        sampled: (3 M, 6, K) Pa, at all samples of the mesh.
        traction: (E, 3, 3, K) Pa, at the nodes of the outline's edges.
        """
        smooth = np.einsum("s,sck->ck", self.weights, sampled[self.samples])
        more = traction[self.after, 0] - traction[self.before, 1]
        return np.asarray(smooth + self.field[..., None] * (self.normal @ more[[0, 2]]))


def jumps(
    space: Section,
    outline: Outline,
    material: Material,
    singularities: Iterable[tuple[float, float]],
) -> tuple[Jump, ...]:
    """The jumps at places (r, z), m, where pressures end and edges of the outline meet smoothly."""
    ends = space.nodes[outline.nodes[:, 1]]
    befores = (int(np.hypot(*(ends - singularity).T).argmin()) for singularity in singularities)
    return tuple(_jump(space, outline, material, before) for before in befores)


def unread(every_jump: tuple[Jump, ...], points: Floats, skin: int) -> Ints:
    """The numbers (U,) of points inside the section that are too close to a jump to be read.

    points: (P, 2) r and z in m. The first `skin` points are on the outline, where a fillet may
    begin whose peak must not be missed; the last ones are those of the jumps themselves.
    """
    inside = slice(skin, len(points) - EDGE_DIRECTIONS * len(every_jump))
    close = np.zeros(len(points), dtype=bool)
    for jump in every_jump:
        close[inside] |= np.hypot(*(points[inside] - [jump.r, jump.z]).T) < jump.reach
    return np.flatnonzero(close)


def _jump(space: Section, outline: Outline, material: Material, before: int) -> Jump:
    """The jump at the end of an edge of the outline."""
    after = int(outline.after[before])
    first, singularity, last = space.nodes[
        [outline.nodes[before, 0], outline.nodes[before, 1], outline.nodes[after, 1]]
    ]
    spacing = float(max(np.linalg.norm(singularity - first), np.linalg.norm(last - singularity)))
    distance = np.hypot(*(space.samples - singularity).T)
    far = np.flatnonzero(distance > UNUSABLE_ELEMENTS * spacing)
    nearest = far[np.argsort(distance[far], kind="stable")[:CONTINUATION_SAMPLES]]
    normal, weights, field = at_edge(
        (first, singularity, last), space.samples[nearest], material.poisson_ratio
    )
    r, z = (float(x) for x in singularity)
    return Jump(r, z, before, after, normal, UNREAD_ELEMENTS * spacing, nearest, weights, field)


def at_edge(
    nodes: tuple[Floats, Floats, Floats], samples: Floats, nu: float
) -> tuple[Floats, Floats, Floats]:
    """The normal (2,), weights (S,) and field (D, 6) of a jump at the middle one of three nodes.

    nodes: (2,) m each.
    samples: (S, 2) m, whose stress is extrapolated.
    nu: Poisson's ratio.
    """
    first, middle, last = nodes
    along = (last - first) / np.linalg.norm(last - first)
    normal = np.array([along[1], -along[0]])
    weights = fit_weights(samples - middle, np.ones(len(samples)))
    x, y = np.stack([along, -normal]) @ (samples - middle).T
    at_samples = _field(np.arctan2(y, x), along, nu)
    field = _field(np.linspace(0.0, np.pi, EDGE_DIRECTIONS), along, nu)
    return normal, weights, field - weights @ at_samples


def _field(chi: Floats, along: Floats, nu: float) -> Floats:
    """The stress (J, 6) in directions chi (J,), rad, of a unit pressure on half of a half-plane's
    edge.

    The formulae are in the docstring of the module.
    along: (2,) tangent.
    """
    both, apart = chi / np.pi, np.sin(chi) * np.cos(chi) / np.pi
    ss, nn, ns = -(both + apart), -(both - apart), np.sin(chi) ** 2 / np.pi
    none = np.zeros_like(chi)
    parts = (part[:, None] for part in (ss, nu * (ss + nn), nn, ns, none, none))
    return in_axes(along, *parts)[..., 0]
