"""Stress where a pressure ends on a smooth surface: bounded, but dependent on direction.

Close to such an edge a body is a half-plane with a pressure p on one half of its surface, whose
stress is the same at all distances. With x along the surface away from the pressure, y into the
body and chi the angle from x to y,

    s_xx, s_yy = -p (chi +- sin chi cos chi) / pi        s_xy = -p sin^2 chi / pi

and the largest von Mises stress is often below the edge, at no distance. The elements that touch
the edge are as wrong on the finest mesh as on the first, so they are not read. p is known: its
field is taken off the stress in the elements further on, what is left is smooth and is continued to
the edge, and there the field is put back, direction by direction.

Source: Johnson, Contact Mechanics, 2.5, a strip under pressure whose other end is far away.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from fea.core.local_fit import at_one_place
from fea.core.material import Material
from fea.harmonic.assembly import Section
from fea.harmonic.boundary import Outline
from fea.harmonic.surface_stress import in_axes
from pinbase.arrays import Floats, Ints

EDGE_DIRECTIONS = 25  # from the surface on one side of the edge to that on the other
UNUSABLE_ELEMENTS = 1.5  # elements next to the edge whose stress is of no use
UNREAD_ELEMENTS = 3.0  # elements next to it where stress is not read
CONTINUATION_SAMPLES = 45  # of the stress further on, from which it is continued


@dataclass(frozen=True)
class Jump:
    """Such an edge at (r, z), m. before, after: the edges of the outline that meet there; normal:
    (2,), outwards. reach: m, within which nothing else inside is read. samples: numbers (S,) of
    those (3 M) that are continued, with weights (S,). field: (D, 6), what a pressure of 1 on
    `before` adds to that.
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
        """(D, 6, K) Pa, of stress at all samples (3 M, 6, K) and tractions (E, 3, 3, K) at the
        nodes of the outline's edges.
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
    """At places (r, z), m, where edges of the outline meet smoothly."""
    ends = space.nodes[outline.nodes[:, 1]]
    befores = (int(np.hypot(*(ends - singularity).T).argmin()) for singularity in singularities)
    return tuple(_jump(space, outline, material, before) for before in befores)


def unread(found: tuple[Jump, ...], points: Floats, skin: int) -> Ints:
    """Which of points (P, 2), r and z in m, inside the section are too close to a jump, (U,). The
    first ones, `skin`, are on its outline, where a fillet may begin whose peak must not be missed;
    the last ones are the jumps' own.
    """
    inside = slice(skin, len(points) - EDGE_DIRECTIONS * len(found))
    close = np.zeros(len(points), dtype=bool)
    for jump in found:
        close[inside] |= np.hypot(*(points[inside] - [jump.r, jump.z]).T) < jump.reach
    return np.flatnonzero(close)


def _jump(space: Section, outline: Outline, material: Material, before: int) -> Jump:
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
    """Normal (2,), weights (S,) and field (D, 6), as a Jump has them, where the middle one of three
    nodes is, each (2,), m, of samples (S, 2), m.
    """
    first, middle, last = nodes
    along = (last - first) / np.linalg.norm(last - first)
    normal = np.array([along[1], -along[0]])
    weights = at_one_place(samples - middle, np.ones(len(samples)))
    x, y = np.stack([along, -normal]) @ (samples - middle).T
    there = _field(np.arctan2(y, x), along, nu)
    field = _field(np.linspace(0.0, np.pi, EDGE_DIRECTIONS), along, nu)
    return normal, weights, field - weights @ there


def _field(chi: Floats, along: Floats, nu: float) -> Floats:
    """Stress (J, 6) in directions chi (J,) of the pressure 1 on the half of a plane's edge."""
    both, apart = chi / np.pi, np.sin(chi) * np.cos(chi) / np.pi
    ss, nn, ns = -(both + apart), -(both - apart), np.sin(chi) ** 2 / np.pi
    none = np.zeros_like(chi)
    parts = (part[:, None] for part in (ss, nu * (ss + nn), nn, ns, none, none))
    return in_axes(along, *parts)[..., 0]
