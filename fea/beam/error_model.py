"""A beam's largest von Mises stress with its error.

Where the stress of the beam at a point is s, the stress of elasticity is assumed to lie within

    s (1 +- (PLAIN_SECTION_ERROR + the larger of NOTCH_ERROR at a notch and CLAMP_ERROR within a
    diameter of a clamp
             + CLAMPED_SPAN_ERROR d / length between two clamps)) +- LOCAL_STRESS_FACTOR p

with p the largest sum of nominal pressures on any band: F / (d L) and those of axial forces,
moments and torques, for a tube times radius over wall. The part of a notch covers the error of
Peterson's factors (up to 11 % low in bending, 21 % in tension), that von Mises is 8 to 10 % below
the largest principal stress, and that loads a diameter away affect a shoulder. At a clamped end the
clamp prevents the hoop strain, which lowers von Mises. Between two clamps the moments depend on the
stiffness of the clamps: from built-in to hinged ends the largest moment of a uniform load grows by
half, from w L^2 / 12 to w L^2 / 8.

The five numbers are measured against fine solid models of stubby and slender pins (bands at least
0.35 diameters long), with the largest stress farther than 0.1 diameters from edges of clamps:
docs/method.md has the table. A cosine pressure also bends a tube's wall; its part is that of a free
ring of mean radius R and wall t, which is a bound. With pressure harmonics p_n it has the bending
stress 6 p_n R^2 / ((n^2 - 1) t^2) and the hoop stress p_0 R / t.

Source of the ring: S. P. Timoshenko, Strength of Materials, part II.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.beam.maximum import harmonics, von_mises_maxima
from fea.beam.stress import TZ, ZZ, BeamStress
from fea.beam.timoshenko import InternalForces, Span
from fea.core.pin_loads import PinLoads
from fea.core.tractions import pressure_amplitude
from geometry import Band, Pin
from pinbase.arrays import Floats

# Measured against fine solid models (docs/method.md has the table).
PLAIN_SECTION_ERROR = 0.05
NOTCH_ERROR = 0.12
CLAMP_ERROR = 0.15
CLAMPED_SPAN_ERROR = 0.5
LOCAL_STRESS_FACTOR = 0.8
_MIN_STRESS_SHARE = 1e-6  # of the largest stress: a load that causes less does not act at a notch

BEAM_OMISSIONS = (
    "Beam theory omits local stresses within about a diameter of loads, shoulders and clamps, and "
    "pressures without a resultant; the error estimate includes their measured effect."
)
CLAMP_EDGE_REMARK = " At the edges of clamps no maximum exists."


@dataclass(frozen=True)
class BeamEstimate:
    """A beam's largest von Mises stress with its error, Pa.

    error: None if a notch without a factor is loaded.
    place: (r, z) in m.
    theta: rad.
    instant: its number.
    without_factor: loaded notches for which the beam has no factor; `maximum` then excludes them.
    leaves_out: what the model omits, as text.
    """

    maximum: float
    error: float | None
    place: tuple[float, float]
    theta: float
    instant: int
    without_factor: tuple[str, ...]
    leaves_out: str


def beam_estimate(beam: BeamStress, loads: PinLoads, clamps: tuple[str, ...] = ()) -> BeamEstimate:
    """The largest stress of a case with its error.

    beam: with all unit loads that act.
    clamps: names of its clamped surfaces.

    Raises: ArgumentError when the beam has no field for a part of the loads.
    """
    stress = harmonics(beam, loads)
    maxima = von_mises_maxima(stress)
    point, instant = maxima.place
    largest = float(maxima.von_mises[point, instant])
    unknown = _without_factor(beam, stress, maxima.von_mises, largest)
    local = _local(beam.pin, loads)
    # The error is that of the largest upper estimate, which may be at another point than the
    # maximum.
    upper = maxima.von_mises * (1.0 + _relative(beam))[:, None] + local
    r, z = beam.points[point]
    return BeamEstimate(
        maximum=largest,
        error=None if unknown else float(upper.max()) - largest,
        place=(float(r), float(z)),
        theta=float(maxima.theta[point, instant]),
        instant=instant,
        without_factor=unknown,
        leaves_out=BEAM_OMISSIONS + (CLAMP_EDGE_REMARK if clamps else ""),
    )


def _relative(beam: BeamStress) -> Floats:
    """The relative part of the error at the beam's points, (S,)."""
    z, stations, sections = beam.points[:, 1], beam.forces.stations, beam.forces.sections
    near, between = np.zeros(len(z)), np.zeros(len(z))
    if beam.notches:
        near[-len(beam.notches) :] = NOTCH_ERROR
    for span in beam.forces.spans:
        first, last = stations[span.first], stations[span.last]
        ends = ((first, span.left, span.first), (last, span.right, span.last - 1))
        for edge, clamped, cell in ends:
            if clamped:
                here = np.abs(z - edge) <= 2.0 * sections[cell].outer
                near[here] = np.maximum(near[here], CLAMP_ERROR)
        between[(z >= first) & (z <= last)] = between_clamps(beam.forces, span)
    return np.asarray(PLAIN_SECTION_ERROR + near + between)


