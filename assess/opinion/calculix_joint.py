"""A second opinion on a pin in its lugs: CalculiX's contact in three dimensions.

The geometry is that of fea.support.contact: the pin as described, and each lug an annulus whose
thickness is the length of its band, with its bushing, its clearance and the rounded edges of its
bore. The supports of the lugs are also the same: the link's force is a traction of constant
direction on the outer surface, whose mean tilt is guided or sprung. The differences are the
elements (C3D20R), the contact (surface to surface, with a penalty), the solver and the stress
recovery. If all forces lie in one plane, only one half is modelled. Each lug starts where it
touches the pin: it is shifted by half its clearance along its force, which has no effect without
friction. The lugs of a structure are fixed, so they are shifted together, by half the smallest of
their clearances.

CalculiX finds contact between the deformed bodies, our model between the undeformed ones. Forces
and gaps are therefore scaled down by the same factor (Fineness.scale), and the results scaled up:
this is the limit that fea.support.contact computes. At full loads a tilting lug slides along the
pin by more than an element.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from assess.opinion import calculix
from assess.opinion.calculix_joint_answer import JointOpinion, read_answer
from assess.opinion.calculix_joint_deck import Eye, JointDeck, Part
from assess.opinion.calculix_joint_mesh import (
    Fineness,
    Hexahedra,
    annulus_mesh,
    layers_at_fillets,
    pin_mesh,
)
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, Pin
from geometry.mesh.hexahedra import fillets_of
from geometry.shape.rings import graded

DEFAULT_FINENESS = Fineness()
MIN_FLAT_LENGTH = 1e-3  # relative to the band: a shorter flat part between rounded edges is ignored
MAX_OUT_OF_PLANE_FORCE = 1e-6  # out-of-plane force, relative to the largest force


def joint_opinion(
    pin: Pin,
    material: Material,
    lugs: Sequence[Lug],
    loads: PinLoads,
    fineness: Fineness = DEFAULT_FINENESS,
) -> JointOpinion:
    """Return CalculiX's opinion on a pin under transverse link forces and moments at one instant.

    A lug whose connection has no loads is a lug of a structure.

    Raises: ArgumentError for loads or shapes that this model lacks; CalculixError.
    """
    deck, angle = joint_deck(pin, material, lugs, loads, fineness)
    return deck_opinion(pin, deck, angle, fineness.scale)


def deck_opinion(pin: Pin, deck: JointDeck, angle: float, scale: float) -> JointOpinion:
    """Return CalculiX's opinion from a deck.

    angle: angle by which the deck's axes are rotated about the pin's, rad.
    scale: factor on the deck's forces and gaps.

    Raises: CalculixError.
    """
    with tempfile.TemporaryDirectory(prefix="pinstress-ccx-") as name:
        folder = Path(name)
        deck.write(folder / f"{calculix.JOB_NAME}.inp")
        printed = calculix.run(folder)
        return read_answer(pin, deck, angle, folder, printed, scale)


def joint_deck(
    pin: Pin, material: Material, lugs: Sequence[Lug], loads: PinLoads, fineness: Fineness
) -> tuple[JointDeck, float]:
    """Return the deck, and the angle, rad, by which its axes are rotated about the pin's.

    Arguments and errors as `joint_opinion`.
    """
    force, couple = _forces(loads, [lug.connection for lug in lugs])
    angle, half = plane_of(np.concatenate([force, couple / pin.length]))
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]]) * (0.5 if half else 1.0) * fineness.scale
    tilting = loads.tilting_links(pin.length)
    radii = {lug.connection: lug.edge_radius for lug in lugs}
    stations = stations_of(pin, radii, fineness)
    mesh = pin_mesh(pin, stations, fineness, half)
    held = [lug for lug in lugs if lug.connection not in loads.surfaces]
    least = min((lug.clearance for lug in held), default=0.0)
    reaction = -force.sum(axis=0) @ turn  # of the structure on its lugs
    eyes = [
        _eye(
            pin, replace(lug, tilt=0.0) if lug.connection in tilting else lug, (f @ turn, m @ turn),
            mesh, stations, fineness, half, (least, reaction) if lug in held else None,
        )
        for lug, f, m in zip(lugs, force, couple, strict=True)
    ]  # fmt: skip
    eyes.sort(key=lambda eye: float(eye.part.mesh.nodes[:, 2].min()))
    hard = fineness.stiffness * material.youngs_modulus / pin.smallest_diameter
    return JointDeck(Part("PIN", mesh, material), tuple(eyes), hard, half), angle


def _forces(loads: PinLoads, connections: Sequence[str]) -> tuple[Floats, Floats]:
    """Return the transverse forces (B, 2), N, of the links, and their couples (B, 2), N m: those of
    forces along x, and of forces along y.

    Raises: ArgumentError for more than one instant, or other loads.
    """
    if len(loads) != 1:
        raise ArgumentError("the contact is solved for one instant", "not-one-instant")
    if loads.body.any() or loads.moments[..., 2].any() or loads.forces[..., 2].any():
        raise ArgumentError("only forces and moments across the pin are modelled", "other-loads")
    out = np.zeros((2, len(connections), 2))
    for c, name in enumerate(loads.surfaces):
        x, y, _ = loads.moments[0, c]
        out[:, list(connections).index(name)] = loads.forces[0, c, :2], (y, -x)
    return out[0], out[1]


def plane_of(force: Floats) -> tuple[float, bool]:
    """Return the direction, rad, of the largest of forces (B, 2), N, and whether all forces are
    parallel to it.

    If they are, only half of the joint is modelled. If not, the direction is 0.
    """
    fx, fy = force[np.argmax(np.linalg.norm(force, axis=1))]
    across = np.abs(force @ [-fy, fx]).max() / np.hypot(fx, fy)
    if across > MAX_OUT_OF_PLANE_FORCE * np.hypot(fx, fy):
        return 0.0, False
    return float(np.arctan2(fy, fx)), True


def stations_of(pin: Pin, radii: Mapping[str, float], fineness: Fineness) -> list[Floats]:
    """Return the ends of the element layers in every segment, m.

    radii: edge radii of the bores by connection, m.
    """
    out = []
    for i, (start, end) in enumerate(pairwise(pin.stations)):
        band, name = pin.bands[i], pin.segments[i].connection
        if name:
            ends = _ring_ends(band.length, radii[name], fineness.rings)
            count, parts = len(ends) - 1, fineness.parts
            cut = np.interp(np.arange(count * parts + 1) / parts, range(count + 1), ends)
        else:
            count = max(2, round(fineness.along * band.length / pin.smallest_diameter))
            cut = np.linspace(0.0, band.length, count + 1)
        fillets = [x for x in fillets_of(pin) if x.z in (start, end)]
        z = np.concatenate(
            [[start] * bool(band.z0 > start), band.z0 + cut, [end] * bool(band.z1 < end)]
        )
        out.append(layers_at_fillets(z, fillets, fineness))
    return out


def _ring_ends(length: float, radius: float, count: int) -> Floats:
    """Return the ends of the rings of a band, m: `count` rings on its flat part, and two in the
    rounding of each edge.

    A single ring would not do, because the parabola of its quadratic elements would press on the
    pin.
    """
    flat = length - 2.0 * radius
    inner = (
        radius + graded(flat, count)
        if flat > MIN_FLAT_LENGTH * length
        else np.array([length / 2.0])
    )
    if not radius:
        return inner
    edge = np.array([0.0, radius / 2.0])
    return np.concatenate([edge, inner, (length - edge)[::-1]])


def _eye(
    pin: Pin,
    lug: Lug,
    acting: tuple[Floats, Floats],
    mesh: Hexahedra,
    stations: list[Floats],
    fineness: Fineness,
    half: bool,
    structure: tuple[float, Floats] | None,
) -> Eye:
    """Return a lug with its support.

    structure: for a fixed lug, the clearance, m, and the force (2,), N, with which its structure
    touches the pin; None for the lug of a link.
    """
    i, band = pin.labels.index(lug.connection), pin.band(lug.connection)
    radius, tiny = pin.segments[i].diameter / 2.0, 1e-9 * pin.length
    on_band = (stations[i] > band.z0 - tiny) & (stations[i] < band.z1 + tiny)
    z = stations[i][on_band]
    inside = lug.bushing
    lining = None if inside is None else (radius + inside.thickness, inside.material)
    radii = (radius, *(lining[:1] if lining else ()), lug.outer_diameter / 2.0)
    plain = annulus_mesh(radii, z, fineness, half)
    force, (x, y) = acting[0], acting[1].tolist()
    gap, along = structure or (lug.clearance, force)
    body = _opened(plain, lug, 0.5 * fineness.scale * gap * _direction(along), fineness.scale)
    before = sum(len(x) - 1 for x in stations[:i]) + int(on_band.argmax())
    surface = np.abs(mesh.outer - radius) < 1e-9 * radius
    ring = (mesh.layer - before) // fineness.parts
    count = -(-(len(z) - 1) // fineness.parts)
    rings = tuple(np.flatnonzero(surface & (ring == k)) for k in range(count))
    part = Part(f"LUG{i}", body, lug.material, lining)
    tilt = lug.tilt * (0.5 if half else 1.0)
    return Eye(part, force, tilt, rings, (x, y), held=structure is not None)


def _direction(force: Floats) -> Floats:
    size = float(np.linalg.norm(force))
    return force / size if size else np.zeros(2)


def _opened(mesh: Hexahedra, lug: Lug, shift: Floats, scale: float) -> Hexahedra:
    """Return the mesh of a lug with the clearance and edge rounding of its bore.

    shift: (2,) displacement of the whole lug, m. scale: factor on clearance and rounding.
    """
    x = mesh.nodes
    r = np.hypot(x[:, 0], x[:, 1])
    edge = np.minimum(x[:, 2] - x[:, 2].min(), x[:, 2].max() - x[:, 2])
    left = np.maximum(lug.edge_radius - edge, 0.0)
    depth = lug.edge_radius - np.sqrt(lug.edge_radius**2 - left**2)
    share = (mesh.outer.max() - r) / (mesh.outer.max() - mesh.inner.min())
    moved = x.copy()
    half = 0.5 * scale * lug.clearance
    moved[:, :2] *= (1.0 + share * (half + scale * depth) / r)[:, None]
    moved[:, :2] += shift
    return replace(mesh, nodes=moved)
