"""Pins in their lugs, drawn at random, by our harmonic contact and by CalculiX in 3D.

Times are processor times, since other work increases wall times; CalculiX has one thread.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass, replace

import numpy as np

from assess.opinion.calculix import CALCULIX_COMMAND, INSTALL_HINT, CalculixError, installed
from assess.opinion.calculix_joint import joint_opinion
from assess.opinion.calculix_joint_answer import JointOpinion, edges
from assess.opinion.calculix_joint_mesh import CONTACT_STIFFNESS, Fineness
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.field import HarmonicField
from fea.harmonic.superposition import Circumference
from fea.solve.solve import solve_pin
from fea.support.contact.resolution import ROUGH, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment

STEEL = Material("steel", 210e9, 0.3)
EYES = (STEEL, Material("aluminium", 70e9, 0.33), Material("titanium", 114e9, 0.33))
COUNT, SEED = 6, 20
DISTANCE = 0.1  # of the smallest diameter; nearer to lugs' edges and shoulders stress is left out
EVERY = Fineness(sectors=24, layers=3, eye=2, along=8.0)
WHOLE = Fineness(rings=6, sectors=16, eye=2)  # without a plane of symmetry to halve the unknowns
REFINED = 0  # the joint that CalculiX solves on several meshes and with several stiffnesses
MESHES = (
    Fineness(rings=6, sectors=16, eye=2),
    EVERY,
    Fineness(sectors=32, layers=3, eye=2, along=8.0),
    Fineness(rings=6, sectors=16, eye=2, stiffness=CONTACT_STIFFNESS / 2.0),
    Fineness(rings=6, sectors=16, eye=2, stiffness=CONTACT_STIFFNESS * 2.0),
    Fineness(rings=6, sectors=16, eye=2, scale=1.0),
)
CELLS = ROUGH, Resolution(6, 24, 8), Resolution(), Resolution(10, 48, 16)
USUAL = 2  # index in CELLS
INSTANTS = 201
SHAPES = "plain", "stepped", "hollow"


@dataclass(frozen=True)
class Joint:
    """A pin, its lugs and the forces of one instant."""

    pin: Pin
    lugs: tuple[Lug, ...]
    loads: PinLoads

    @property
    def oblique(self) -> bool:
        """Whether its forces are not in one plane."""
        return bool(self.loads.forces[..., 1].any())

    @property
    def described(self) -> str:
        """The thickness of the lugs over the diameter, and the shape of the pin."""
        d = self.pin.smallest_diameter
        bands = [self.pin.band(lug.connection) for lug in self.lugs]
        thick = " + ".join(f"{band.length / d:.2f}" for band in bands)
        kind = "plain"
        if self.pin.segments[0].bore:
            kind = f"bore {self.pin.segments[0].bore / d:.2f} d"
        widest = max(s.diameter for s in self.pin.segments)
        if widest > d:
            kind = f"stepped to {widest / d:.2f} d"
        return f"{thick} d, {kind}"


@dataclass(frozen=True)
class Ours:
    """Our result.

    moment: largest bending moment, N m.
    stress: von Mises stress, Pa, at the governing point (3,), m.
    contact, stresses: processor times, s.
    pressures, unknowns: numbers of contact pressures and of unknowns of the mesh.
    """

    moment: float
    stress: float
    point: Floats
    contact: float
    stresses: float
    pressures: int
    unknowns: int


def joint_ccx() -> str:
    """Return the five tables."""
    if not installed():
        return f"CalculiX is not installed (no {CALCULIX_COMMAND}); {INSTALL_HINT}"
    joints = drawn(COUNT, SEED)
    parts = [_described(joints), _comparison(joints), _meshes(joints[REFINED])]
    return "\n\n".join([*parts, _ours(joints[REFINED]), _motion(joints[REFINED])])


def drawn(count: int, seed: int) -> list[Joint]:
    """Return joints with two or three lugs and plain, stepped or hollow pins; the forces on the
    last are not in one plane.
    """
    rng = np.random.default_rng(seed)
    return [_drawn(rng, k, oblique=k == count - 1) for k in range(count)]


def _drawn(rng: np.random.Generator, k: int, oblique: bool) -> Joint:
    d, three = float(rng.uniform(0.01, 0.05)), k % 3 != 0 or oblique
    shape = SHAPES[(k + k // 3) % 3]
    thick = d * rng.uniform(0.4, 0.9, 3) * ([1.0, 1.6, 1.0] if three else [1.0, 1.0, 1.0])
    gap, over = (float(x) for x in d * rng.uniform(0.04, 0.12, 2))
    bore = float(rng.uniform(0.3, 0.6)) * d if shape == "hollow" else 0.0
    wide = d * float(rng.uniform(1.15, 1.4)) if shape == "stepped" else d
    names = ("A", "B", "C") if three else ("A", "B")
    segments = [Segment(over, d, bore)]
    for name, t in zip(names, thick.tolist(), strict=False):
        segments.append(Segment(t, wide if name == "B" else d, bore, connection=name))
        segments.append(Segment(gap, d, bore))
    segments[-1] = Segment(over, wide if names[-1] == "B" else d, bore)
    pin = Pin(f"joint {k + 1}", tuple(segments))
    lugs = tuple(_lug(rng, pin, name, guided=three and name == "B") for name in names)
    return Joint(pin, lugs, _loads(rng, names, d, oblique))


def _lug(rng: np.random.Generator, pin: Pin, name: str, guided: bool) -> Lug:
    """Return a lug whose tilt stiffness is that of a shank as wide as the eye, clamped one width
    away.
    """
    band, material = pin.band(name), EYES[int(rng.integers(len(EYES)))]
    d = 2.0 * band.radius
    outer = d * float(rng.uniform(2.0, 2.6))
    clearance = d * float(max(0.0, rng.uniform(-0.002, 0.005)))
    tilt = material.youngs_modulus * band.length**3 / 12.0
    return Lug(name, outer, material, clearance, tilt=np.inf if guided else tilt)


def _loads(rng: np.random.Generator, names: tuple[str, ...], d: float, oblique: bool) -> PinLoads:
    size, share = 150e6 * d * d, float(rng.uniform(0.35, 0.65))
    forces = np.zeros((1, len(names), 3))
    parts = (-share, 1.0, share - 1.0) if len(names) > 2 else (-0.4, 0.4)
    forces[0, :, 0] = size * np.array(parts)
    if oblique:
        forces[0, :, 1] = size * np.array([0.3, -0.1, -0.2])
    return PinLoads("pull", names, forces)


def _described(joints: list[Joint]) -> str:
    rows = []
    for k, joint in enumerate(joints, 1):
        clearances = ", ".join(
            f"{lug.clearance / joint.pin.smallest_diameter:.4f}" for lug in joint.lugs
        )
        of = ", ".join(lug.material.name for lug in joint.lugs)
        d = f"{1e3 * joint.pin.smallest_diameter:.1f}"
        planar = "no" if joint.oblique else "yes"
        rows.append((k, d, joint.described, clearances, of, planar))
    return table(("joint", "d [mm]", "lugs, pin", "clearances / d", "lugs of", "in a plane"), rows)


def _comparison(joints: list[Joint]) -> str:
    rows = [
        (k, *_row(joint, ours(joint), _theirs(joint, WHOLE if joint.oblique else EVERY)))
        for k, joint in enumerate(joints, 1)
    ]
    head = ("joint", "M [N m], ours", "CalculiX", "off [%]", "governing point [MPa], ours")
    more = ("CalculiX", "off [%]", "its largest [MPa]", "unknowns, ours", "CalculiX")
    return table((*head, *more, "processor [s], ours", "CalculiX", "its iterations"), rows)


def _row(
    joint: Joint, mine: Ours, other: tuple[JointOpinion, float] | CalculixError
) -> tuple[object, ...]:
    unknowns = f"{mine.pressures} + {mine.unknowns}"
    spent = f"{mine.contact:.2f} + {mine.stresses:.2f}"
    if isinstance(other, CalculixError):
        own = f"{mine.moment:.4g}", other, "", f"{mine.stress / 1e6:.1f}", "", "", ""
        return (*own, unknowns, "", spent, "", "")
    found, used = other
    moment = largest_moment(found, joint.pin)
    there = float(found.von_mises_at(mine.point[None])[0])
    return (
        f"{mine.moment:.4g}",
        f"{moment:.4g}",
        _deviation(mine.moment, moment),
        f"{mine.stress / 1e6:.1f}",
        f"{there / 1e6:.1f}",
        _deviation(mine.stress, there),
        f"{found.largest(DISTANCE * joint.pin.smallest_diameter) / 1e6:.1f}",
        unknowns,
        found.unknowns,
        spent,
        f"{used:.0f}",
        _iterations(found),
    )


def _deviation(one: float, other: float) -> str:
    return f"{100.0 * (one / other - 1.0):+.1f}"


def _theirs(joint: Joint, fineness: Fineness) -> tuple[JointOpinion, float] | CalculixError:
    """Return CalculiX's result and its processor time, s, or the error."""
    before = os.times()
    try:
        found = joint_opinion(joint.pin, STEEL, joint.lugs, joint.loads, fineness)
    except CalculixError as error:
        return error
    after = os.times()
    used = after.children_user + after.children_system
    return found, used - before.children_user - before.children_system


