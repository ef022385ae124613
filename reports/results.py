"""What a run found, as plain data in the study's own units: all that reports are made from."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from reports.surface import Surface

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Units:
    """Names of the units in which everything here is given."""

    length: str
    force: str
    stress: str
    time: str


@dataclass(frozen=True)
class MeshStep:
    """One mesh of a refinement: unknowns, maximum, seconds."""

    dofs: int
    max_von_mises: float
    seconds: float


@dataclass(frozen=True)
class SingularZone:
    """A place where stress grows without bound as the mesh gets finer.

    location: x, y, z in the pin's axes of the point of that circle where stress is largest. kind:
    "a sharp corner", "the edge of a clamp" or "the edge of a load". between: surfaces that meet
    there. exponent: stress grows as distance^-exponent, measured, and by theory (0: like a
    logarithm); None where unknown. excluded: radius about it in which no stress is read. governs:
    whether it would be the maximum. max_von_mises: largest inside on the finest mesh, which says
    nothing but that. advice: what would make the stress finite.
    """

    location: tuple[float, float, float]
    kind: str
    between: tuple[str, str]
    exponent: float | None
    exponent_theory: float | None
    excluded: float
    governs: bool
    max_von_mises: float
    advice: str


@dataclass(frozen=True)
class HandCheck:
    """A check by hand: `name` ("bending", "single shear", ..) `at` a place, largest over the case:
    stress against strength, their ratio (None without a yield strength), formula and source.
    """

    name: str
    at: str
    time: float | None
    stress: float
    strength: float | None
    factor: float | None
    formula: str
    source: str


@dataclass(frozen=True)
class PinResult:
    """One pin in one case. Numbers are None for `rigid` and `failed`, time without a motion.

    location: x, y, z in the pin's own axes. held: what holds the pin, in words. left_out: given
    forces that were not applied because their band is held. published_*: the publication's value.
    why: which model answered and why it was enough. singular_at: places without a maximum; where
    one governs (verdict `singular`) maximum, error and factor are those outside all of them, as are
    those of the history.
    """

    pin: str
    case: str
    model: str
    verdict: str
    note: str
    max_von_mises: float | None
    error_estimate: float | None
    location: tuple[float, float, float] | None
    time: float | None
    position: float | None
    safety_factor: float | None
    yields: bool | None
    meets_required: bool | None
    dofs: int
    seconds: float
    history: tuple[MeshStep, ...]
    held: str
    left_out: tuple[str, ...] = ()
    published_max_von_mises: float | None = None
    published_safety_factor: float | None = None
    why: str = ""
    singular_at: tuple[SingularZone, ...] = ()
    hand_checks: tuple[HandCheck, ...] = ()


@dataclass(frozen=True)
class PeakReaction:
    """A connection's largest force along a motion and when, refined between the instants."""

    connection: str
    force: float
    time: float


@dataclass(frozen=True)
class ReactionTable:
    """One case's forces on the pins, world axes: forces, moments (T, C, 3).

    times, position (T,): None without a motion. pins: (C,) the pin on which each connection bears.
    shared: connections whose forces follow the study's sharing rule. published: magnitudes by
    connection. note: how the case came about (an impulse estimate, say). peaks: along a motion, of
    every connection. turn: (T, C) rad, how far each pin's own axes are turned about z.
    position_unit: of `position`; the study's length where empty.
    """

    case: str
    times: Floats | None
    position: Floats | None
    connections: tuple[str, ...]
    bodies: tuple[str, ...]
    pins: tuple[str, ...]
    forces: Floats
    moments: Floats
    shared: tuple[str, ...] = ()
    published: dict[str, float] = field(default_factory=dict)
    note: str = ""
    peaks: tuple[PeakReaction, ...] = ()
    turn: Floats | None = None
    position_unit: str = ""

    @property
    def magnitudes(self) -> Floats:
        """(T, C)."""
        return np.asarray(np.linalg.norm(self.forces, axis=2))


