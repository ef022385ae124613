"""CalculiX's contact of a pin with a lug in plane stress: an independent peer of fea.lug.

Of the program it uses only the material's class, the run of CalculiX and the format of numbers.
Each ray from the bore's centre crosses the outline once; the lug between the rays is divided into
quadrilaterals with 8 nodes (CPS8), and so is the pin, a disc with a hole of 3 % of its radius, at
whose edge the force acts. Contact is frictionless, surface to surface, by a stiff penalty. A
bushing is bonded to its hole or in such contact with it; its interference is a thermal strain.

Forces, clearance and interference are scaled by SCALE, since CalculiX finds contact on moved nodes.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from assess.opinion import calculix
from assess.opinion.calculix_deck import real
from fea.core.material import Material
from pinbase.arrays import Floats, Ints

SCALE = 0.01
HUB = 0.03  # of the pin's radius
GROWTH = 1.5  # ratio of the thicknesses of two layers of elements, outwards from the bore
FIRST_LAYER = 0.7  # thickness over an element's length along the bore
OUTER_LAYERS = 6  # between a circle half-way through the thinnest wall and the outline
WEAK_SPRING = 1e-7  # of the lug's modulus: holds the pin without contact
PRESSED_IN = 0.2  # initial overlap of pin and bore, of force over modulus
# m, a hundredth of an element: CalculiX makes bodies of plane elements, and the shear by which the
# thickness contracts must be small; with 1 m the hoop stress was off by 10 MPa of 270
THICKNESS = 1e-5
SECTORS = 360  # elements around the bore
STIFFNESS = 1000.0  # of contact, of the modulus over the bore's diameter
BALANCE = 0.01  # largest error of the pressure's resultant, of the force
SPRING_FIRST = 1_000_000  # number of the first spring element


@dataclass(frozen=True)
class PlaneEye:
    """A lug and its load; lengths in m.

    shape, width, length, end, head: as in geometry.shape.lug_outline.
    radius: of the bore. hole: radius of the hole about a bushing, 0 without one.
    clearance: of the diameters, at the bore after a bushing is pressed in, averaged around it.
    misfit: interference of the bushing, of the diameters.
    force: N/m. direction: of the force, rad; 0 pulls on the lug, away from the shank.
    slips: whether the bushing is in frictionless contact with its hole, not bonded.
    """

    shape: Literal["round", "tapered", "square"]
    radius: float
    head: float
    width: float
    length: float
    end: float
    force: float
    direction: float
    lug: Material
    pin: Material
    hole: float = 0.0
    bushing: Material | None = None
    clearance: float = 0.0
    misfit: float = 0.0
    slips: bool = False


@dataclass(frozen=True)
class BoreAnswer:
    """Hoop stress and pressure around the bore, Pa, at angles (P,) rad from the shank.

    hole: the hoop stress of the lug at the hole of a bushing. seconds: of CalculiX's run.
    """

    angles: Floats
    hoop: Floats
    pressure: Floats
    hole: Floats
    seconds: float


@dataclass(frozen=True)
class _Mesh:
    """Elements (M, 8) on nodes (N, 2), layer by layer, with `sectors` elements in each layer."""

    nodes: Floats
    elements: Ints
    sectors: int


def ccx_answer(eye: PlaneEye, sectors: int = SECTORS) -> BoreAnswer:
    """Return CalculiX's stress and pressure at the bore.

    sectors: elements around the bore

    Raises: CalculixError.
    """
    shrunk = _shrinkage(eye, sectors) if eye.misfit else 0.0
    lug, layers = _lug_mesh(eye, sectors)
    pin = _pin_mesh(eye, sectors, shrunk)
    stress, seconds = _solve(_deck(eye, lug, layers, pin), len(lug.nodes))
    return _around(eye, lug, layers, stress, seconds)


def _lug_mesh(eye: PlaneEye, sectors: int) -> tuple[_Mesh, int]:
    """Return the mesh, and the number of layers of a bushing."""
    turn = np.pi * np.arange(2 * sectors) / sectors
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    outside = _outline(eye, sectors)
    wall = float(np.hypot(*outside.T).min())
    size = 2.0 * np.pi * eye.radius / sectors
    inside = [eye.radius * circle]
    start, layers = eye.radius, 0
    if eye.hole:
        inside += _rings(circle, eye.radius, eye.hole, size)
        start, layers = eye.hole, len(inside) // 2
    inside += _rings(circle, start, start + 0.5 * (wall - start), size)
    share = np.linspace(0.0, 1.0, 2 * OUTER_LAYERS + 1)[1:, None, None]
    beyond = inside[-1] + share * (outside - inside[-1])
    mesh = _polar(np.concatenate([np.stack(inside), beyond]))
    return (_split(mesh, layers) if eye.slips else mesh), layers


def _split(mesh: _Mesh, layers: int) -> _Mesh:
    """Return the mesh with separate nodes for the innermost layers."""
    inside = layers * mesh.sectors
    shared = np.intersect1d(mesh.elements[:inside], mesh.elements[inside:])
    number = np.arange(len(mesh.nodes))
    number[shared] = len(mesh.nodes) + np.arange(len(shared))
    elements = np.concatenate([mesh.elements[:inside], number[mesh.elements[inside:]]])
    return _Mesh(np.concatenate([mesh.nodes, mesh.nodes[shared]]), elements, mesh.sectors)


def _rings(circle: Floats, first: float, last: float, size: float) -> list[Floats]:
    """Return circles, and those half-way between them, from one radius to another, which may be
    smaller; the spacing is finest at the first.
    """
    count = 1
    while size * FIRST_LAYER * (GROWTH**count - 1.0) / (GROWTH - 1.0) < abs(last - first):
        count += 1
    s = (GROWTH ** np.arange(count + 1) - 1.0) / (GROWTH**count - 1.0)
    radii = first + (last - first) * s
    both = np.stack([0.5 * (radii[1:] + radii[:-1]), radii[1:]], axis=1).ravel()
    return [r * circle for r in both]


def _outline(eye: PlaneEye, sectors: int) -> Floats:
    """Return the points (2 S, 2) of the outline on rays, two in each sector; the rays nearest to
    corners are moved to them.
    """
    turn = np.pi * np.arange(2 * sectors) / sectors
    for x, y in _corners(eye):
        k = 2 * round(math.atan2(y, x) / (2.0 * np.pi / sectors))
        turn[k % (2 * sectors)] = math.atan2(y, x) % (2.0 * np.pi)
    after = np.append(turn[2::2], 2.0 * np.pi)
    turn[1::2] = 0.5 * (turn[::2] + after)
    return np.stack([_reach(eye, t) * np.array([math.cos(t), math.sin(t)]) for t in turn])


def _corners(eye: PlaneEye) -> list[tuple[float, float]]:
    half = 0.5 * eye.width
    out = [(eye.length, half), (eye.length, -half)]
    if eye.shape == "square":
        return [*out, (-eye.end, half), (-eye.end, -half)]
    if eye.shape == "round" and eye.width < eye.head * (1.0 - 1e-9):
        x = 0.5 * eye.head - eye.end + math.sqrt(0.25 * (eye.head**2 - eye.width**2))
        out += [(x, half), (x, -half)]
    return out


def _reach(eye: PlaneEye, turn: float) -> float:
    """Return the distance from the bore's centre to the outline along a ray."""
    c, s = math.cos(turn), abs(math.sin(turn))
    half = 0.5 * eye.width
    if eye.shape == "square":
        return min(_until(eye.length, c), _until(eye.end, -c), _until(half, s))
    centre, R = 0.5 * eye.head - eye.end, 0.5 * eye.head
    round_head = centre * c + math.sqrt(R * R - (centre * s) ** 2)
    held = _until(eye.length, c)
    if eye.shape == "round":
        shank = min(held, _until(half, s)) if c * _until(half, s) > centre else 0.0
        return min(held, max(round_head, shank))
    # The tangent from the corner (length, half) to the head; `normal` is the angle of its normal
    # from x
    along = eye.length - centre
    normal = math.atan2(half, along) + math.acos(R / math.hypot(along, half))
    side = (R + centre * math.cos(normal)) / max(1e-12, c * math.cos(normal) + s * math.sin(normal))
    beyond_tangent = math.atan2(R * math.sin(normal), centre + R * math.cos(normal)) < math.atan2(
        s, c
    )
    return min(held, round_head if beyond_tangent else side)


