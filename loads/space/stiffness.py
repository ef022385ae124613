"""Stiffness of links as beams, and flexibility of the cantilevers from their centres to joints.

Only ratios of stiffness matter where links share loads. A link is a star of cantilevers, clamped at
its centre of mass, one to each of its joints (Euler-Bernoulli beams with Saint-Venant's torsion;
Timoshenko, Strength of Materials I, ch. V and II, ch. VI).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pinbase.arrays import Floats

POISSON_RATIO = 0.3  # Poisson's ratio of the bars, for the ratio of torsion to bending
NOMINAL_SLENDERNESS = 10.0  # length scale over diameter of links where no stiffness is stated
MIN_ARM = 1e-12  # m: a joint this close to the centre has no cantilever
MIN_SQUARE = 1e-2  # least component of a unit vector across a cantilever that defines the depth


@dataclass(frozen=True)
class LinkStiffness:
    """The stiffness of a link's section, in any units that all links share.

    axial: EA, N.
    bending, across: EI for deflection along the depth of the section, and across it, N m^2.
    torsion: GJ, N m^2.
    depth: direction of the depth as drawn; None for the direction in the plane of the drawing,
    across the link.
    """

    axial: float
    bending: float
    across: float
    torsion: float
    depth: tuple[float, float, float] | None = None

    def times(self, factor: float) -> LinkStiffness:
        """The link with all stiffnesses multiplied by a factor."""
        return replace(
            self,
            axial=self.axial * factor,
            bending=self.bending * factor,
            across=self.across * factor,
            torsion=self.torsion * factor,
        )

    def with_torsion(self, factor: float) -> LinkStiffness:
        """The link with its stiffness in torsion multiplied by a factor."""
        return replace(self, torsion=self.torsion * factor)


def round_link(diameter: float, youngs_modulus: float = 1.0, bore: float = 0.0) -> LinkStiffness:
    """The stiffness of a round bar or tube. diameter, bore: m. youngs_modulus: Pa."""
    inertia = math.pi / 64.0 * (diameter**4 - bore**4)
    area = math.pi / 4.0 * (diameter**2 - bore**2)
    bending = youngs_modulus * inertia
    return LinkStiffness(youngs_modulus * area, bending, bending, bending / (1.0 + POISSON_RATIO))


def flat_link(depth: float, width: float, youngs_modulus: float = 1.0) -> LinkStiffness:
    """The stiffness of a rectangular bar.

    Torsion follows from an approximation within 4 % (Roark, Formulas for Stress and Strain, table
    10.1).
    depth: in the plane of the drawing, m. width: across that plane, m. youngs_modulus: Pa.
    """
    a, b = max(depth, width) / 2.0, min(depth, width) / 2.0
    twist = a * b**3 * (16.0 / 3.0 - 3.36 * b / a * (1.0 - b**4 / (12.0 * a**4)))
    shear = youngs_modulus / (2.0 * (1.0 + POISSON_RATIO))
    return LinkStiffness(
        youngs_modulus * depth * width,
        youngs_modulus * width * depth**3 / 12.0,
        youngs_modulus * depth * width**3 / 12.0,
        shear * twist,
    )


def complete(
    bodies: Sequence[str], stated: Mapping[str, LinkStiffness], length_scale: float
) -> dict[str, LinkStiffness]:
    """The stiffness of every body: as stated, otherwise the geometric mean of the stated ones.

    Where nothing is stated, all links are round bars with a tenth of the length scale as diameter.
    Rigid links do not enter the mean.
    length_scale: length scale of the linkage, m.
    """
    mean = round_link(length_scale / NOMINAL_SLENDERNESS)
    if known := [s for s in stated.values() if np.isfinite(s.axial)]:
        rows = np.log([[s.axial, s.bending, s.across, s.torsion] for s in known])
        mean = LinkStiffness(*np.exp(rows.mean(axis=0)).tolist())
    return {body: stated.get(body, mean) for body in bodies}


def cantilever(arm: Floats, link: LinkStiffness) -> Floats:
    """The flexibility (6, 6) at the end of a cantilever, for force, then moment, in world axes.

    arm: (3,) m, from the fixed end to the loaded end; a cantilever without length is rigid.
    """
    length = float(np.linalg.norm(arm))
    out = np.zeros((6, 6))
    if length <= MIN_ARM:
        return out
    along = arm / length
    side = _depth(along, link)
    normal = np.cross(along, side)
    axes = np.stack([along, side, normal])  # rows: local x, y (along the depth), z (across it)
    plane, across = link.bending, link.across
    local = np.zeros((6, 6))
    local[0, 0] = length / link.axial
    local[1, 1], local[2, 2] = length**3 / (3.0 * plane), length**3 / (3.0 * across)
    local[1, 5] = local[5, 1] = length**2 / (2.0 * plane)
    local[2, 4] = local[4, 2] = -(length**2) / (2.0 * across)
    local[3, 3] = length / link.torsion
    local[4, 4], local[5, 5] = length / across, length / plane
    turn = np.kron(np.eye(2), axes)
    return np.asarray(turn.T @ local @ turn)


def _depth(along: Floats, link: LinkStiffness) -> Floats:
    """The direction (3,) of the depth of a link's section.

    along: (3,) unit vector of the cantilever, to which the depth is perpendicular.
    """
    if link.depth is not None:
        depth = np.array(link.depth) / np.linalg.norm(link.depth)
        depth -= (depth @ along) * along
        if (size := float(np.linalg.norm(depth))) > MIN_SQUARE:
            return np.asarray(depth / size)
    # By default the depth is in the plane, so that `across` resists deflection along z. For a
    # cantilever along z any direction across it will do.
    up = np.array([0.0, 0.0, 1.0]) if abs(along[2]) < 1.0 - 1e-9 else np.array([1.0, 0.0, 0.0])
    side = np.cross(up, along)
    return np.asarray(side / np.linalg.norm(side))


def variations(
    known: Mapping[str, LinkStiffness], loose: Sequence[str], ratio: float
) -> dict[str, dict[str, LinkStiffness]]:
    """Other, equally plausible stiffnesses of all bodies, by a text that says what differs.

    Each of the `loose` links, whose stiffness is not stated, is `ratio` times as stiff, then as
    flexible. The same is done for all loose links together, in torsion only.
    """
    out: dict[str, dict[str, LinkStiffness]] = {}
    for times, text in _ends(ratio):
        for name in loose:
            out[f"{name} {text}"] = {**known, name: known[name].times(times)}
        if loose:
            twisted = {name: known[name].with_torsion(times) for name in loose}
            out[f"all links {text} in torsion"] = {**known, **twisted}
    return out


def _ends(ratio: float) -> tuple[tuple[float, str], ...]:
    return (ratio, f"{ratio:g} times stiffer"), (1.0 / ratio, f"{ratio:g} times more flexible")


def load_sizes(forces: Floats, moments: Floats) -> Floats:
    """The largest forces of C connections over all instants, then the largest moments, (2 C,).

    forces, moments: (T, C, components).
    """
    sizes = [np.linalg.norm(x, axis=-1).max(axis=0) for x in (forces, moments)]
    return np.concatenate(sizes)


def worst_groups(
    known: Mapping[str, LinkStiffness],
    loose: Sequence[str],
    ratio: float,
    loads: Mapping[str, Floats],
) -> dict[str, dict[str, LinkStiffness]]:
    """Stiffnesses with a group of loose links `ratio` times as stiff as the rest, by a text.

    There is one group for each of K loads, chosen to raise this load most: the links that raise the
    load when each of them alone is stiffer are assumed to raise it together, too. Checked with a
    side load on a landing gear of ten links: each load found in this way is at least 0.88 of the
    largest over 800 random groups; with a single stiffer link it is 0.4 to 1 of that.
    loads: sizes (K,) of the loads, by the text of each of `variations`.
    """
    if len(loose) < 2:
        return {}
    (_, stiffer), (_, softer) = _ends(ratio)
    raise_ = np.stack([loads[f"{x} {stiffer}"] >= loads[f"{x} {softer}"] for x in loose])
    out, root = {}, ratio**0.5
    for stiff in np.unique(raise_, axis=1).T:
        few = stiff if 2 * stiff.sum() <= len(loose) else ~stiff
        if not few.any():
            continue  # all links are equally stiff
        names = ", ".join(name for name, here in zip(loose, few, strict=True) if here)
        text = f"{names} {stiffer if few is stiff else softer} than the rest"
        ends = {x: root if s else 1.0 / root for x, s in zip(loose, stiff.tolist(), strict=True)}
        out[text] = {**known, **{x: known[x].times(times) for x, times in ends.items()}}
    return out
