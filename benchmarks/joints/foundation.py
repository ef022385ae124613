"""The beam on foundations compared with contact: its errors on pins drawn at random, and
its times.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from statistics import median

import numpy as np

from benchmarks.joints.joint import EYE, FORCE, NAMES, SHARE, STEEL, TRUTH, D, E
from benchmarks.joints.random_joints import JointTrial, joint_trials
from benchmarks.timing import seconds, table
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.harmonic.beneath import beneath
from fea.harmonic.field import HarmonicField
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.section.section_stress import SectionField
from fea.singular.singularities import singularities_of
from fea.support.contact.cell_error import AtPlaces
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.foundation.bounds import StressBounds, stress_bounds
from fea.support.foundation.foundation_model import (
    FoundationModel,
    Stiffness,
    foundation_stiffness,
    moment_error,
)
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.lug import Lug
from geometry import Band, Pin, Segment

PINS, SEED = 40, 3  # the constants were fitted on the seeds 1, 2 and 5
FINE = Resolution(rings=8, sectors=48, highest=16)
ENDS = 0.04, 0.15  # of a lug's length
CLEARANCES = 0.001, 0.003  # of the diameter
PRESSURE = 1e8  # Pa, mean pressure on the most loaded lug under which clearances are compared
INSTANTS = 10_000
UNSEEN = 22  # seed; the error by clearance and rounded edges was fitted on the seeds 21 and 23
PLAYS = 0.0, 1.0, 10.0  # clearance in p / E diameters, p the mean pressure on the most loaded band
PLAY = 0.001  # of the diameter


@dataclass(frozen=True)
class Compared:
    """The errors of one pin.

    largest, middle: of the moment, at its largest and at mid-span, over the largest by contact.
    last, last_two: of the line load at the lugs' ends over the lug's mean, on the last parts
    (ENDS).
    bound: the estimated bound of the first.
    """

    lugs: int
    tube: bool
    largest: float
    middle: float
    last: Floats
    last_two: Floats
    bound: float


def foundation() -> str:
    """Return the five tables."""
    trials = joint_trials(PINS, SEED)
    contacts = [_contact(trial) for trial in trials]
    return "\n\n".join(
        (
            _errors(trials, contacts),
            _stresses(),
            _clevises(),
            _clearances(trials, contacts),
            _times(trials[0]),
        )
    )


def contact_places(trial: JointTrial, model: ContactModel | None = None) -> AtPlaces:
    """Return the stresses by contact at one instant, on the first mesh."""
    joint = model or ContactModel(trial.pin, trial.material, trial.lugs)
    loads = joint.solve(trial.loads).loads
    singular = singularities_of(joint.pin, joint.material, (), (loads,))
    problem = SectionProblem(joint.pin, joint.material, (), (loads,), singular, joint.first)
    answer = HarmonicField(harmonic_solution(problem, 0, 1.0), singular)
    sections = SectionField(joint.pin, joint.material, (), [loads.on_rings])
    below = beneath(answer.fields, loads, singular).value
    return AtPlaces(answer.largest(loads)[0], sections.largest(loads.on_rings)[0], below)


def played(trial: JointTrial, play: float) -> JointTrial:
    """Return the joint with a clearance of `play` times p / E diameters.

    The clearance is PLAY diameters, and the loads are such that it has this ratio.
    """
    if not play:
        return trial
    bands = [trial.pin.band(lug.connection) for lug in trial.lugs]
    forces = np.abs(trial.loads.forces[0, :, 0])
    mean = float((forces / [2.0 * b.radius * b.length for b in bands]).max())
    size = PLAY * trial.material.youngs_modulus / play / mean
    pairs = zip(trial.lugs, bands, strict=True)
    lugs = tuple(replace(lug, clearance=PLAY * 2.0 * b.radius) for lug, b in pairs)
    loads = replace(trial.loads, forces=size * trial.loads.forces)
    return replace(trial, lugs=lugs, loads=loads)


def bounds_of(trial: JointTrial) -> StressBounds:
    """Return the bounds of the stress by the beam on foundations."""
    model = FoundationModel(trial.pin, trial.material, trial.lugs)
    return stress_bounds(FoundationStress.of(model), model.solve(trial.loads))


def _stresses() -> str:
    """Return the table of the row's stress by contact: over the beam's, and whether it and the
    stress beneath contact are within the beam's bounds.
    """
    trials = joint_trials(PINS, UNSEEN)
    joints = [ContactModel(t.pin, t.material, t.lugs) for t in trials]
    rows = [_stress_row(trials, joints, play) for play in PLAYS]
    head = ("clearance [p/E d]", "pins", "contact over beam, median", "5th to 95th percentile")
    return table((*head, "upper bound over beam, median", "within the bounds"), rows)


def _stress_row(
    trials: list[JointTrial], joints: list[ContactModel], play: float
) -> tuple[str, ...]:
    ratios, tops, inside = [], [], 0
    for trial, joint in zip(trials, joints, strict=True):
        loose = played(trial, play)
        found = bounds_of(loose)
        assert found.bounds is not None
        try:
            found_by = contact_places(loose, joint.varied(loose.lugs))
        except SolveError:  # contact does not settle
            continue
        low, high = found.bounds
        truth, below = found_by.row, found_by.beneath
        ratios.append(truth / found.maximum)
        tops.append(high / found.maximum)
        inside += low <= truth <= max(truth, below) <= high
    low, high = np.quantile(ratios, [0.05, 0.95])
    shares = f"{median(ratios):.2f}", f"{low:.2f} to {high:.2f}", f"{median(tops):.2f}"
    return f"{play:g}", str(len(ratios)), *shares, f"{inside} of {len(ratios)}"


def two_constants(segment: Segment, material: Material, lug: Lug) -> float:
    """Return the stiffness fitted to clevises with solid pins, N/m^2."""
    return 1.0 / (0.196 / material.youngs_modulus + 0.987 / lug.material.youngs_modulus)


def largest_moment(moment: Callable[[Floats], Floats], pin: Pin) -> float:
    """Return the largest moment along the pin at the first instant, under loads along x, N m."""
    return float(np.abs(moment(np.linspace(0.0, pin.length, 401))[0, :, 0]).max())


def _contact(trial: JointTrial) -> JointContact:
    return ContactModel(trial.pin, trial.material, trial.lugs, FINE).solve(trial.loads)


def _compared(trial: JointTrial, contact: JointContact, stiffness: Stiffness) -> Compared:
    model = FoundationModel(trial.pin, trial.material, trial.lugs, FINE.rings, stiffness)
    found = model.solve(trial.loads)
    truth = largest_moment(contact.bending_moment, trial.pin)
    ours = largest_moment(found.bending_moment, trial.pin)
    z = contact.bands.z
    middle = np.array([0.5 * (z[0] + z[-1])])
    apart = found.bending_moment(middle) - contact.bending_moment(middle)
    off = [
        _end_loads(
            found.shear_force, contact.shear_force, trial.pin.band(lug.connection), float(force)
        )
        for lug, force in zip(trial.lugs, trial.loads.forces[0, :, 0], strict=True)
    ]
    ends = np.stack(off, axis=1)  # (parts, lugs, sides)
    return Compared(
        len(trial.lugs),
        any(s.bore for s in trial.pin.segments),
        ours / truth - 1.0,
        float(apart[0, 0, 0]) / truth,
        ends[0].ravel(),
        ends[1].ravel(),
        moment_error(trial.pin, trial.material, trial.lugs),
    )


def _end_loads(
    ours: Callable[[Floats], Floats], theirs: Callable[[Floats], Floats], band: Band, force: float
) -> Floats:
    """Return the differences of the loads along x on both ends of a lug, over their mean, (parts,
    2).
    """
    out = []
    for part in ENDS:
        z = np.array([band.z0, band.z0 + part * band.length, band.z1 - part * band.length, band.z1])
        apart = (ours(z) - theirs(z))[0, :, 0]
        out.append(np.abs([apart[1] - apart[0], apart[3] - apart[2]]) / (part * abs(force)))
    return np.array(out)


def _errors(trials: list[JointTrial], contacts: list[JointContact]) -> str:
    rows = []
    for what, stiffness in (
        ("plane contact", foundation_stiffness),
        ("two constants", two_constants),
    ):
        all_ = [_compared(t, c, stiffness) for t, c in zip(trials, contacts, strict=True)]
        groups = {
            "all": all_,
            "three lugs, solid": [c for c in all_ if c.lugs == 3 and not c.tube],
            "three lugs, tube": [c for c in all_ if c.lugs == 3 and c.tube],
            "two lugs, solid": [c for c in all_ if c.lugs == 2 and not c.tube],
            "two lugs, tube": [c for c in all_ if c.lugs == 2 and c.tube],
        }
        rows += [(f"{what}: {name}", *_row(group)) for name, group in groups.items()]
    head = (
        "foundation: pins",
        "number",
        "largest moment, median [%]",
        "5th to 95th percentile [%]",
    )
    more = ("furthest [%]", "mid-span, 95 % within [%]", "within the bound")
    loads = ("load of the last 4 %, median [%]", "of the last 15 %")
    return table((*head, *more[:-1], *loads, more[-1]), rows)


def _row(group: list[Compared]) -> tuple[str, ...]:
    largest = 100.0 * np.array([c.largest for c in group])
    low, high = np.quantile(largest, [0.05, 0.95])
    middle = 100.0 * np.quantile(np.abs([c.middle for c in group]), 0.95)
    last, last_two = (
        100.0 * np.median(np.concatenate(each))
        for each in ([c.last for c in group], [c.last_two for c in group])
    )
    held = sum(abs(1.0 / (1.0 + c.largest) - 1.0) <= c.bound for c in group)
    return (
        str(len(group)),
        f"{median(largest):+.1f}",
        f"{low:+.1f} to {high:+.1f}",
        f"{max(largest, key=abs):+.1f}",
        f"{middle:.1f}",
        f"{last:.0f}",
        f"{last_two:.0f}",
        f"{held} of {len(group)}",
    )


def clevis(inner: float, outer: float, gap: float) -> tuple[Pin, list[Lug]]:
    """Return a clevis of the published references; lengths in mm."""
    over, apart = Segment(0.002, D), Segment(gap / 1e3, D)
    left, middle, right = (
        Segment(t / 1e3, D, connection=name)
        for t, name in zip((outer, inner, outer), NAMES, strict=True)
    )
    shank = E * EYE * (outer / 1e3) ** 3 / (12.0 * 0.04)
    tilts = zip(NAMES, (shank, math.inf, shank), strict=True)
    pin = Pin("P", (over, left, apart, middle, apart, right, over))
    return pin, [Lug(name, EYE, STEEL, tilt=k) for name, k in tilts]


def _clevises() -> str:
    rows = []
    for inner, outer, gap, clearance, moment, _ in TRUTH:
        pin, lugs = clevis(inner, outer, gap)
        pull = PinLoads("pull", NAMES, FORCE * SHARE[None, :, None] * np.eye(3)[0])
        nominal = FORCE / 2.0 * (outer / 2.0 + gap + inner / 4.0) / 1e3
        found = FoundationModel(pin, STEEL, lugs).solve(pull)
        middle = np.array([0.5 * pin.length])
        ours = abs(float(found.bending_moment(middle)[0, 0, 0])) / nominal
        rows.append(
            (
                f"{inner:g} / {outer:g}+{outer:g}, gap {gap:g}",
                f"{clearance:g}",
                f"{ours:.4f}",
                f"{moment:.4f}",
                f"{100.0 * (ours / moment - 1.0):+.1f}",
            )
        )
    return table(("lugs [mm]", "clearance [mm]", "M / M0", "3D", "off [%]"), rows)


def _clearances(trials: list[JointTrial], contacts: list[JointContact]) -> str:
    """Return the table of the rise of the largest moment with clearance, by contact."""
    rows = []
    for clearance in CLEARANCES:
        rises = 100.0 * np.array(
            [_rise(t, c, clearance) for t, c in zip(trials, contacts, strict=True)]
        )
        low, high = np.quantile(rises, [0.05, 0.95])
        rows.append((f"{clearance:g} d", f"{median(rises):+.1f}", f"{low:+.1f} to {high:+.1f}"))
    head = (
        f"clearance, mean pressure {PRESSURE / 1e6:g} MPa",
        "rise of the largest moment, median [%]",
    )
    return table((*head, "5th to 95th percentile [%]"), rows)


def _rise(trial: JointTrial, contact: JointContact, clearance: float) -> float:
    bands = [trial.pin.band(lug.connection) for lug in trial.lugs]
    mean = np.abs(trial.loads.forces[0, :, 0]) / [2.0 * b.radius * b.length for b in bands]
    factor = PRESSURE / mean.max()
    loads = replace(trial.loads, forces=factor * trial.loads.forces)
    lugs = [
        replace(lug, clearance=clearance * 2.0 * b.radius)
        for lug, b in zip(trial.lugs, bands, strict=True)
    ]
    loose = ContactModel(trial.pin, trial.material, lugs, FINE).solve(loads)
    before = factor * largest_moment(contact.bending_moment, trial.pin)
    return largest_moment(loose.bending_moment, trial.pin) / float(before) - 1.0


def _times(trial: JointTrial) -> str:
    angle = np.linspace(0.0, 2.0 * np.pi, INSTANTS)[:, None]
    size = trial.loads.forces[0, :, 0]
    forces = np.stack([np.cos(angle) * size, np.sin(angle) * size, 0.0 * angle * size], axis=2)
    loads = PinLoads("turned", trial.loads.surfaces, forces)
    start = time.perf_counter()
    model = FoundationModel(trial.pin, trial.material, trial.lugs)
    first = time.perf_counter() - start
    built = seconds(lambda: FoundationModel(trial.pin, trial.material, trial.lugs))
    solved = seconds(lambda: model.solve(loads))
    head = ("first factorisation [ms]", "further [ms]", f"{INSTANTS} instants [ms]")
    return table(head, [tuple(f"{1e3 * t:.1f}" for t in (first, built, solved))])
