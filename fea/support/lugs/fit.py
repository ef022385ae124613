"""Checks that lugs fit a pin, made before anything is computed, and the stress of press fits.

Under interference, pin, bushing and eye are tubes pressed into each other. Each wall follows Lame's
solution with free ends: u = r / E (s_tt - nu s_rr), s_rr, s_tt = A -+ B / r^2. Linear elasticity
does not apply beyond a few times the interference at which one of them yields.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fea.core.equilibrium import Balance, Carried, out_of_balance
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.support.lugs.lug import Lug
from geometry import ArgumentError, Band, Pin, PinLike

MAX_CLEARANCE = 0.1  # of the pin's diameter
MAX_INTERFERENCE_RATIO = 5.0  # times the interference at which pin, bushing or lug yields
MIN_WALL = 1e-3  # least wall of an eye or a bushing, over the pin's diameter

Wall = tuple[float, float, Material]  # inner and outer radius, m, and material


def on_structure(pin: Pin, lugs: Sequence[Lug]) -> Pin:
    """The pin with the bands in lugs of the structure among its connections, by the names of their
    segments.
    """
    held = {lug.connection for lug in lugs} - set(pin.connections)
    if not held:
        return pin
    segments = tuple(
        replace(s, connection=s.name) if s.connection is None and s.name in held else s
        for s in pin.segments
    )
    return replace(pin, segments=segments)


def balance_in_lugs(
    pin: PinLike, lugs: Sequence[Lug], case: PinLoads, density: float | None
) -> Balance:
    """The balance of a case's loads on an unclamped pin, without the loads that its lugs carry."""
    # The lugs of links that state moments react no moment across the axis.
    tilting = case.tilting_links(pin.length)
    structure = sum(lug.connection not in pin.connections for lug in lugs)
    tilts = any(lug.tilt > 0.0 and lug.connection not in tilting for lug in lugs)
    carried = Carried(
        structure > 0, tilts or structure > 1, structure > 0, bool(lugs), bool(tilting)
    )
    return out_of_balance(pin, case, density, carried)


def fitted(
    pin: Pin, material: Material, lugs: Sequence[Lug], in_contact: bool = True
) -> tuple[Lug, ...]:
    """The lugs in the order of the pin's bands, checked to fit them.

    in_contact: whether contact with the lugs is solved. Formulas take any clearance that leaves a
    wall in the eye.

    Raises: ArgumentError for a lug without a band, a band without a lug, or a lug that does not fit
    its band.
    """
    named = {lug.connection: lug for lug in lugs}
    if len(named) < len(lugs) or set(named) != set(pin.connections):
        raise ArgumentError(
            f"pin {pin.name} needs one lug for each of {', '.join(pin.connections)}",
            "lugs-unlike-bands",
        )
    bores = {s.connection: max(s.bores) for s in pin.segments}
    for lug in lugs:
        band = pin.band(lug.connection)
        _require_walls(lug, band)
        _require_gap(lug, band, in_contact)
        if lug.shank is not None:
            lug.outline(band.radius)  # raises an error for contradictory dimensions
        _require_elastic(lug, band, bores[lug.connection] / 2.0, material)
    return tuple(named[connection] for connection in pin.connections)


def _require_walls(lug: Lug, band: Band) -> None:
    d, what = 2.0 * band.radius, f"lug {lug.connection}"
    wall = (lug.outer_diameter - d) / 2.0
    if wall < MIN_WALL * d:
        raise ArgumentError(
            f"{what}: its outer diameter is {lug.outer_diameter / d:.4g} of the pin's; it must be "
            "wider than the pin",
            "lug-too-narrow",
        )
    if lug.bushing is None:
        return
    if lug.bushing.thickness < MIN_WALL * d:
        raise ArgumentError(
            f"{what}: its bushing's thickness is {lug.bushing.thickness / d:.2g} of the pin's "
            "diameter, too thin to model; leave it out",
            "bushing-too-thin",
        )
    if wall - lug.bushing.thickness < MIN_WALL * d:
        raise ArgumentError(
            f"{what}: its bushing is {lug.bushing.thickness / wall:.4g} times as thick as the wall "
            "between the pin and the outer diameter; make it thinner or the lug wider",
            "bushing-too-thick",
        )


