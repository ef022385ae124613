"""Results of a pin's joint at the governing instant of a case: loads of its lugs, and the range."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated

from pinbase.dimensions import Force, Forces, Length, Lengths, Moments, Stress, Time, Times

LineLoad = Annotated[float, "force length^-1"]
Couple = Annotated[float, "moment"]
FRICTION = "friction"  # the property of a joint whose range only adds to the stress
TOGETHER = "together"  # several at once, each at the end of its range that counts


@dataclass(frozen=True)
class LostFit:
    """A lug in which a pin is pressed no longer at the temperature of a case.

    where: the lug, with the temperature at which the pin becomes loose in it, in words.
    given, needed: the least interference there, and the least that holds, both without the
    temperature.
    """

    where: str
    given: Length
    needed: Length


@dataclass(frozen=True)
class BandContact:
    """A band in its lug.

    force: of the link on the pin.
    contact_angle: half of the arc in contact, degrees, where it is widest.
    line_load: pairs of z and of the load per length there (mean over a ring) in the direction of
    the force; where it is negative the other side of the bore carries.
    couple: reaction of the lug's tilt, a moment on the link.
    clearance, outer_diameter: of the lug.
    ends: z of the rings' ends, one more than there are rings; empty where load is not given by
    rings.
    mean_pressure: the force over diameter and length.
    friction: coefficient of the lug. friction_torque: the largest torque between pin and lug by it,
    over all instants; None without friction.
    """

    name: str
    force: Force
    contact_angle: float
    mean_pressure: Stress
    line_load: tuple[tuple[Length, LineLoad], ...]
    couple: Couple
    clearance: Length
    outer_diameter: Length
    ends: tuple[Length, ...] = ()
    friction: float = 0.0
    friction_torque: Couple | None = None


@dataclass(frozen=True)
class Variation:
    """The maximum with one property of the joint changed.

    what, value: the property, and its value or state, in words.
    length: the value where it is one, the largest if it differs from lug to lug.
    interval: of the maximum with the error of the model, where that is part of the range.
    beneath: the largest stress beneath the contact then (fea.core.places), None where only the
    maximum is known.
    across: the largest shear force or moment across the pin then, over that of the joint as given,
    whichever grows more. surface: the same of the largest stress on the free surface. lugs: the
    same of the force on each lug whose force grows.
    """

    what: str
    value: str
    max_von_mises: Stress
    length: Length | None = None
    interval: tuple[Stress, Stress] | None = None
    beneath: Stress | None = None
    across: float = 1.0
    surface: float = 1.0
    lugs: tuple[tuple[str, float], ...] = ()


def range_ends(stress: float, variations: Iterable[Variation]) -> tuple[float, float]:
    """The ends of the range of a maximum over variations of the joint, with the error of the model
    where that is a part of them; friction only raises the upper one.

    Friction multiplies by the ratio that it has alone, since it is not solved with the others.
    stress: the maximum with the joint as given.
    """
    ends, rubbed = [stress], [stress]
    for x in variations:
        if x.what == FRICTION:
            rubbed.append(x.max_von_mises)
        else:
            ends += x.interval or (x.max_von_mises,)
    return min(ends), max(ends) * (max(rubbed) / stress if stress else 1.0)


@dataclass(frozen=True)
class JointRange:
    """The range of the maximum over the uncertain properties of the joint.

    max_von_mises: its ends; friction only raises the upper one, since what it takes off the stress
    while a load grows is not relied on.
    model: "contact" or "foundation", whose error is included.
    assumed: whether no lugs were given.
    """

    max_von_mises: tuple[Stress, Stress]
    variations: tuple[Variation, ...]
    model: str = "contact"
    assumed: bool = False

    def without(self, what: str, stress: float) -> JointRange:
        """The range without the variations of one property.

        The others multiply by the ratios that they have alone: together they are solved with it.
        stress: the maximum von Mises stress with the joint as given.
        """
        rest = tuple(x for x in self.variations if x.what not in (what, TOGETHER))
        low = high = 1.0
        for name in dict.fromkeys(x.what for x in rest):
            least, most = range_ends(stress, (x for x in rest if x.what == name))
            low, high = low * least / (stress or 1.0), high * most / (stress or 1.0)
        return replace(self, max_von_mises=(low * stress, high * stress), variations=rest)

    @property
    def across(self) -> float:
        """The largest shear force or moment across the pin, over that of the joint as given."""
        return self._largest("across")

    @property
    def surface(self) -> float:
        """The largest stress on the free surface, over that of the joint as given.

        Where a section governs it may grow more than the maximum does.
        """
        return self._largest("surface")

    def _largest(self, ratio: str) -> float:
        """The largest of the ratios of variations; friction multiplies, as it does the stress."""
        rubbed, others = (
            max(
                (getattr(x, ratio) for x in self.variations if (x.what == FRICTION) is so),
                default=1.0,
            )
            for so in (True, False)
        )
        return max(rubbed, 1.0) * max(others, 1.0)

    @property
    def lugs(self) -> dict[str, float]:
        """The largest force on each lug whose force grows, over that of the joint as given."""
        return dict(sorted(pair for x in self.variations for pair in x.lugs))  # the last counts

    def growth(self, stress: float | None) -> float:
        """The most by which the stress of the pin or a force across it grows.

        stress: the maximum von Mises stress with the joint as given.
        """
        return max(self.across, self.max_von_mises[1] / stress if stress else 1.0, 1.0)


@dataclass(frozen=True)
class LugStress:
    """The largest stress at one wall of a lug, over all instants of a case.

    wall: "bore", "bushing" (its bore) or "hole" (of the lug about a bushing).
    place: "free" where nothing presses on the wall, "beneath" the pin, or beneath a "bushing".
    max_hoop_stress: the largest tension along the wall.
    angle: of the largest von Mises stress from the shank, degrees. z: along the pin. time: None
    without a motion.
    error_estimate: of max_von_mises, the sum of its parts: mesh and sectors, rings through the
    thickness, sampling in time.
    assumed: what the study does not state.
    interface: of a pressed bushing in its hole, "bonded" or "frictionless": friction is between
    the two, and the larger stress counts. other_interface: the stress with the other one.
    interference: of a bushing whose interference has a range, that of the largest stress, at the
    temperature of the study's dimensions.
    over_joint: the largest stress with its error over the uncertain properties of the joint, over
    that of the joint as given.
    """

    connection: str
    wall: str
    place: str
    material: str
    max_von_mises: Stress
    max_hoop_stress: Stress
    angle: float
    z: Length
    time: Time | None
    error_estimate: Stress
    mesh: Stress
    rings: Stress
    sampling: Stress
    yield_strength: Stress | None = None
    assumed: str = ""
    interface: str = ""
    other_interface: Stress | None = None
    interference: Length | None = None
    over_joint: float = 1.0

    @property
    def safety_factor(self) -> float | None:
        """Yield strength over the largest stress; None without a strength."""
        return self.yield_strength / self.max_von_mises if self.yield_strength else None


@dataclass(frozen=True)
class JointForces:
    """The shear force and bending moment (T, Z) across the pin at z (Z,) at all instants of the
    case.

    times: (T,), None without a motion.
    forces: of the lugs on the pin along x and y, (T, L, 2).
    axial, torque: the size of the axial force and of the torque (T, Z); None where they are not
    known to act.
    """

    z: Lengths
    times: Times | None
    shear: Forces
    moment: Moments
    lugs: tuple[str, ...]
    forces: Forces
    axial: Forces | None = None
    torque: Moments | None = None


@dataclass(frozen=True)
class JointResult:
    """The contact of the pin with its lugs.

    model: "contact", "foundation" or "prescribed", with a range alone.
    bending_moment: the largest along the pin; bending_moments: pairs of z and moment.
    range: None where it was not computed.
    remark: why not, or what it leaves out.
    along: the pin at all instants, None for a prescribed joint.
    lugs: the stress of lugs whose shank is known.
    """

    model: str
    bands: tuple[BandContact, ...] = ()
    bending_moment: Couple | None = None
    bending_moments: tuple[tuple[Length, Couple], ...] = ()
    range: JointRange | None = None
    remark: str = ""
    along: JointForces | None = None
    lugs: tuple[LugStress, ...] = ()