def between_clamps(forces: InternalForces, span: Span) -> float:
    """The relative error of moments in a span between two clamps; 0 in any other span."""
    if not (span.left and span.right):
        return 0.0
    thickest = 2.0 * max(s.outer for s in forces.sections[span.first : span.last])
    return CLAMPED_SPAN_ERROR * min(
        1.0, thickest / float(forces.stations[span.last] - forces.stations[span.first])
    )


def _local(pin: Pin, loads: PinLoads) -> Floats:
    """The local stress (T,), Pa, that loads may add where they act."""
    most = np.zeros(len(loads))
    for c, name in enumerate(loads.surfaces):
        band = pin.band(name)
        (x, y, z), (mx, my, mz) = loads.forces[:, c].T, loads.moments[:, c].T
        d, length = 2.0 * band.radius, band.length
        # Nominal pressures of transverse and axial forces, moments and torques on the band.
        across = np.hypot(x, y) / (d * length)
        tractions = np.abs(z) / (np.pi * d * length) + 2.0 * np.abs(mz) / (np.pi * d * d * length)
        here = (
            LOCAL_STRESS_FACTOR
            / _wall(pin, band)
            * (across + 6.0 * np.hypot(mx, my) / (d * length**2) + tractions)
        )
        if loads.distribution == "cosine":
            here = here + np.hypot(x, y) * _ovalisation(pin, band, loads)
        most = np.maximum(most, here)
    return most


def _wall(pin: Pin, band: Band) -> float:
    """The wall thickness over the outer radius; 1 for a solid section."""
    segment = pin.segments[pin.labels.index(band.name)]
    return 1.0 - max(segment.bores) / segment.diameter


def _ovalisation(pin: Pin, band: Band, loads: PinLoads) -> float:
    """The stress (Pa per N) of a ring under the harmonics of cosine pressure that a beam omits."""
    t = _wall(pin, band) * band.radius
    R = band.radius - 0.5 * t
    out = abs(pressure_amplitude(0, band)) * R / t
    for n in loads.pressures:
        if n > 1:
            out += abs(pressure_amplitude(n, band)) * 6.0 * (R / t) ** 2 / (n * n - 1.0)
    return out


def _without_factor(
    beam: BeamStress, stress: Floats, von_mises: Floats, largest: float
) -> tuple[str, ...]:
    """The descriptions of notches whose factor is missing for a load that acts there.

    stress: (3, S, 6, T) Pa, as from fea.beam.maximum.harmonics.
    von_mises: (S, T) Pa.
    largest: Pa, the largest von Mises stress.
    """
    out = []
    least = _MIN_STRESS_SHARE * largest
    first = len(beam.points) - len(beam.notches)
    for i, notch in enumerate(beam.notches, first):
        acting = (
            (notch.bending, np.hypot(stress[1, i, ZZ], stress[2, i, ZZ])),
            (notch.tension, stress[0, i, ZZ]),
            (notch.torsion, stress[0, i, TZ]),
        )
        lacking = any(factor is None and np.abs(s).max() > least for factor, s in acting)
        none = notch.bending is notch.tension is notch.torsion is None
        if lacking or (none and von_mises[i].max() > least):
            out.append(notch.why)
    return tuple(dict.fromkeys(out))
