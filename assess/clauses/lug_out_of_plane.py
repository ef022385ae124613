"""Out-of-plane bending of lugs by forces along the pin and moments of their links: the nominal
stress beside the bore and at the held end of the shank, by statics of the link's force and moment.

The axes are u along the shank, z along the pin, and v across both. A section at x from the centre
of the bore has the moments M_u (torsion), M_v + x F_z (out of plane) and M_z - x F_v (in plane).
Each moment is largest at one of these two sections.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from assess.check import CheckText, WorstPlace, check
from assess.clauses.eye import PlateEye, eye_of, shank_angle
from assess.margin import Margin
from assess.situation import Situation
from assess.work import Work, WorkQuantity, work, would_pass
from fea.support.lugs.lug import Lug, Shank
from pinbase.arrays import Floats
from pinbase.keys import lug_key

STRUCTURE_NEED = "the share of each lug of the structure in forces along the pin and moments"
MIN_SHARE = 1e-6  # of the largest force (times the pin's length): smaller loads are round-off
MAX_LEFT = 1e-3  # relative resultant of axial forces or couples that needs no reaction
SERIES_TERMS = 20  # of Saint-Venant's series, whose terms fall with the fifth power of their number
Shown = Callable[[int], Work]  # the work at an instant, by its number
BENDING_TERM = "{N} / {A} + {M} / {W}"
CORNER_FORMULA = "{N} / {A} + {M_in} / {W_in} + {M_out} / {W_out}"
FACE_FORMULA = f"√(({BENDING_TERM})² + 3 × ({{T}} / {{W_t}} + 1.5 × {{V}} / {{A}})²)"


@check(
    "lug, bending out of its plane", "statics", kind="hand", takes="loads",
    omits="Not covered: stress concentration at the bore and where the shank is held, torsion of "
    "the walls beside the bore, instability, a force along the pin that enters beside the bore.",
)  # fmt: skip
def lug_out_of_plane(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margins of lugs with out-of-plane loads; where the shank or its angle is missing,
    what is missing.
    """
    margins, lacking, bent = list[Margin](), list[str](), _bent(s)
    for k, lug in bent:
        angle = shank_angle(s, lug)
        if lug.shank is None:
            lacking.append(lug_key(s.pin.name, lug.connection, "shank"))
        elif angle is None:
            lacking.append(lug_key(s.pin.name, lug.connection, "shank", "angle"))
        else:
            margins += _of_lug(text, s, lug, lug.shank, _Actions.on(s, k, angle))
    if bent and _structure_reacts(s):
        lacking.append(STRUCTURE_NEED)
    return [*margins, text.lacks(s, *lacking)] if lacking else margins


def _bent(s: Situation) -> list[tuple[int, Lug]]:
    """Return the lugs with a force along the pin or a moment transverse to it, and for each the
    number of its loads.
    """
    least = MIN_SHARE * float(np.abs(s.loads.forces).max(initial=0.0))
    along = np.abs(s.loads.forces[..., 2]).max(axis=0, initial=0.0)
    turning = np.abs(_moments(s)[..., :2]).max(axis=(0, 2), initial=0.0)
    bent = (along > least) | (turning > least * s.pin.length)
    lugs = map(s.lug, s.loads.surfaces)
    return [(k, lug) for k, lug in enumerate(lugs) if bent[k] and lug is not None]


def _moments(s: Situation) -> Floats:
    """Return the moments of all links about the middles of their bands, (T, C, 3) N m."""
    moments: Floats = np.broadcast_to(s.loads.moments, s.loads.forces.shape)
    return moments


def _structure_reacts(s: Situation) -> bool:
    """Whether the structure's lugs react a force along the pin or a transverse couple."""
    if s.clamps:
        return False
    forces, moments = s.loads.forces, _moments(s)
    z = np.array([s.pin.band(name).middle for name in s.loads.surfaces])
    couples = moments[..., :2] + z[:, None] * forces[..., [1, 0]] * [-1.0, 1.0]
    parts = forces[..., 2:], couples
    return any(
        bool(np.abs(x.sum(axis=1)).max(initial=0.0) > MAX_LEFT * np.abs(x).max(initial=0.0))
        for x in parts
    )


@dataclass(frozen=True)
class PlateSection:
    """The cross-section of a plate, m, with a hole in the middle of its width."""

    width: float
    thickness: float
    hole: float = 0.0

    @property
    def area(self) -> float:
        """The area of the section, m^2."""
        return (self.width - self.hole) * self.thickness

    @property
    def modulus_in(self) -> float:
        """The section modulus for bending in the plane of the plate, m^3."""
        return (self.width**3 - self.hole**3) * self.thickness / (6.0 * self.width)

    @property
    def modulus_out(self) -> float:
        """The section modulus for bending out of the plane of the plate, m^3."""
        return (self.width - self.hole) * self.thickness**2 / 6.0

    @cached_property
    def modulus_torsion(self) -> float:
        """The torque over the largest shear stress, m^3; this is at the middle of the longer sides.

        Source: Saint-Venant's series for a rectangle without a hole.
        """
        a, b = sorted((self.width / 2.0, self.thickness / 2.0), reverse=True)
        n = np.arange(1, 2 * SERIES_TERMS, 2)
        slope = n * math.pi * a / (2.0 * b)
        inertia = 16.0 / 3.0 * a * b**3
        inertia *= 1.0 - 192.0 * b / (math.pi**5 * a) * float((np.tanh(slope) / n**5).sum())
        twice = np.exp(-slope) / (1.0 + np.exp(-2.0 * slope))  # half of 1 / cosh, without overflow
        edge = 1.0 - 16.0 / math.pi**2 * float((twice / n**2).sum())
        return inertia / (2.0 * b * edge)


