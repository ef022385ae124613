"""Finer and finer meshes until the maximum is known to the tolerance, or cannot be."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fea.balance import Balance, out_of_balance
from fea.envelope import Envelope, envelope
from fea.linear import SolveError
from fea.material import Material
from fea.peak import Peak, Refinement, Verdict, discretisation_error
from fea.pin_loads import PinLoads, UnitLoad
from fea.sharp_edges import sharp_edges
from fea.solid import SolidModel, UnitFields, acting
from geometry import CutPin, Pin, PinLike, sharp_corners
from geometry.meshing import solid_mesh
from geometry.pin import FACES
from geometry.solid_mesh import MeshSize

STEP = 2.0**0.5  # from one mesh to the next
HALF = 2.0  # the same where the mesh is given
FEWEST = 3  # meshes before a maximum may be called converged: two can agree by chance
MOST_UNKNOWNS = 300_000
NEAR = 0.1  # of the local diameter: a peak this close to a sharp place is that place's
TELL = 1e-6  # of the largest load: what bands take up to close the balance is told from here on


Found = list[tuple[Refinement, UnitFields, Envelope]]  # one entry per mesh


@dataclass(frozen=True)
class Solution:
    """A peak with the fields from which it came: those of the finest mesh."""

    peak: Peak
    fields: UnitFields | None
    envelope: Envelope | None


def refine(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    tolerance: float,
    size: MeshSize | None = None,
    meshes: int = 4,
    progress: Callable[[str], None] = lambda _: None,
) -> tuple[Solution, ...]:
    """Solutions of a pin's cases, one each, all on the same meshes.

    clamps: surfaces (by the pin's names) that are held. Stops when every case's estimated error is
    within `tolerance` of its maximum on FEWEST meshes or more, when the peaks that remain sit at
    places where none exists, after `meshes` meshes, or before more than MOST_UNKNOWNS unknowns.

    Raises: MeshError, SolveError.
    """
    held = tuple(pin.surface(name) for name in clamps)
    balances = {} if held else {c.case: out_of_balance(pin, c, material.density) for c in cases}
    refused = {case: b.refusal for case, b in balances.items() if b.refusal}
    live = tuple(c for c in cases if c.case not in refused)
    found: dict[str, Found] = {c.case: [] for c in live}
    ratio = HALF if pin.meshed else STEP
    for level in range(meshes if live else 0):
        if level and _unknowns(found) * ratio**3 > MOST_UNKNOWNS:
            break
        progress(f"pin {pin.name}, mesh {level + 1}")
        start = time.perf_counter()
        fields = _unit_fields(pin, material, held, live, (size or MeshSize()).finer(ratio**level))
        for case in live:
            top = envelope(fields, case)
            spent = time.perf_counter() - start
            step = Refinement(fields.space.unknowns, top.maximum, spent)
            found[case.case].append((step, fields, top))
        if level and not any(_worth_refining(pin, held, found[c.case], tolerance) for c in live):
            break
    return tuple(
        Solution(Peak(pin.name, c.case, "solid", "rigid", refused[c.case]), None, None)
        if c.case in refused
        else _judge(pin, held, c.case, found[c.case], tolerance, balances.get(c.case))
        for c in cases
    )


def _unknowns(found: dict[str, Found]) -> int:
    return max(steps[-1][0].dofs for steps in found.values())


def _unit_fields(
    pin: PinLike,
    material: Material,
    held: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    size: MeshSize,
) -> UnitFields:
    """Unit fields for all that the cases load; the mesh is finer at edges of bands and clamps."""
    names = tuple(dict.fromkeys(name for c in cases for name in c.surfaces))
    edges = tuple(z for name in names for z in (pin.band(name).z0, pin.band(name).z1))
    profile = pin.profile if isinstance(pin, CutPin) else pin
    if isinstance(profile, Pin):
        turned = tuple(name for name in held if name in (*FACES, *profile.labels))
        edges += tuple(z for _, z in clamp_edges(profile, turned))
    mesh = solid_mesh(pin, size, tuple(dict.fromkeys(edges)))
    units = acting(cases)
    units = units or ((UnitLoad(names[0], "force", 1), 0),)  # of which there is nought
    return SolidModel(pin, mesh, material, held).solve(units)


def _closing(pin: PinLike, balance: Balance | None) -> str:
    """What the bands take up beside the loads, as the end of a note; empty when nothing."""
    if balance is None or not balance.largest:
        return ""
    force = balance.force / balance.largest
    couple = balance.couple / balance.largest / pin.length
    if max(force, couple) < TELL:
        return ""
    return (
        f"; its bands close the balance, a force of {force:.2g} of the largest load and a couple "
        f"of {couple:.2g} of that times the length"
    )


def clamp_edges(pin: Pin, clamps: tuple[str, ...]) -> tuple[tuple[float, float], ...]:
    """Rims (r, z) of the held surfaces, m: stresses there have no bound either."""
    rims = []
    faces = {"start": (pin.segments[0], 0.0), "end": (pin.segments[-1], pin.length)}
    for name in clamps:
        if name in faces:
            segment, z = faces[name]
            rims += [(d / 2, z) for d in (segment.diameter, segment.bore) if d]
        else:
            band = pin.band(name)
            rims += [(band.radius, band.z0), (band.radius, band.z1)]
    return tuple(rims)


def sharp_place(
    pin: Pin, clamps: tuple[str, ...], location: tuple[float, float, float]
) -> str | None:
    """What makes a maximum at `location` meaningless: a sharp corner or a clamp's edge nearby."""
    r, z = float(np.hypot(location[0], location[1])), location[2]
    places = [(c.r, c.z, "a sharp inner corner") for c in sharp_corners(pin)]
    places += [(a, b, "the edge of a clamp") for a, b in clamp_edges(pin, clamps)]
    near = [(float(np.hypot(r - a, z - b)), a, what) for a, b, what in places]
    if not near:
        return None
    distance, radius, what = min(near)
    return what if distance <= NEAR * 2.0 * radius else None


def _history(found: Found) -> tuple[Refinement, ...]:
    return tuple(step for step, _, _ in found)


def _place(pin: PinLike, held: tuple[str, ...], found: Found) -> str | None:
    """What makes the last mesh's maximum meaningless, if anything does."""
    _, fields, top = found[-1]
    if isinstance(pin, Pin):
        return sharp_place(pin, held, top.location)
    return sharp_edges(fields.space, fields.surface, held).near(top.location, NEAR)


def _error(pin: PinLike, found: Found) -> float:
    """Of the last mesh, Pa."""
    top = found[-1][2]
    if len(found) == 1:
        return top.maximum
    return discretisation_error(_history(found), HALF if pin.meshed else STEP, top.scatter)


def _worth_refining(pin: PinLike, held: tuple[str, ...], found: Found, tolerance: float) -> bool:
    top = found[-1][2]
    if _place(pin, held, found) is not None:
        return False
    return len(found) < FEWEST or _error(pin, found) > tolerance * top.maximum


def _judge(
    pin: PinLike,
    held: tuple[str, ...],
    case: str,
    found: Found,
    tolerance: float,
    balance: Balance | None,
) -> Solution:
    history = _history(found)
    _, fields, top = found[-1]
    if not np.isfinite(top.maximum):
        raise SolveError(f"pin {pin.name}, case {case}: the stress is not finite")
    error = _error(pin, found)
    relative = error / top.maximum if top.maximum else 0.0
    place = _place(pin, held, found)
    verdict: Verdict = "unconverged"
    if place and top.maximum:
        note = f"the peak sits at {place}, where it grows with every mesh"
    elif relative <= tolerance and len(history) >= FEWEST:
        verdict, note = "converged", f"known to {relative:.1%}"
    elif len(history) == 1 and pin.meshed:
        note = (
            "from one mesh only: halving the file's would be too large, so the error is not known"
        )
    else:
        note = f"known to {relative:.1%} only, {tolerance:.1%} was asked for"
    peak = Peak(
        pin=pin.name,
        case=case,
        model="solid",
        verdict=verdict,
        note=note + _closing(pin, balance),
        max_von_mises=top.maximum,
        error_estimate=error,
        location=top.location,
        instant=top.instant,
        history=history,
    )
    return Solution(peak, fields, top)