def ours(joint: Joint, cells: Resolution = CELLS[USUAL]) -> Ours:
    """Return our result: contact, then stress to 2 %, at its largest away from edges."""
    start = time.process_time()
    model = ContactModel(joint.pin, STEEL, joint.lugs, cells)
    found = model.solve(joint.loads)
    pressed = time.process_time()
    (solution,) = solve_pin(found.pin, STEEL, (), (found.loads,), Requirement(model="harmonic"))
    done = time.process_time()
    assert isinstance(solution.answer, HarmonicField)
    fields, bounds = solution.answer.fields, edges(joint.pin)
    away = np.hypot(*(fields.points[:, :2, None] - bounds.T).transpose(1, 0, 2))
    outside = (away > DISTANCE * joint.pin.smallest_diameter).all(axis=1)
    top = Circumference(fields, found.loads).top(outside)
    r, z = fields.points[top.point]
    return Ours(
        float(np.linalg.norm(found.bending_moment(_along(joint.pin))[0], axis=1).max()),
        top.value,
        np.array([r * np.cos(top.angle), r * np.sin(top.angle), z]),
        pressed - start,
        done - pressed,
        model.contact.area.size,
        solution.peak.dofs,
    )


def largest_moment(found: JointOpinion, pin: Pin) -> float:
    """Return the largest moment along the pin, N m."""
    return float(np.linalg.norm(found.bending_moment(_along(pin)), axis=1).max())


