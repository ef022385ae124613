"""Loads of a case out of the plane of its mechanism, with the positions and the stiffness of the
links.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from geometry import GeometryError, PinLike
from loads import Dynamics, Linkage
from loads.space.out_of_plane import Links, Offsets, OutOfPlane, SideLoad, over_stiffness
from loads.space.sharing import STIFFNESS_RATIO
from loads.space.straight import straight
from pinbase.arrays import Floats
from pinstress.study.model.clevis import middle_of
from pinstress.study.model.mechanism.drives import plane_of
from pinstress.study.model.mechanism.stiffness import stated_stiffness
from pinstress.study.model.pins import pin
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import CaseTable, MechanismCase

OUT_OF_LINE = 1e-6  # relative to the length scale: a link may be bent so much without a note


@dataclass(frozen=True)
class Sideways:
    """Loads and stiffness of a case out of the plane.

    loads: of the case. offsets: of its links along z. links: their stiffness.
    note: the origin of offsets that are not stated.
    """

    loads: tuple[SideLoad, ...]
    offsets: Offsets
    links: Links
    note: str = ""

    def noted(self, note: str) -> str:
        """Return the note of a case with that on the offsets."""
        return " ".join(filter(None, (note, self.note)))

    def completed(self, dynamics: Dynamics) -> Dynamics:
        """Return the dynamics in the plane, completed by the forces out of it.

        Raises: LinkageError if the links of a loop cannot share them.
        """
        balance = OutOfPlane(dynamics, self.loads, self.offsets)
        return replace(dynamics, reactions=balance.reactions(self.links))

    def others(self, dynamics: Dynamics) -> dict[str, Dynamics]:
        """Return the dynamics for other stiffnesses of the links, by the difference in stiffness.

        Empty if statics determines all forces, or the stiffness of all links is stated.
        """
        balance = OutOfPlane(dynamics, self.loads, self.offsets)
        if not balance.redundancy:
            return {}
        every = over_stiffness(balance, self.links, STIFFNESS_RATIO)
        return {text: replace(dynamics, reactions=reactions) for text, reactions in every.items()}


def sideways(
    study: Study, case: CaseTable, mechanism: Linkage, loads: Sequence[SideLoad]
) -> Sideways | None:
    """Return the part of a case out of the plane, or None if everything is in the plane.

    loads: of the case.

    Raises: InputError for a pin that cannot be built.
    """
    table = plane_of(study)
    placed = any(joint.z is not None for joint in table.joint.values())
    aside = isinstance(case, MechanismCase) and any(load.out_of_plane for load in case.apply)
    aside = aside or any(load.force or any(load.couple) for load in loads)
    if not placed and not aside:
        return None
    offsets, note = _offsets(study, mechanism)
    links = Links(stated_stiffness(table.link_stiffness, table.body, _arms(mechanism)))
    return Sideways(tuple(loads), offsets, links, note)


def _offsets(study: Study, mechanism: Linkage) -> tuple[Offsets, str]:
    """Return the positions of links along z, and a sentence on them unless all are stated.

    A link lies at the middle of its band on a pin, a clevis midway between its ears, and a body at
    the clamps of a pin that it carries. Pins lie at their stated z, the others so that links are
    straight.
    """
    stated, middles, roots = dict[str, float](), dict[str, float](), dict[str, float]()
    for name, joint in plane_of(study).joint.items():
        if joint.z is not None:
            stated[name] = joint.z
        if name in study.table.pin:
            shape = pin(study, name)
            on = set(joint.connections) & set(shape.connections)
            middles |= {c: middle_of(c, shape, study.table.pin[name].ears) for c in on}
            if clamps := _clamps(shape, study.table.pin[name].clamp):
                roots[name] = sum(clamps) / len(clamps)
    at, askew = straight(mechanism, middles, stated, roots)
    if len(stated) == len(mechanism.joints):
        return Offsets(at), ""
    factor, unit = study.system.factor("length"), study.system.length
    bent = [
        f"{body} by {size / factor:.3g} {unit}"
        for body, size in askew.items()
        if size > OUT_OF_LINE * mechanism.length_scale
    ]
    out = f" ({', '.join(bent)} out of line)" if bent else ""
    placed = "pins without a z are" if stated else "pins are"
    return Offsets(at), (
        f"Offsets of links along the pins count; {placed} placed so that links are straight{out}."
    )


def axle_height(study: Study, body: str, joint: str) -> float | None:
    """Return the z at which the ground pushes on a body at an axle, m; None if no z of the axle is
    stated.

    It is midway between the other links on the axle, such as the wheel, or else at the body.
    """
    table = plane_of(study).joint[joint]
    if table.z is None or joint not in study.table.pin:
        return table.z
    shape, ears = pin(study, joint), study.table.pin[joint].ears
    on = {c: b for c, b in table.connections.items() if c in shape.connections}
    wheels = [c for c, b in on.items() if b != body] or [*on]
    return table.z + sum(middle_of(c, shape, ears) for c in wheels) / max(len(wheels), 1)


def _arms(mechanism: Linkage) -> dict[str, list[Floats]]:
    """Return the vectors (2,) m from the centre of mass of every body to its joints."""
    return {
        body.name: [
            np.subtract(joint.at, body.centre)
            for joint in mechanism.joints
            if body.name in (joint.fixed_in, *(c.body for c in joint.connections))
        ]
        for body in mechanism.bodies
    }


def _clamps(shape: PinLike, clamps: Sequence[str]) -> list[float]:
    """Return the z of the clamped faces and bands, m, from the start of the pin."""
    ends, out = dict(zip(("start", "end"), shape.ends, strict=True)), list[float]()
    for clamp in clamps:
        try:
            out.append(ends[clamp] if clamp in ends else shape.band(clamp).middle)
        except GeometryError:
            continue  # a cut has no position along z
    return out