@dataclass(frozen=True)
class DriveTable:
    """One drive along a motion, all (T,): a slider's length and force, or (kind "rotary") an angle
    in degrees with its rates in rad and the torque. Energies and work in force x length; the
    energies are the whole linkage's.
    """

    case: str
    time: Floats
    position: Floats
    velocity: Floats
    acceleration: Floats
    force: Floats
    power: Floats
    work: Floats
    kinetic_energy: Floats
    potential_energy: Floats
    name: str = ""
    kind: str = "slider"

    @property
    def mean(self) -> float:
        """Mean force or torque over the time; what is only rounding is zero."""
        mean = float(np.trapezoid(self.force, self.time) / np.ptp(self.time))
        return mean if abs(mean) > 1e-12 * float(np.abs(self.force).max()) else 0.0

    @property
    def rms(self) -> float:
        """Root of the mean square of the force or torque over the time."""
        return float(np.sqrt(np.trapezoid(self.force**2, self.time) / np.ptp(self.time)))


@dataclass(frozen=True)
class PowerLedger:
    """Who puts power in, (T,) each: drives, gravity, applied loads, friction (never positive)
    against the rate of kinetic energy. violation: the largest difference over the largest term.
    """

    drives: Floats
    gravity: Floats
    applied: Floats
    friction: Floats
    kinetic_rate: Floats
    violation: float


@dataclass(frozen=True)
class LinkageMotion:
    """How a linkage moves in one case: T instants (one, without time, when it is held).

    links: for each of B bodies the joints on it, in the order to draw them. centre, velocity,
    acceleration: (T, B, 2) of the centres of mass. angle: (T, B) direction from the body's first
    joint to its second, degrees counter-clockwise from x, without jumps (NaN for a particle);
    angular_velocity, angular_acceleration: (T, B) in rad. joints: J names; joint_position,
    joint_velocity, joint_acceleration: (T, J, 2). ground: joints that stand still. slides: by
    slider, its two ends (T, 2, 2). connections: (name, body, joint) in the order of the case's
    ReactionTable. transmission: by link and joint, (T,) degrees, 90 is best, 0 is a dead point.
    condition: (T,) of the loop equations. shaking_force (T, 2), shaking_moment (T,): of the linkage
    on its ground, the moment about the joint `shaking_about`. slider_forces: by slider
    (T, 3), of the base on the moving body: normal (left of the axis), couple about the slider's
    end, friction along the axis.
    """

    case: str
    time: Floats | None
    bodies: tuple[str, ...]
    links: tuple[tuple[str, ...], ...]
    centre: Floats
    velocity: Floats
    acceleration: Floats
    angle: Floats
    angular_velocity: Floats
    angular_acceleration: Floats
    joints: tuple[str, ...]
    ground: tuple[str, ...]
    joint_position: Floats
    joint_velocity: Floats
    joint_acceleration: Floats
    slides: dict[str, Floats]
    connections: tuple[tuple[str, str, str], ...]
    transmission: dict[str, Floats]
    condition: Floats
    shaking_force: Floats
    shaking_moment: Floats
    shaking_about: str
    ledger: PowerLedger
    slider_forces: dict[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True)
class BeamCheck:
    """Beam theory beside the solid's axial stress on a cantilever pin's tension line, along z.

    band: z-range of the load. rms, largest: difference of the surface load's stress from the beam's
    between 30 and 80 % of the loaded length, over the beam's peak; largest_at: z of the largest
    anywhere. expected_offset: what exact elasticity adds to beam theory there (a stress);
    *_beyond_offset: the rms once that is added.
    """

    pin: str
    case: str
    connection: str
    force: float
    diameter: float
    axis_bore: float
    band: tuple[float, float]
    z: Floats
    shear: Floats
    moment: Floats
    beam_axial_stress: Floats
    fea_axial_stress: Floats
    fea_axial_stress_axis_load: Floats
    rms: float
    rms_axis_load: float
    expected_offset: float
    expected_offset_axis_load: float
    rms_beyond_offset: float
    rms_axis_load_beyond_offset: float
    largest: float
    largest_axis_load: float
    largest_anywhere: float
    largest_at: float