def _require_gap(lug: Lug, band: Band, in_contact: bool) -> None:
    what, d = f"lug {lug.connection}", 2.0 * band.radius
    if in_contact and lug.clearance > MAX_CLEARANCE * d:
        raise ArgumentError(
            f"{what}: its clearance is {lug.clearance / d:.3g} of the pin's diameter; at most "
            f"{MAX_CLEARANCE:g} is a joint whose contact can be solved; with joints = "
            '"prescribed", formulas take any',
            "clearance-too-large",
        )
    if not in_contact and lug.outer_diameter - d - lug.clearance < 2.0 * MIN_WALL * d:
        raise ArgumentError(
            f"{what}: with its clearance the bore is {(d + lug.clearance) / d:.4g} of the pin's "
            f"diameter, which leaves a wall of less than {MIN_WALL:g} diameters in the eye",
            "clearance-too-large",
        )
    if lug.edge_radius > band.length / 2.0:
        raise ArgumentError(
            f"{what}: the radius of its edges is {lug.edge_radius / band.length:.3g} of the length "
            "on which it bears; edge_radius may be at most half of that",
            "edge-radius-too-large",
        )


def _require_elastic(lug: Lug, band: Band, bore: float, material: Material) -> None:
    radius = band.radius
    fits = [("its", -lug.clearance, yielding_interference(lug, radius, bore, material))]
    if lug.bushing is not None:
        walls = _walls(lug, radius)
        at_yield = min(_reserve(walls, bushing_press_fit(lug, radius)))
        most = max(x.misfit for x in lug.pressed_bushings())
        fits.append(("its bushing's", most, at_yield))
    for whose, interference, at_yield in fits:
        if interference > MAX_INTERFERENCE_RATIO * at_yield:
            times = interference / at_yield
            raise ArgumentError(
                f"lug {lug.connection}: {whose} interference is {times:.3g} times what makes pin, "
                f"bushing or lug yield; linear elasticity ends at {MAX_INTERFERENCE_RATIO:g} times",
                "interference-too-large",
            )


def yielding_interference(lug: Lug, radius: float, bore: float, material: Material) -> float:
    """The interference on the diameter, m, at which a wall begins to yield (von Mises) without
    other loads; inf where no material has a yield strength.

    radius, bore: outer and bore radius of the pin, m.
    material: of the pin.
    """
    walls = [(bore, radius, material), *_walls(lug, radius)]
    return min(_reserve(walls, _press_fit(walls)))


def press_fit_stresses(
    lug: Lug, radius: float, bore: float, pin: Material
) -> Iterator[tuple[Material, float]]:
    """Yield the material of the pin, of the bushing and of the eye, each with its largest von Mises
    stress, Pa, by the press fits alone.

    The fits are those of the pin in its bore and of the bushing in its hole. Each part is judged at
    the interferences in their ranges that stress it most. In a bushing the two fits relieve each
    other.
    radius, bore: outer and bore radius of the pin, m.

    Source: AFFDL-TR-69-42, 9.16, superposed.
    """
    walls = [(bore, radius, pin), *_walls(lug, radius)]
    pressed = {max(-x, 0.0) for x in (lug.clearance, *(lug.range.clearance or ()))}
    every = [x * _press_fit(walls) for x in pressed]
    if lug.bushing is not None:
        of_bushing = np.vstack([np.zeros(2), bushing_press_fit(lug, radius)])
        every = [x + y.misfit * of_bushing for x in every for y in lug.pressed_bushings()]
    for (inner, _, material), *constants in zip(walls, *every, strict=True):
        yield material, max(_largest(inner, x) for x in constants)