def _along(pin: Pin) -> Floats:
    return np.linspace(0.0, pin.length, 401)


def _meshes(joint: Joint) -> str:
    """Return the table of CalculiX on several meshes, with other stiffnesses of the contact, and
    under full loads.
    """
    point = ours(joint).point[None]
    rows: list[tuple[object, ...]] = []
    for mesh in MESHES:
        rings = f"{mesh.rings} rings, {mesh.sectors} sectors, {mesh.layers} + {mesh.eye} layers"
        about = rings, f"{mesh.stiffness:g}", f"{mesh.scale:g}"
        other = _theirs(joint, mesh)
        if isinstance(other, CalculixError):
            rows.append((*about, "", "", other, "", ""))
            continue
        found, used = other
        numbers = largest_moment(found, joint.pin), found.von_mises_at(point)[0] / 1e6
        cost = found.unknowns, f"{used:.0f}", _iterations(found)
        rows.append((*about, *(f"{x:.4g}" for x in numbers), *cost))
    head = (f"CalculiX, joint {REFINED + 1}", "contact [E/d]", "scale", "M [N m]")
    return table((*head, "governing point [MPa]", "unknowns", "processor [s]", "iterations"), rows)


def _motion(joint: Joint) -> str:
    """Return the table of a motion: forces that turn once and grow to twice their size.

    CalculiX's time is that of one instant times the number of instants.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, INSTANTS)
    size = (1.0 + turn / turn[-1])[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    forces = np.zeros((INSTANTS, len(joint.lugs), 3))
    forces[..., :2] = joint.loads.forces[0, :, 0, None] * size[:, None]
    moving = replace(joint, loads=replace(joint.loads, forces=forces))
    mine, rows = [ours(moving, cells) for cells in CELLS[: USUAL + 1]], []
    for mesh in MESHES[:2]:
        other = _theirs(joint, mesh)
        if isinstance(other, CalculixError):
            return str(other)
        used = INSTANTS * other[1]
        for cells, own in zip(CELLS, mine, strict=False):
            spent = own.contact + own.stresses
            ratio = f"{used / spent:,.0f}"
            rows.append((_about(cells), f"{spent:.2f}", other[0].unknowns, f"{used:,.0f}", ratio))
    head = (f"ours, joint 1, {INSTANTS} instants", "processor [s]", "unknowns of CalculiX")
    return table((*head, f"{INSTANTS} times its processor [s]", "times ours"), rows)


def _about(cells: Resolution) -> str:
    return f"{cells.rings} rings, {cells.sectors} sectors, n to {cells.highest}"


def _iterations(found: JointOpinion) -> str:
    return f"{found.iterations}, with tension" if found.appended else str(found.iterations)


def _ours(joint: Joint) -> str:
    rows = []
    for cells in CELLS:
        mine = ours(joint, cells)
        numbers = f"{mine.moment:.4g}", f"{mine.stress / 1e6:.1f}", mine.pressures
        rows.append((_about(cells), *numbers, f"{mine.contact:.2f} + {mine.stresses:.2f}"))
    head = (f"ours, joint {REFINED + 1}", "M [N m]", "governing point [MPa]", "pressures")
    return table((*head, "processor [s]"), rows)
