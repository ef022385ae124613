"""Bounds of the stress by contact from that of a pin on foundations: the error of the model.

Where the beam's von Mises stress is s at a point, that of contact is taken to be between

    s (1 - PLAIN) - k dM    and    s (1 + PLAIN + near) + k dM + PRESSURE_FACTOR p

k dM is bending stress by the error of the moment, a part of the largest one: of the model
(moment_error), for clearance and for rounded edges, both of which the beam leaves out. near is
SHOULDER at shoulders. p = q / d, for a tube times radius over wall, is the pressure of the lug
there; q is its load per length, at most that farther than EDGE_DISTANCE diameters from the lug's
edges. With clearance p is larger in the ratio of the largest pressures of plane contact.

What is bounded is the row's number by contact, the larger of surface and section (fea.core.places).
The upper bound holds for what lies beneath contact as well, of which a beam knows nothing: so what
is safe by it is safe by contact. It held for 77 of 77 random pins with two to four lugs, clearance,
rounded edges, bores and steps, the lower one for all, too (python -m benchmarks foundation). There
is none for a fillet beside the edge of a lug (FoundationStress.lacking).
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
# Of the diameter: pressure nearer to a lug's edge is a peak that is not resolved
EDGE_DISTANCE = 0.1
# Of the largest moment, at a clearance of p / E diameters, p the mean pressure
CLEARANCE_ERROR = 0.08
MAX_RELATIVE_CLEARANCE = 100.0  # p / E diameters: what was measured
ROUNDING_ERROR = 2.5  # of the largest moment, per diameter of the edges' radius
MAX_EDGE_ROUNDING = 0.05  # of the diameter


@dataclass(frozen=True)
class StressBounds:
    """The largest von Mises stress, Pa, at (r, z) in m and theta, at the instant of that index.

    surface: the largest off the axis.
    bounds: of the stress with contact; None where they are not known, and `why`.
    moment_part: relative error of the largest moment, inf where it is not known.
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
        """The error that covers both bounds, Pa."""
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
    """The largest clearance, in p / E diameters, p being the mean pressure on the most loaded
    band.
    """
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
    """The stress of contact at the points, (S, T) Pa, and the largest pressure stress of all."""
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
    """The pressure on the lug's own rings by the load per length of all (T, R), Pa.

    on_lug: a mask of the lug's rings.
    """
    band = model.whole.band(lug.connection)
    segment = model.whole.segments[model.whole.labels.index(lug.connection)]
    z, length = model.bands.z[on_lug], model.bands.length[on_lug]
    deep = band.length / 2.0 - np.abs(z - band.middle) >= EDGE_DISTANCE * segment.diameter
    mean = load[:, on_lug] @ length / band.length
    most = np.maximum(mean, load[:, on_lug][:, deep].max(axis=1, initial=0.0))
    wall = segment.diameter - segment.bore
    return np.asarray(np.minimum(load[:, on_lug], most[:, None]) / wall)