def bushing_press_fit(lug: Lug, radius: float) -> Floats:
    """The constants A and B of s_rr, s_tt = A -+ B / r^2 in a bushing and in the eye around it, (2,
    2), Pa and Pa m^2 per metre of interference on the diameter.
    """
    return _press_fit(_walls(lug, radius))


def _walls(lug: Lug, radius: float) -> list[Wall]:
    """The walls of the lug, and of its bushing, around a band of a radius, m."""
    outer = lug.outer_diameter / 2.0
    if lug.bushing is None:
        return [(radius, outer, lug.material)]
    between = radius + lug.bushing.thickness
    return [(radius, between, lug.bushing.material), (between, outer, lug.material)]


def _reserve(walls: Iterable[Wall], fields: Floats) -> Iterable[float]:
    """Yield inf and, for each wall with a yield strength, the interference at which it yields, m.

    fields: constants A and B for an interference of 1 m.
    """
    yield math.inf
    for (inner, _, material), (a, b) in zip(walls, fields, strict=True):
        if material.yield_strength is not None:
            yield material.yield_strength / _largest(inner, (a, b))


def _largest(inner: float, constants: Sequence[float] | Floats) -> float:
    """The largest von Mises stress in a wall, Pa: sqrt(A^2 + 3 B^2 / r^4) at its inner radius.

    inner: inner radius, m; 0 for a solid pin, where B is 0.
    constants: A and B.
    """
    a, b = constants
    return math.hypot(a, math.sqrt(3.0) * b / inner**2 if inner > 0.0 else 0.0)


def _press_fit(walls: Sequence[Wall]) -> Floats:
    """The constants A and B of s_rr, s_tt = A -+ B / r^2 in tubes inside each other, (walls, 2), Pa
    and Pa m^2.

    The first tube is pressed into the second with an interference of 1 m on the diameter; the
    others are bonded.
    """
    size = 2 * len(walls)
    system, right = np.zeros((size, size)), np.zeros(size)
    inner, outer = walls[0][0], walls[-1][1]
    system[0, :2] = (0.0, 1.0) if inner == 0.0 else (1.0, -1.0 / inner**2)
    system[1, -2:] = 1.0, -1.0 / outer**2
    for k in range(len(walls) - 1):
        r, this_wall = walls[k][1], slice(2 * k, 2 * k + 2)
        next_wall = slice(2 * k + 2, 2 * k + 4)
        system[2 * k + 2, this_wall], system[2 * k + 2, next_wall] = (
            (1.0, -1.0 / r**2),
            (-1.0, 1.0 / r**2),
        )
        system[2 * k + 3, this_wall] = -widening(r, walls[k][2])
        system[2 * k + 3, next_wall] = widening(r, walls[k + 1][2])
    right[3] = 0.5
    scale = np.abs(system).max(axis=0)
    constants = np.linalg.solve(system / scale, right) / scale
    return np.asarray(constants.reshape(-1, 2))


def widening(r: float, material: Material) -> Floats:
    """The factors of A and B in the radial displacement of a tube at a radius r, m."""
    E, nu = material.youngs_modulus, material.poisson_ratio
    return np.array([r * (1.0 - nu) / E, (1.0 + nu) / (E * r)])


def beyond_foundations(pin: Pin, lugs: Iterable[Lug]) -> str:
    """The reason why a beam on foundations cannot represent the joint; empty if it can."""
    if not pin.stepped:
        return f"pin {pin.name} has cones or rounded edges, and its beams have only cylinders"
    for lug in lugs:
        if lug.clearance < 0.0:
            return f"lug {lug.connection} has an interference, whose stress it does not include"
        if lug.bushing is not None:
            return f"lug {lug.connection} has a bushing, for which it has no stiffness"
        if lug.friction:
            return f"lug {lug.connection} has friction, which needs the pressures of contact"
    return ""