@dataclass(frozen=True)
class _Actions:
    """The force (T, 3) N and the moment (T, 3) N m of a link at the bore's centre, in u, v, z."""

    force: Floats
    moment: Floats

    @staticmethod
    def on(s: Situation, link: int, angle: Floats) -> _Actions:
        """Return the actions of a link, by its number. angle: of its lug's shank, (T,) rad."""
        c, n = np.cos(angle), np.sin(angle)

        def turned(x: Floats) -> Floats:
            u, v = c * x[:, 0] + n * x[:, 1], c * x[:, 1] - n * x[:, 0]
            return np.stack([u, v, x[:, 2]], axis=1)

        return _Actions(turned(s.loads.forces[:, link]), turned(_moments(s)[:, link]))

    def at(self, x: float) -> Floats:
        """Return the magnitudes of the moments about u, v and z in a section at x, (T, 3) N m."""
        out, across = x * self.force[:, 2], x * self.force[:, 1]
        u, v, z = self.moment.T
        return np.asarray(np.abs(np.stack([u, v + out, z - across], axis=1)))


def _of_lug(
    text: CheckText, s: Situation, lug: Lug, shank: Shank, actions: _Actions
) -> list[Margin]:
    """Return the margins at the point of a lug with the largest nominal stress."""
    eye, material = eye_of(s, lug), lug.material
    stress, show, where = _largest(eye, shank, actions)
    t = int(stress.argmax())
    margins = text.at_levels(
        s, float(stress[t]), WorstPlace.at_band(s.pin.band(lug.connection), s.loads, t), material,
        material.yield_strength, "ultimate", basis=f"nominal stress {where}",
    )  # fmt: skip

    def passing(margin: Margin) -> WorkQuantity | None:
        def used(thickness: float) -> float:
            thicker, _, _ = _largest(replace(eye, thickness=thickness), shank, actions)
            return margin.factor * float(thicker.max()) / (margin.allowable or math.inf)

        value = would_pass(used, eye.thickness) if margin.allowable else None
        return None if value is None else WorkQuantity("thickness", value, "length")

    return [replace(m, work=(show(t),), passing=passing(m), omits=text.omits) for m in margins]


def _largest(eye: PlateEye, shank: Shank, actions: _Actions) -> tuple[Floats, Shown, str]:
    """Return the stress (T,), Pa, at the point with the largest stress, its work, and its place."""
    beside = PlateSection(eye.width, eye.thickness, eye.hole)
    held = PlateSection(shank.width, eye.thickness)
    points = [(*_corner(beside, actions, 0.0), "beside the bore")]
    points += [(*of(held, actions, shank.length), "where it is held") for of in (_corner, _face)]
    return max(points, key=lambda point: float(point[0].max()))


def _corner(section: PlateSection, actions: _Actions, x: float) -> tuple[Floats, Shown]:
    """Return the stress (T,), Pa, at the corners of a section, which have no shear stress."""
    N, moments = np.abs(actions.force[:, 0]), actions.at(x)
    A, W_in, W_out = section.area, section.modulus_in, section.modulus_out
    stress = N / A + moments[:, 2] / W_in + moments[:, 1] / W_out

    def shown(t: int) -> Work:
        return work(
            "σ", stress[t], "stress", CORNER_FORMULA, N=(N[t], "force"), A=(A, "length^2"),
            M_in=(moments[t, 2], "moment"), W_in=(W_in, "length^3"),
            M_out=(moments[t, 1], "moment"), W_out=(W_out, "length^3"),
        )  # fmt: skip

    return stress, shown


def _face(section: PlateSection, actions: _Actions, x: float) -> tuple[Floats, Shown]:
    """Return the von Mises stress (T,), Pa, at the middles of the sides of a section; the largest
    shear stress of torsion is assumed at each.
    """
    N, moments = np.abs(actions.force[:, 0]), actions.at(x)
    A, W_t = section.area, section.modulus_torsion
    across = np.abs(actions.force[:, 1:])
    moduli = section.modulus_out, section.modulus_in
    normal = N[:, None] / A + moments[:, 1:] / moduli
    shear = moments[:, :1] / W_t + 1.5 * across / A
    stress = np.sqrt(normal**2 + 3.0 * shear**2)

    def shown(t: int) -> Work:
        k = int(stress[t].argmax())
        return work(
            "σ", stress[t, k], "stress", FACE_FORMULA, N=(N[t], "force"), A=(A, "length^2"),
            M=(moments[t, 1 + k], "moment"), W=(moduli[k], "length^3"),
            T=(moments[t, 0], "moment"), W_t=(W_t, "length^3"), V=(across[t, k], "force"),
        )  # fmt: skip

    return stress.max(axis=1), shown
