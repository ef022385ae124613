"""A second opinion on a pin in its lugs: CalculiX solves the contact at the governing instant on
two meshes. The load per length, the largest bending moment, and the stress at our maximum (of the
surface or of a section) are compared with ours.

CalculiX has its own meshes, which cause most of the differences. The change from the coarser to the
finer mesh shows how much of the differences they explain.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from assess.opinion.calculix import CalculixError
from assess.opinion.calculix_joint import joint_opinion, plane_of
from assess.opinion.calculix_joint_answer import JointOpinion
from assess.opinion.calculix_joint_mesh import Fineness
from assess.opinion.calculix_row import section_of
from assess.opinion.opinions import BandOpinion, ContactOpinion, Opinion
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import Floats, PinLoads
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.links import link_forces, link_moments
from fea.support.lugs.lug import Lug
from fea.support.records import BandContact, JointResult
from geometry import ArgumentError, Pin

Meshes = tuple[Fineness, Fineness]
HALF_MODEL_MESHES = (
    Fineness(rings=4, sectors=16, eye=2),
    Fineness(rings=6, sectors=24, layers=3, eye=2),
)
FULL_MODEL_MESHES = Fineness(rings=4, sectors=8, eye=1), Fineness(rings=6, sectors=16, eye=2)
MAX_OMITTED_FORCE = 1e-3  # relative to the largest force: loads that CalculiX's model may omit
MIN_BAND_FORCE = 1e-6  # relative to the largest force of a band: smaller bands are not compared
MOMENT_STATION_COUNT = 401  # stations at which the largest bending moment is sought


@dataclass(frozen=True)
class PinInLugs:
    """A pin in its lugs."""

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]

    @property
    def whole(self) -> Pin:
        """The pin with bands also for the lugs of a structure."""
        return on_structure(self.pin, self.lugs)


def opinion_in_lugs(
    seated: PinInLugs,
    peak: Maximum,
    joint: JointResult,
    progress: Callable[[str], None] = lambda _: None,
    meshes: Meshes | None = None,
) -> Opinion:
    """Return CalculiX's opinion on a load case with a peak and a joint solution, or an opinion with
    the reason why the comparison failed.
    """
    answer = Opinion(peak.pin, peak.case, peak.max_von_mises, peak.own_error)
    try:
        loads = transverse(seated, peak.governing)
        opinions = []
        for number, mesh in enumerate(meshes or meshes_for(loads), 1):
            progress(f"pin {peak.pin}, {peak.case}, contact by CalculiX, mesh {number} of 2")
            opinions.append(joint_opinion(seated.whole, seated.material, seated.lugs, loads, mesh))
    except (ArgumentError, CalculixError, SolveError) as error:
        return replace(answer, failure=str(error))
    return _compared(answer, seated, peak, joint, opinions)


def transverse(seated: PinInLugs, governing: PinLoads | None) -> PinLoads:
    """Return the transverse forces and moments of the links, in balance with the reactions of a
    structure.

    Raises: ArgumentError for loads or joints that CalculiX's model lacks; SolveError for unbalanced
    forces.
    """
    _require_modelled(seated)
    assert governing is not None
    loads, largest = governing, float(np.abs(governing.forces[..., :2]).max())
    weight = (seated.material.density or 0.0) * seated.pin.volume
    for what, size in (
        ("forces along the axis", np.abs(loads.forces[..., 2]).max()),
        ("torques", np.abs(loads.moments[..., 2]).max() / seated.pin.smallest_diameter),
        ("weight and inertia of the pin", weight * np.abs(loads.body).max()),
    ):
        if size > MAX_OMITTED_FORCE * largest:
            raise ArgumentError(f"CalculiX's model has no {what}", "other-loads")
    across, tilting = np.array([1.0, 1.0, 0.0]), loads.tilting_links(seated.pin.length)
    plain = PinLoads(
        loads.case, loads.surfaces, loads.forces * across, loads.moments * across, tilting=tilting
    )
    pin, whole = seated.pin, seated.whole
    lugs, links = fitted(whole, seated.material, seated.lugs), pin.connections
    force = link_forces(pin, 0.0, plain, structure=len(lugs) > len(links))
    moment = link_moments((pin, whole), lugs, plain, force, (0.0, 0.0))
    of_links = [whole.connections.index(name) for name in links]
    loaded = force[:, : len(links)], moment[:, of_links]
    forces, moments = (np.pad(x, ((0, 0), (0, 0), (0, 1))) for x in loaded)
    return PinLoads(loads.case, links, forces, moments, tilting=tilting)


def _require_modelled(seated: PinInLugs) -> None:
    tight = [lug.connection for lug in seated.lugs if lug.clearance < 0.0]
    if tight:
        raise ArgumentError(
            f"CalculiX's model has no interference ({', '.join(tight)})", "interference"
        )


def meshes_for(loads: PinLoads) -> Meshes:
    """Return the coarser and the finer mesh, as fine as can be solved in minutes."""
    # A moment acts in the plane of the forces that cause it, perpendicular to its vector.
    largest = np.abs(loads.forces).max(initial=0.0) / (np.abs(loads.moments).max() or 1.0)
    turning = largest * loads.moments[0][:, [1, 0]] * [1.0, -1.0]
    _, half = plane_of(np.concatenate([loads.forces[0, :, :2], turning]))
    return HALF_MODEL_MESHES if half else FULL_MODEL_MESHES


def _compared(
    answer: Opinion,
    seated: PinInLugs,
    peak: Maximum,
    joint: JointResult,
    opinions: Sequence[JointOpinion],
) -> Opinion:
    assert joint.bending_moment is not None  # contact has one
    pin = seated.whole
    moments = [largest_moment(x, pin) for x in opinions]
    stresses = [_stress(x, seated, peak) for x in opinions]
    coarse, fine = opinions
    least = MIN_BAND_FORCE * max(band.force for band in joint.bands)
    contact = ContactOpinion(
        tuple(_band(pin, b, fine) for b in joint.bands if b.ends and b.force > least),
        joint.bending_moment,
        moments[1],
        coarse.unknowns,
        moments[1] / moments[0] - 1.0,
        stresses[1] / stresses[0] - 1.0,
        fine.appended,
    )
    return replace(answer, unknowns=fine.unknowns, theirs=stresses[1], contact=contact)


def _stress(opinion: JointOpinion, seated: PinInLugs, peak: Maximum) -> float:
    """Return CalculiX's stress for our maximum, Pa.

    If our maximum is on the surface, this is CalculiX's stress at the same point; otherwise the
    largest section stress by the forces of CalculiX's rings.
    """
    if peak.places is not None and peak.places.governs == "section":
        return section_of(opinion, seated.whole, seated.material).value
    assert peak.location is not None
    return opinion.surface_at(np.array(peak.location), seated.material.poisson_ratio)


def largest_moment(opinion: JointOpinion, pin: Pin) -> float:
    """Return the largest bending moment along the pin, N m."""
    z = np.linspace(0.0, pin.length, MOMENT_STATION_COUNT)
    return float(np.linalg.norm(opinion.bending_moment(z), axis=1).max())


def _band(pin: Pin, ours: BandContact, theirs: JointOpinion) -> BandOpinion:
    """Return the load per length of both programs, ours averaged over CalculiX's rings."""
    band = pin.band(ours.name)
    tiny = 1e-9 * pin.length
    within = (theirs.ends[:, 0] > band.z0 - tiny) & (theirs.ends[:, 1] < band.z1 + tiny)
    ends = np.append(theirs.ends[within, 0], theirs.ends[within, 1].max())
    total = theirs.force[within].sum(axis=0)
    line = theirs.line_load[within] @ total / np.linalg.norm(total)
    our_load = _mean(np.array(ours.ends), np.array([load for _, load in ours.line_load]), ends)
    lists: list[list[float]] = [x.tolist() for x in (ends, our_load, line)]
    return BandOpinion(ours.name, *(tuple(x) for x in lists))


def _mean(ends: Floats, load: Floats, onto: Floats) -> Floats:
    """Return the means of a piecewise constant load over other intervals, (P,).

    ends: (R + 1,) ends of the pieces. load: (R,). onto: (P + 1,) ends of the other intervals.
    """
    sums = np.concatenate([[0.0], np.cumsum(load * np.diff(ends))])
    return np.asarray(np.diff(np.interp(onto, ends, sums)) / np.diff(onto))
