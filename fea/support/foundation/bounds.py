"""Bounds of the stress with contact from the stress of a pin on foundations: the model's error.

If the beam's von Mises stress at a point is s, the stress with contact is taken to lie between

    s (1 - PLAIN_SECTION_ERROR) - k dM    and
    s (1 + PLAIN_SECTION_ERROR + near) + k dM + PRESSURE_FACTOR p

k dM is the bending stress by the error of the moment, a fraction of the largest moment: for the
model (moment_error), and for clearance and rounded edges, which the beam leaves out. near is
NOTCH_ERROR at notches and near sharp shoulders. p = q / d is the pressure of the lug; for a tube it
is multiplied by radius over wall. q is the load per length, but no more than its largest value
farther than EDGE_DISTANCE diameters from the lug's edges, or its mean over the lug if that is
larger. With clearance, p is increased in the ratio of the largest pressures of plane contact.

The bounds are for the row's number with contact, the larger of surface and section
(fea.core.places). The upper bound also holds for the stress beneath contact, which a beam does not
have, so that a pin that is safe by this bound is safe with contact. Both bounds held for all of 77
random pins with two to four lugs, clearance, rounded edges, bores and steps (python -m benchmarks
foundation). There are no bounds for a fillet beside the edge of a lug (FoundationStress.lacking).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fea.beam.error_model import PLAIN_SECTION_ERROR
from fea.core.pin_loads import Floats
from fea.support.foundation.foundation_model import FoundationModel, JointFoundation, moment_error
from fea.support.foundation.plane_contact import largest_pressure
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.lug import Lug

PRESSURE_FACTOR = 0.8  # von Mises stress over the pressure
# Distance from a lug's edge, in diameters, below which the pressure is a peak that is not resolved.
EDGE_DISTANCE = 0.1
# Error of the largest moment, relative, at a clearance of p / E diameters, p being the mean
# pressure. It grows with the square root of the clearance.
CLEARANCE_ERROR = 0.08
MAX_RELATIVE_CLEARANCE = 100.0  # largest measured clearance, in p / E diameters
ROUNDING_ERROR = 2.5  # relative error of the largest moment for an edge radius of one diameter
MAX_EDGE_ROUNDING = 0.05  # largest edge radius, over the diameter


@dataclass(frozen=True)
class StressBounds:
    """The largest von Mises stress on foundations, and its bounds with contact.

    maximum: largest stress, Pa.
    surface: largest stress off the axis, Pa.
    bounds: of the stress with contact, Pa; None where they are not known.
    place: (r, z) of the largest stress, m.
    theta: its angle, rad.
    instant: number of its instant.
    why: reason why the bounds are not known.
    moment_part: relative error of the largest moment; inf where it is not known.
    """

    maximum: float
    surface: float
    bounds: tuple[float, float] | None
    place: tuple[float, float]
    theta: float
    instant: int
    why: str = ""
    moment_part: float = math.inf

    @property
    def error(self) -> float | None:
        """The error that covers both bounds, Pa; None without bounds."""
        if self.bounds is None:
            return None
        return max(self.maximum - self.bounds[0], self.bounds[1] - self.maximum)


def stress_bounds(stress: FoundationStress, joint: JointFoundation) -> StressBounds:
    """The bounds of the largest stress over all instants."""
    top, model = stress.von_mises(joint), stress.model
    point, t = top.place
    s = top.von_mises
    place = float(stress.r[point]), float(stress.z[point])
    surface = float(s[stress.r > 0.0].max())
    out = StressBounds(float(s[point, t]), surface, None, place, float(top.theta[point, t]), t)
    loose = _relative_clearance(model, joint, t)
    part = _moment_part(model, loose)
    lacking = stress.lacking(joint, s)
    if lacking or not math.isfinite(part):
        why = "the size of pin, lugs or clearance is beyond that on which the error was measured"
        if lacking:
            why = f"no notch factor is available for {', '.join(lacking)}"
        return replace(out, why=why)
    z = np.unique(stress.z)
    largest = np.linalg.norm(joint.bending_moment(z), axis=2).max(axis=1)
    moved = np.outer(stress.bending, part * largest)
    pressed, alone = _contact_stress(stress, joint, loose)
    high = (s * (1.0 + PLAIN_SECTION_ERROR + stress.near)[:, None] + moved + pressed).max()
    low = max(0.0, out.maximum * (1.0 - PLAIN_SECTION_ERROR) - float(moved[point, t]))
    return replace(out, bounds=(low, max(float(high), alone)), moment_part=part)


def _diameters(model: FoundationModel) -> Floats:
    return np.array([2.0 * model.whole.band(lug.connection).radius for lug in model.lugs])


def _relative_clearance(model: FoundationModel, joint: JointFoundation, instant: int) -> float:
    """The largest clearance in p / E diameters, p being the largest mean pressure on a band."""
    d = _diameters(model)
    play = max(lug.clearance / x for lug, x in zip(model.lugs, d, strict=True))
    if play == 0.0:
        return 0.0
    lengths = [model.whole.band(lug.connection).length for lug in model.lugs]
    pressure = float((band_forces(joint)[instant] / d / lengths).max())
    return play * model.material.youngs_modulus / pressure if pressure else math.inf


def band_forces(joint: JointFoundation) -> Floats:
    """The magnitude of the force of each lug on the pin, (T, B) N."""
    on_rings = joint.loads.forces[:, : len(joint.bands.z), :2]
    return np.asarray(np.linalg.norm(joint.bands.sums(on_rings), axis=2))


def _moment_part(model: FoundationModel, loose: float) -> float:
    """The relative error of the largest moment; inf where it is not known."""
    part = moment_error(model.given, model.material, model.lugs)
    edges = np.array([lug.edge_radius for lug in model.lugs])
    rounding = float((edges / _diameters(model)).max())
    if loose > MAX_RELATIVE_CLEARANCE or rounding > MAX_EDGE_ROUNDING:
        return math.inf
    return part + CLEARANCE_ERROR * math.sqrt(loose) + ROUNDING_ERROR * rounding


def _contact_stress(
    stress: FoundationStress, joint: JointFoundation, loose: float
) -> tuple[Floats, float]:
    """The stress by contact pressure at the points, (S, T) Pa, and its largest value anywhere.

    loose: clearance in p / E diameters (`_relative_clearance`).
    """
    bands, model = joint.bands, stress.model
    load = np.linalg.norm(joint.line_load, axis=2)  # (T, R)
    pressure = np.concatenate(
        [_of_lug(model, lug, load, bands.band == b) for b, lug in enumerate(model.lugs)], axis=1
    )
    gap = 0.5 * loose / (1.0 - model.material.poisson_ratio**2)
    pressure *= PRESSURE_FACTOR * largest_pressure(gap) / largest_pressure(0.0)
    reach = 0.5 * bands.length + 1e-9 * model.whole.length
    on = np.abs(stress.z[:, None] - bands.z) <= reach
    here = (on[:, None] * pressure).max(axis=2)
    return here, float(pressure.max())


def _of_lug(model: FoundationModel, lug: Lug, load: Floats, on_lug: Floats) -> Floats:
    """The pressure p on the rings of a lug, Pa.

    load: load per length on all rings, (T, R) N/m.
    on_lug: mask (R,) of the lug's rings.
    """
    band = model.whole.band(lug.connection)
    segment = model.whole.segments[model.whole.labels.index(lug.connection)]
    z, length = model.bands.z[on_lug], model.bands.length[on_lug]
    deep = band.length / 2.0 - np.abs(z - band.middle) >= EDGE_DISTANCE * segment.diameter
    mean = load[:, on_lug] @ length / band.length
    most = np.maximum(mean, load[:, on_lug][:, deep].max(axis=1, initial=0.0))
    wall = segment.diameter - segment.bore
    return np.asarray(np.minimum(load[:, on_lug], most[:, None]) / wall)
