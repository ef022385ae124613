"""The results of a pin's joint in a case: loads of its lugs, ranges, and stress of the lugs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated

from pinbase.dimensions import Force, Forces, Length, Lengths, Moments, Stress, Time, Times

LineLoad = Annotated[float, "force length^-1"]
Couple = Annotated[float, "moment"]
FRICTION = "friction"  # a property whose variation can only raise the upper end of a range
TOGETHER = "together"  # several properties at once, each at one end of its range


@dataclass(frozen=True)
class LostFit:
    """A lug whose press fit is lost at the temperature of a case.

    where: the lug and the temperature at which the fit becomes loose, in words.
    given: least interference of the fit, without the change of temperature.
    needed: least interference that would hold, without the change of temperature.
    """

    where: str
    given: Length
    needed: Length


@dataclass(frozen=True)
class BandContact:
    """A band in its lug.

    force: of the link on the pin.
    contact_angle: half of the arc in contact where it is widest, degrees.
    mean_pressure: force over diameter and length.
    line_load: pairs of z and load per length (mean over a ring) in the direction of the force; a
    negative load acts on the other side of the bore.
    couple: reaction of the lug's tilt, a moment on the link.
    clearance, outer_diameter: of the lug.
    ends: z of the rings' ends, one more than there are rings; empty where the load is not given by
    rings.
    friction: coefficient of the lug.
    friction_torque: largest friction torque between pin and lug over all instants; None without
    friction.
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
    """The maximum with a property of the joint changed, or with several.

    what, value: name of the property, and its value or state, in words.
    length: the value if it is a length, the largest if it differs from lug to lug.
    interval: bounds of the maximum with the error of the model, where that is part of the range.
    beneath: largest stress beneath contact (fea.core.places) with the change; None where only the
    maximum is known.
    across: growth of the largest shear force or bending moment, whichever is larger: the value with
    the change over that of the joint as given.
    surface: growth of the largest stress on the free surface.
    lugs: growth of the force on each lug whose force grows.
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
    where variations have an interval.

    Friction only raises the upper end. Its ratio alone is a factor on that end, since it is not
    solved together with the other variations.
    stress: maximum with the joint as given, Pa.
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

    max_von_mises: ends of the range. Friction only raises the upper end, since the stress that it
    takes off while a load grows is not relied on.
    model: "contact", or "foundation", whose error is included.
    assumed: whether the lugs are assumed, since none were given.
    """

    max_von_mises: tuple[Stress, Stress]
    variations: tuple[Variation, ...]
    model: str = "contact"
    assumed: bool = False

    def without(self, what: str, stress: float) -> JointRange:
        """The range without the variations of one property.

        The ratios of the other properties alone are multiplied, since combinations of several
        properties were solved together with this one.
        what: name of the property.
        stress: maximum von Mises stress with the joint as given.
        """
        rest = tuple(x for x in self.variations if x.what not in (what, TOGETHER))
        low = high = 1.0
        for name in dict.fromkeys(x.what for x in rest):
            least, most = range_ends(stress, (x for x in rest if x.what == name))
            low, high = low * least / (stress or 1.0), high * most / (stress or 1.0)
        return replace(self, max_von_mises=(low * stress, high * stress), variations=rest)

    @property
    def across(self) -> float:
        """The growth of the largest shear force or moment, relative to the joint as given."""
        return self._largest("across")

    @property
    def surface(self) -> float:
        """The growth of the largest stress on the free surface, relative to the joint as given.

        Where a section governs, this stress may grow more than the maximum.
        """
        return self._largest("surface")

    def _largest(self, ratio: str) -> float:
        """The largest ratio over the variations; that of friction is a further factor."""
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
        """The growth of the largest force on each lug whose force grows, relative to the joint as
        given.
        """
        # Pairs are sorted, so that the largest ratio of each lug comes last and is kept.
        return dict(sorted(pair for x in self.variations for pair in x.lugs))

    def growth(self, stress: float | None) -> float:
        """The largest growth of the pin's stress, or of a force or moment across it.

        stress: maximum von Mises stress with the joint as given.
        """
        return max(self.across, self.max_von_mises[1] / stress if stress else 1.0, 1.0)


@dataclass(frozen=True)
class LugStress:
    """The largest stress at one wall of a lug, over all instants of a case.

    wall: "bore", "bushing" (its bore) or "hole" (of the lug about a bushing).
    place: "free" where nothing presses on the wall, "beneath" the pin, or beneath a "bushing".
    max_hoop_stress: largest tension along the wall.
    angle: of the largest von Mises stress from the shank, degrees.
    z: of that stress, along the pin.
    time: None without a motion.
    error_estimate: of max_von_mises, the sum of its parts: mesh and sectors (`mesh`), rings through
    the thickness (`rings`), and sampling in time (`sampling`).
    assumed: assumptions where the study states nothing.
    interface: of a pressed bushing in its hole, "bonded" or "frictionless". Friction lies between
    the two, and the interface with the larger stress counts.
    other_interface: stress with the other interface.
    interference: of a bushing whose interference has a range, the value that gives the largest
    stress, at the temperature of the study's dimensions.
    over_joint: growth of the largest stress with its error over the uncertain properties of the
    joint, relative to the joint as given.
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
    """The section forces along the pin at all instants of the case.

    z: of the sections, (Z,).
    times: (T,); None without a motion.
    shear, moment: shear force and bending moment, (T, Z).
    lugs: names of the lugs.
    forces: of the lugs on the pin along x and y, (T, L, 2).
    axial, torque: magnitudes of the axial force and of the torque, (T, Z); None where unknown.
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
    """The results of the pin's joint with its lugs.

    model: "contact", "foundation", or "prescribed", which has only a range.
    bands: the bands in their lugs.
    bending_moment: largest along the pin.
    bending_moments: pairs of z and bending moment.
    range: over the uncertain properties of the joint; None where it was not computed.
    remark: why there is no range, or what the range leaves out.
    along: section forces along the pin at all instants; None for a prescribed joint.
    lugs: stress of the lugs whose shank is known.
    """

    model: str
    bands: tuple[BandContact, ...] = ()
    bending_moment: Couple | None = None
    bending_moments: tuple[tuple[Length, Couple], ...] = ()
    range: JointRange | None = None
    remark: str = ""
    along: JointForces | None = None
    lugs: tuple[LugStress, ...] = ()
