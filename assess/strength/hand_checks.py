"""Hand checks of a pin: shear, bearing and bending.

Nominal stresses of the textbooks from the beam's internal forces (fea.beam.timoshenko) with the
force of each link even over its band, each at the place and the instant where it is largest. With
their strengths: yield in bending, yield over sqrt(3) in shear (von Mises), and yield in bearing.
The last is a convention, and a safe one: a pin whose neighbour holds it in bears more before it is
marked.

Source: R. G. Budynas & J. K. Nisbett, Shigley's Mechanical Engineering Design, 3-10 and 3-11
(bending, transverse shear), 5-5 (distortion energy), 8-12 (shear and bearing of bolts and pins);
ASME BTH-1, Design of Below-the-Hook Lifting Devices, 3-3, has the same for pinned connections.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial

from assess.strength.records import HandCheck
from fea.beam.line_load import acting, shares
from fea.beam.round_section import Circle
from fea.beam.stress import sample
from fea.beam.timoshenko import MOMENT, SHEAR, InternalForces, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from geometry import Pin
from pinbase.arrays import Floats

SHIGLEY = "Budynas & Nisbett, Shigley's Mechanical Engineering Design"
SHIGLEY_JOINTS = f"{SHIGLEY}, 8-12"
BEARING_SOURCE = f"{SHIGLEY_JOINTS}; yield as its strength is a convention"
MEAN_SHEAR_METHOD = "single shear, mean"
NEUTRAL_AXIS_METHOD = "single shear, at the neutral axis"
DOUBLE_SHEAR_METHOD = "double shear, mean"
BEARING_METHOD = "bearing"
BENDING_METHOD = "bending"
MAX_HALF_DIFFERENCE = 0.1  # part of a band's load by which its two sides may differ in double shear


def hand_checks(
    pin: Pin, material: Material, loads: PinLoads, clamps: tuple[str, ...] = ()
) -> tuple[HandCheck, ...]:
    """All checks that apply to a pin clamped at `clamps`, or balanced.

    Raises: as `stepped_beam`.
    """
    forces = stepped_beam(pin, material, acting(loads), clamps)
    c = shares(forces.loads, loads)
    yields = material.yield_strength
    in_shear = yields / math.sqrt(3.0) if yields else None
    cell, z, t, mean = _largest(forces, c, SHEAR)
    section = forces.sections[cell]
    shear = _label(pin, forces, cell), z, _time(loads, t)
    highest, formula = mean * section.vq_it, "V Q / (I t)" if section.inner else "4 V / (3 A)"
    cell, z, t, largest = _largest(forces, c, MOMENT)
    bent = _label(pin, forces, cell), z, _time(loads, t)
    made = (
        HandCheck(
            MEAN_SHEAR_METHOD, *shear, mean, in_shear, "V / A", SHIGLEY_JOINTS, ruptures="shear"
        ),
        HandCheck(NEUTRAL_AXIS_METHOD, *shear, highest, in_shear, formula, f"{SHIGLEY}, 3-11"),
        *_double_shear(pin, forces, c, loads, in_shear),
        *_bearing(pin, loads, yields),
        HandCheck(BENDING_METHOD, *bent, largest, yields, "M c / I", f"{SHIGLEY}, 3-10"),
    )
    return tuple(replace(check, material=material.name) for check in made)


def _time(loads: PinLoads, instant: int) -> float | None:
    return None if loads.times is None else float(loads.times[instant])


def _stress_of(section: Circle, quantity: int) -> float:
    """Pa per N of shear on average, or per N m of moment at the surface."""
    return 1.0 / section.area if quantity == SHEAR else section.outer / section.inertia


def _largest(forces: InternalForces, c: Floats, quantity: int) -> tuple[int, float, int, float]:
    """Cell, z (m), instant and size (Pa) of the largest stress by V or M, whichever its plane.

    c: (T, 2, K) shares of the unit loads. The instant is found by samples, the place then exactly.
    """
    cells, z = sample(forces)
    values = np.einsum("sk,tpk->spt", forces.inside(cells, z)[:, quantity], c)
    per = np.array([_stress_of(s, quantity) for s in forces.sections])
    size = np.hypot(values[:, 0], values[:, 1]) * per[cells, None]
    s, t = np.unravel_index(size.argmax(), size.shape)
    best = int(cells[s]), float(z[s]), int(t), float(size[s, t])
    for cell in forces.free:
        a, b = forces.stations[cell : cell + 2]
        x, y = (Polynomial(forces.coefficients[cell, :, quantity] @ c[t, p]) for p in (0, 1))
        square = x * x + y * y
        for root in square.deriv().trim().roots():
            here = float(root.real)
            if 0.0 < here < b - a:
                value = math.sqrt(max(float(square(here)), 0.0)) * per[cell]
                if value > best[3]:
                    best = cell, float(a) + here, int(t), float(value)
    return best


def _double_shear(
    pin: Pin, forces: InternalForces, c: Floats, loads: PinLoads, strength: float | None
) -> list[HandCheck]:
    """Of every band whose load, when it is largest, goes half to each side."""
    out = []
    for name in dict.fromkeys(loads.surfaces):
        band = pin.band(name)
        left, right = (int(np.abs(forces.stations - z).argmin()) for z in (band.z0, band.z1))
        adjacent = {left - 1, left, right - 1, right}
        if not adjacent <= set(forces.free):
            continue
        ends = forces.inside(np.array([left, right - 1]), np.array([band.z0, band.z1]))
        V = np.einsum("sk,tpk->stp", ends[:, SHEAR], c)
        load = np.linalg.norm(V[0] - V[1], axis=1)
        t = int(load.argmax())
        if load[t] > 0.0 and np.linalg.norm(V[0, t] + V[1, t]) <= MAX_HALF_DIFFERENCE * load[t]:
            area = min(forces.sections[i].area for i in adjacent)
            stress, at = float(load[t]) / (2.0 * area), (band.name, band.middle, _time(loads, t))
            found = HandCheck(
                DOUBLE_SHEAR_METHOD, *at, stress, strength, "F / (2 A)", SHIGLEY_JOINTS
            )
            out.append(replace(found, ruptures="shear"))
    return out


def _bearing(pin: Pin, loads: PinLoads, strength: float | None) -> list[HandCheck]:
    """Of every loaded band: its transverse force over its projected area."""
    out = []
    for i, name in enumerate(loads.surfaces):
        band = pin.band(name)
        size = np.hypot(loads.forces[:, i, 0], loads.forces[:, i, 1])
        t = int(size.argmax())
        if size[t] > 0.0:
            pressure = float(size[t]) / (2.0 * band.radius * band.length)
            at = band.name, band.middle, _time(loads, t)
            found = HandCheck(BEARING_METHOD, *at, pressure, strength, "F / (d L)", BEARING_SOURCE)
            out.append(replace(found, ruptures="bearing"))
    return out


def _label(pin: Pin, forces: InternalForces, cell: int) -> str:
    middle = 0.5 * (forces.stations[cell] + forces.stations[cell + 1])
    return pin.labels[int(np.searchsorted(pin.stations[1:-1], middle, side="right"))]