@dataclass(frozen=True)
class MotionCheck:
    """Speed and acceleration magnitude of a joint, from the linkage and in closed form, (T,);
    published: rows of time, speed, acceleration with ours at that time (time, v, a, our v, our a).
    """

    joint: str
    case: str
    time: Floats
    speed: Floats
    acceleration: Floats
    closed_form_speed: Floats
    closed_form_acceleration: Floats
    published: tuple[tuple[float, float, float, float, float], ...]


@dataclass(frozen=True)
class LandingRange:
    """One pin over the ranges of a landing's impulse, (P,) pairs each: impulse time, velocity
    change, force, maximum von Mises and factor of safety (None without a yield strength). nominal:
    the pair of the case itself. verdict: of the case, which holds for all pairs.
    """

    pin: str
    case: str
    impulse_time: Floats
    velocity_change: Floats
    force: Floats
    max_von_mises: Floats
    safety_factor: Floats | None
    nominal: tuple[float, float]
    verdict: str


@dataclass(frozen=True)
class LegTable:
    """The dynamics of a spatial leg: vectors (T, 3) and scalars (T,) by name with their units;
    axes: of the components.
    """

    case: str
    time: Floats
    vectors: dict[str, tuple[Floats, str]]
    scalars: dict[str, tuple[Floats, str]]
    axes: str


@dataclass(frozen=True)
class PublishedValue:
    """A published number with ours: of a `quantity` of what is called `name` in a case (at a time,
    or None), in `unit`; reason: why they differ.
    """

    case: str
    time: float | None
    quantity: str
    name: str
    ours: float
    published: float
    unit: str
    reason: str


@dataclass(frozen=True)
class Field:
    """A mesh with results at its nodes: points (N, 3), cells (M, 10; VTK's order of "tetra10") or
    (M, 4; "quad": the surface alone), displacement (N, 3), stress (N, 6: xx, yy, zz, yz, xz, xy),
    von_mises (N,), and envelope (N,): the largest von Mises over all instants at surface nodes, NaN
    inside. yield_strength: for the factor of safety at each point, None without one. outside: of a
    `singular` pin the largest stress outside the excluded zones and where it is (x, y, z).
    """

    pin: str
    case: str
    points: Floats
    cells: NDArray[np.int64]
    displacement: Floats
    stress: Floats
    von_mises: Floats
    envelope: Floats
    cell_type: str = "tetra10"
    yield_strength: float | None = None
    outside: tuple[float, tuple[float, float, float]] | None = None


@dataclass(frozen=True)
class PinShape:
    """A pin's profile for drawing: segments (length, diameter, bore, label, kind) in order, where
    kind is "band", "held" or "plain"; its weight (None without a density).
    """

    pin: str
    segments: tuple[tuple[float, float, float, str, str], ...]
    material: str
    weight: float | None


@dataclass(frozen=True)
class Provenance:
    """Where a number of the study comes from: given, derived, fitted or assumed."""

    key: str
    kind: str
    note: str


@dataclass(frozen=True)
class Results:
    """Everything a run found, without the fields inside of pins (those are written pin by pin)."""

    title: str
    study: str
    study_sha256: str
    units: Units
    required_safety_factor: float | None
    tolerance: float
    pins: tuple[PinResult, ...]
    shapes: tuple[PinShape, ...] = ()
    reactions: tuple[ReactionTable, ...] = ()
    drive: tuple[DriveTable, ...] = ()
    motion: tuple[LinkageMotion, ...] = ()
    beam_check: BeamCheck | None = None
    motion_check: MotionCheck | None = None
    published: tuple[PublishedValue, ...] = ()
    legs: tuple[LegTable, ...] = ()
    landing: tuple[LandingRange, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    provenance: tuple[Provenance, ...] = ()
    published_source: str = ""
    assumptions: tuple[str, ...] = ()
    versions: dict[str, str] = field(default_factory=dict)
    study_text: str = ""