def _until(distance: float, slope: float) -> float:
    return distance / slope if slope > 1e-12 else math.inf


def _pin_mesh(eye: PlaneEye, sectors: int, shrunk: float) -> _Mesh:
    """Return the mesh of the disc, moved a little into the loaded side of the bore, so that
    CalculiX finds contact there.

    shrunk: reduction of the bore's radius by the pressing in of a bushing
    """
    radius = eye.radius - SCALE * (0.5 * eye.clearance + shrunk)
    turn = np.pi * np.arange(2 * sectors) / sectors
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    size = 2.0 * np.pi * radius / sectors
    rings = [radius * circle, *_rings(circle, radius, HUB * radius, size)]
    into = 0.5 * eye.clearance + shrunk + PRESSED_IN * eye.force / eye.lug.youngs_modulus
    return _polar(np.stack(rings[::-1]) + SCALE * into * _push(eye))


def _push(eye: PlaneEye) -> Floats:
    """Return the direction of the force on the lug, away from the shank at 0."""
    return -np.array([math.cos(eye.direction), math.sin(eye.direction)])


def _polar(points: Floats) -> _Mesh:
    """Return the mesh on points (2 L + 1, 2 S, 2), the innermost first."""
    rows, columns = points.shape[:2]
    number = np.full((rows, columns), -1)
    used = ~(np.arange(rows)[:, None] % 2 & np.arange(columns) % 2).astype(bool)
    number[used] = np.arange(used.sum())
    low, mid, high = number[:-1:2], number[1::2], number[2::2]
    j = np.arange(0, columns, 2)
    half, next_one = j + 1, (j + 2) % columns
    around = [low[:, j], high[:, j], high[:, next_one], low[:, next_one]]
    middles = [mid[:, j], high[:, half], mid[:, next_one], low[:, half]]
    elements = np.stack([*around, *middles], axis=-1).reshape(-1, 8)
    return _Mesh(points[used], elements, columns // 2)


def _deck(eye: PlaneEye, lug: _Mesh, layers: int, pin: _Mesh | None) -> Iterator[str]:
    """Yield the lines of the deck; without a pin, those of the press fit only."""
    meshes = [lug] if pin is None else [lug, pin]
    numbers = np.cumsum([0, *(len(m.nodes) for m in meshes)])
    yield "*NODE, NSET=ALL"
    for m, first in zip(meshes, numbers, strict=False):
        for k, (x, y) in enumerate(m.nodes, first + 1):
            yield f"{k}, {real(x)}, {real(y)}, 0."
    lined = layers * lug.sectors
    count = len(lug.elements)
    parts = [("LUG", eye.lug, lug.elements[lined:], lined, 0)]
    if eye.bushing:
        parts.append(("BUSHING", eye.bushing, lug.elements[:lined], 0, 0))
    if pin is not None:
        parts.append(("PIN", eye.pin, pin.elements, count, numbers[1]))
    for name, material, elements, before, first in parts:
        yield f"*ELEMENT, TYPE=CPS8, ELSET={name}"
        for k, row in enumerate(elements + first + 1, before + 1):
            yield f"{k}, " + ", ".join(map(str, row))
        yield f"*MATERIAL, NAME=OF{name}"
        yield "*ELASTIC"
        yield f"{real(material.youngs_modulus)}, {real(material.poisson_ratio)}"
        yield "*EXPANSION, ZERO=0."
        strain = SCALE * eye.misfit / (2.0 * eye.hole) if name == "BUSHING" else 0.0
        yield real(strain)
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL=OF{name}"
        yield real(THICKNESS)
    yield "*INITIAL CONDITIONS, TYPE=TEMPERATURE"
    yield "ALL, 0."
    if eye.slips:
        yield from _interface(lug, layers, stiffness(eye))
    if pin is not None:
        yield from _contact(eye, lug, pin, int(numbers[1]))
    yield "*BOUNDARY"
    held = np.flatnonzero(lug.nodes[:, 0] > eye.length * (1.0 - 1e-9))
    yield from (f"{k + 1}, 1, 2" for k in held)
    yield "*STEP"
    yield "*STATIC"
    yield "1., 1."
    if eye.misfit:
        yield "*TEMPERATURE"
        yield "ALL, 1."
    if pin is not None:
        yield "*CLOAD"
        hub = pin.elements[: pin.sectors, 0] + numbers[1] + 1
        for axis, part in enumerate(_push(eye) * SCALE * THICKNESS * eye.force / len(hub), 1):
            if abs(_push(eye)[axis - 1]) > 1e-9:
                yield from (f"{k}, {axis}, {real(part)}" for k in hub)
    yield "*NODE FILE, OUTPUT=2D"
    yield "U"
    yield "*EL FILE, OUTPUT=2D"
    yield "S"
    yield "*END STEP"


def stiffness(eye: PlaneEye) -> float:
    """Return the stiffness of contact, Pa/m."""
    return STIFFNESS * eye.lug.youngs_modulus / (2.0 * eye.radius)


def _interface(lug: _Mesh, layers: int, hard: float) -> Iterator[str]:
    """Yield the lines for the contact of a bushing with its hole."""
    last = layers * lug.sectors
    yield "*SURFACE, NAME=OUTSIDE"
    yield from (f"{k + 1}, S2" for k in range(last - lug.sectors, last))
    yield "*SURFACE, NAME=HOLE"
    yield from (f"{k + 1}, S4" for k in range(last, last + lug.sectors))
    yield "*SURFACE INTERACTION, NAME=FITTED"
    yield "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"
    yield real(hard)
    yield "*CONTACT PAIR, INTERACTION=FITTED, TYPE=SURFACE TO SURFACE"
    yield "OUTSIDE, HOLE"


def _contact(eye: PlaneEye, lug: _Mesh, pin: _Mesh, first: int) -> Iterator[str]:
    count = len(lug.elements)
    yield "*SURFACE, NAME=BORE"
    yield from (f"{k + 1}, S4" for k in range(lug.sectors))
    yield "*SURFACE, NAME=ROUND"
    last = count + len(pin.elements)
    yield from (f"{k + 1}, S2" for k in range(last - pin.sectors, last))
    yield "*SURFACE INTERACTION, NAME=DRY"
    yield "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"
    yield real(stiffness(eye))
    yield "*CONTACT PAIR, INTERACTION=DRY, TYPE=SURFACE TO SURFACE"
    yield "ROUND, BORE"
    weak = WEAK_SPRING * eye.lug.youngs_modulus * THICKNESS
    ends = pin.elements[[0, pin.sectors // 2], 0] + first + 1
    for axis in (1, 2):
        yield f"*ELEMENT, TYPE=SPRING1, ELSET=WEAK{axis}"
        yield from (f"{SPRING_FIRST + 2 * axis + i}, {k}" for i, k in enumerate(ends))
        yield f"*SPRING, ELSET=WEAK{axis}"
        yield f"{axis}"
        yield f"{weak:.10e}"  # CalculiX would read a number without a decimal point as an axis


def _solve(deck: Iterator[str], count: int, quantity: str = "STRESS") -> tuple[Floats, float]:
    """Return a quantity at the first `count` nodes (count, K), and the seconds of the run."""
    with tempfile.TemporaryDirectory(prefix="pinstress-ccx-") as name:
        folder = Path(name)
        (folder / f"{calculix.JOB_NAME}.inp").write_text("\n".join(deck) + "\n", "ascii")
        printed = calculix.run(folder)
        seconds = calculix.seconds_of(printed)
        text = (folder / f"{calculix.JOB_NAME}.frd").read_text("ascii", "replace").splitlines()
    starts = [i for i, line in enumerate(text) if line.startswith(f" -4  {quantity}")]
    values: dict[int, list[float]] = {}
    for line in text[starts[-1] + 1 :]:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            values[int(line[3:13])] = [float(line[i : i + 12]) for i in range(13, len(line), 12)]
    return np.array([values[k + 1] for k in range(count)]), seconds


def _shrinkage(eye: PlaneEye, sectors: int) -> float:
    """Return the reduction of the mean radius of the bore when the bushing is pressed in."""
    lug, layers = _lug_mesh(eye, sectors)
    u, _ = _solve(_deck(eye, lug, layers, None), len(lug.nodes), "DISP")
    bore = lug.elements[: lug.sectors, 0]
    return -float((u[bore, :2] * lug.nodes[bore]).sum(axis=1).mean() / eye.radius / SCALE)


def _around(eye: PlaneEye, lug: _Mesh, layers: int, stress: Floats, seconds: float) -> BoreAnswer:
    bore = lug.elements[: lug.sectors, 0]
    hoop, radial = _polar_stress(lug.nodes[bore], stress[bore])
    hole = np.empty(0)
    if layers:
        at = lug.elements[layers * lug.sectors : (layers + 1) * lug.sectors, 0]
        both = _polar_stress(lug.nodes[at], stress[at])
        hole = both[0] if eye.slips else _of_lug(eye, *both)
    turn = np.arctan2(*lug.nodes[bore].T[::-1]) % (2.0 * np.pi)
    total = -2.0 * np.pi * eye.radius * (radial * np.stack([np.cos(turn), np.sin(turn)])).mean(1)
    if np.abs(total - eye.force * _push(eye)).max() > BALANCE * eye.force:
        raise calculix.CalculixError(f"contact was not found: {total} N/m", "out-of-balance")
    return BoreAnswer(turn, hoop, -radial, hole, seconds)


def _of_lug(eye: PlaneEye, hoop: Floats, radial: Floats) -> Floats:
    """Return the hoop stress of the lug at its bushing, from the mean of lug and bushing, which
    CalculiX writes at their common nodes.
    """
    assert eye.bushing is not None
    E, nu = eye.lug.youngs_modulus, eye.lug.poisson_ratio
    inner, nu_inner = eye.bushing.youngs_modulus, eye.bushing.poisson_ratio
    larger = eye.misfit / (2.0 * eye.hole)  # strain by which the bushing is larger when free
    strain = (2.0 * hoop - (nu + nu_inner) * radial + inner * larger) / (E + inner)
    return E * strain + nu * radial


def _polar_stress(x: Floats, stress: Floats) -> tuple[Floats, Floats]:
    """Return hoop and radial stress, Pa, of stresses at points."""
    c, s = x.T / np.hypot(*x.T)
    xx, yy, xy = stress[:, 0] / SCALE, stress[:, 1] / SCALE, stress[:, 3] / SCALE
    cross = 2.0 * c * s * xy
    return s * s * xx + c * c * yy - cross, c * c * xx + s * s * yy + cross
