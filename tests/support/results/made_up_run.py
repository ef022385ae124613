"""A made-up run: nine pins, a motion, a landing, and the checks of a beam and of the motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from assess.opinion.records import BeamCheck
from fea.core.peak import Refinement
from reports.data.fields import Field
from reports.data.mechanics import DriveTable, PublishedValue, ReactionTable
from reports.data.motion import LinkageMotion, MotionCheck, PowerLedger
from reports.data.results import PinShape, Provenance, Results
from reports.data.row import GoverningLoad, LandingRange, PinResult, Units
from tests.support.results.rows import row_with

UNITS = Units("in", "lbf", "psi", "s")
PINS = "ABCDEFGHJ"
CONNECTIONS = tuple(f"{body} {p}" for p in PINS for body in ("drag brace", "strut"))


def make_results() -> Results:
    times = np.linspace(0.0, 4.0, 201)
    return Results(
        title="Nose landing gear",
        study="studies/gear.toml",
        study_sha256="ab" * 32,
        units=UNITS,
        required_safety_factor=1.5,
        tolerance=0.02,
        pins=tuple(
            replace(pin(name, case), units=UNITS)
            for case in ("retract", "landing")
            for name in PINS
        ),
        shapes=tuple(shape(name) for name in PINS),
        reactions=(moving(times), static()),
        drive=(drive(times),),
        motion=(four_bar("retract", times), four_bar("landing", None)),
        published=(
            PublishedValue("retract", 2.0, "angular_velocity", "rocker", 0.5, 0.51, "rad/s", "cut"),
            PublishedValue("landing", None, "force_x", "strut A", 40.0, 40.0, "lbf", ""),
        ),
        beam_check=beam_check(),
        motion_check=motion_check(times),
        provenance=(
            Provenance("pin.B.diameter", "given", "Table 2", "50 mm"),
            Provenance("case.landing.force", "derived", "impulse over 0.1 s"),
            Provenance("material.steel.nu", "assumed", "not stated; 0.3 is usual"),
        ),
        published_source="Smith & Jones 2008, Table 5",
        assumptions=("Links are rigid.", "Joints have no friction."),
        versions={"numpy": "2.4.6", "python": "3.11.7", "gmsh": "4.15.2"},
    )


def pin(name: str, case: str) -> PinResult:
    i = PINS.index(name)
    if (name, case) == ("J", "landing"):
        note = "nothing holds the pin and its loads are not in balance"
        return row_with(name, case, verdict="rigid", note=note, held="nothing", required=1.5)
    largest = 1234.5678901234567 * (i + 1) ** 1.9 * (5.0 if case == "landing" else 1.0)
    loose = name == "D"
    factor = 118000.0 / largest
    return row_with(
        name,
        case,
        verdict="unconverged" if loose else "converged",
        note="the peak sits at a sharp inner corner, where it grows with every mesh"
        if loose
        else "known to 0.5%",
        max_von_mises=largest,
        error_estimate=0.005 * largest,
        location=(0.0, 0.5, 1.0 + 0.1 * i),
        time=0.02 * (7 * i % 200) if case == "retract" else None,
        position=0.1 * i if case == "retract" else None,
        safety_factor=factor,
        decided=None if loose else factor >= 1.5,
        required=1.5,
        history=tuple(
            Refinement(4200 * (i + 1) * 2**k // 4, largest * (1.0 - 0.02 / 4**k), 0.01)
            for k in range(3)
        ),
        held="start, its whole face",
        left_out=("1200 lbf at 2.0 s on band head",) if name == "C" else (),
        published_max_von_mises=largest * 1.07 if name in "AB" else None,
        published_safety_factor=factor / 1.07 if name in "AB" else None,
        error_parts={"mesh": 0.004 * largest, "time": 0.001 * largest},
        loads=governing_loads(name, case),
    )


def governing_loads(name: str, case: str) -> tuple[GoverningLoad, ...]:
    table = (
        moving(np.array([0.02 * (7 * PINS.index(name) % 200)])) if case == "retract" else static()
    )
    return tuple(
        GoverningLoad(connection, table.bodies[c], table.forces[0, c], table.moments[0, c])
        for c, connection in enumerate(table.connections)
        if table.pins[c] == name
    )


def shape(name: str) -> PinShape:
    return PinShape(
        name,
        (
            (0.25, 1.5, 0.25, "head", "held"),
            (1.25, 1.0, 0.25, f"drag brace {name}", "band"),
            (0.125, 1.0, 0.25, "gap", "plain"),
            (0.75, 1.0, 0.25, f"strut {name}", "band"),
            (0.5, 0.875, 0.25, "nut", "plain"),
        ),
        "4340 steel",
        0.61 if name != "A" else None,
    )


def moving(times: np.ndarray) -> ReactionTable:
    phase = np.linspace(0.0, np.pi, len(times))
    c = np.arange(len(CONNECTIONS), dtype=float)
    swing = 200.0 * (c + 1.0) * np.sin(phase[:, None] + 0.1 * c)
    forces = np.stack([swing, 0.4 * swing + 100.0, 0.0 * swing], axis=2)
    moments = np.zeros_like(forces)
    moments[:, :4, 2] = 12.0 * swing[:, :4]
    return ReactionTable(
        "retract", times, 5.0 * (1.0 - np.cos(phase)), CONNECTIONS,
        tuple(name.rsplit(" ", 1)[0] for name in CONNECTIONS),
        tuple(name[-1] for name in CONNECTIONS), forces, moments,
        shared=("strut B",), published={"strut A": 480.0},
    )  # fmt: skip


def static() -> ReactionTable:
    size = np.geomspace(30.0, 2.0e4, len(CONNECTIONS))
    forces = np.zeros((1, len(CONNECTIONS), 3))
    forces[0, :, 1] = size
    return ReactionTable(
        "landing", None, None, CONNECTIONS,
        tuple(name.rsplit(" ", 1)[0] for name in CONNECTIONS),
        tuple(name[-1] for name in CONNECTIONS), forces, np.zeros_like(forces),
        published={"strut A": 40.0, "strut J": 1.8e4}, note="impulse over 0.1 s",
    )  # fmt: skip


def four_bar(case: str, times: np.ndarray | None) -> LinkageMotion:
    """Return a parallelogram whose crank swings from 60 to 120 degrees, in closed form.

    Its coupler does not turn, and a roller slides along the ground under joint B.
    """
    span = 4.0
    t = np.array([1.0]) if times is None else times
    swing, w = np.radians(60.0), np.pi / span
    angle = np.radians(60.0) + 0.5 * swing * (1.0 - np.cos(w * t))
    omega, alpha = 0.5 * swing * w * np.sin(w * t), 0.5 * swing * w * w * np.cos(w * t)
    unit = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    across = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    crank = 10.0 * unit
    speed = 10.0 * omega[:, None] * across
    rate = 10.0 * (alpha[:, None] * across - (omega**2)[:, None] * unit)
    zero, aside = np.zeros_like(crank), np.array([25.0, 0.0])
    turns = np.stack([angle, 0.0 * angle, angle, 0.0 * angle], axis=1)
    degrees = np.degrees(turns)
    degrees[:, 3] = np.nan  # the roller is a particle
    moving = np.array([1.0, 0.0, 1.0, 0.0])
    kinetic = 3.0 * 10.0**2 * omega * alpha
    weight = -5.0 * speed[:, 1]
    flat = np.stack([crank[:, 0] + 25.0, 0.0 * angle], axis=1)
    return LinkageMotion(
        case=case,
        time=times,
        bodies=("crank", "coupler", "rocker", "roller"),
        links=(("O", "A"), ("A", "B"), ("Q", "B"), ("R",)),
        centre=np.stack([0.5 * crank, crank, 0.5 * crank + aside, flat], axis=1),
        velocity=np.stack([0.5 * speed, speed, 0.5 * speed, zero], axis=1),
        acceleration=np.stack([0.5 * rate, rate, 0.5 * rate, zero], axis=1),
        angle=degrees,
        angular_velocity=omega[:, None] * moving,
        angular_acceleration=alpha[:, None] * moving,
        joints=("O", "A", "B", "Q", "R"),
        ground=("O", "Q"),
        joint_position=np.stack([zero, crank, crank + aside, zero + aside, flat], axis=1),
        joint_velocity=np.stack([zero, speed, speed, zero, zero], axis=1),
        joint_acceleration=np.stack([zero, rate, rate, zero, zero], axis=1),
        slides={"guide": np.stack([zero + aside, flat], axis=1)},
        connections=(),
        transmission={"coupler at B": np.degrees(np.arcsin(np.abs(np.sin(angle))))},
        condition=2.0 / np.abs(np.sin(angle)),
        shaking_force=-rate,
        shaking_moment=-40.0 * alpha,
        shaking_about="O",
        ledger=PowerLedger(kinetic - weight, weight, 0.0 * angle, 0.0 * angle, kinetic, 1.2e-15),
    )


def drive(times: np.ndarray) -> DriveTable:
    phase = np.linspace(0.0, np.pi, len(times))
    velocity = 4.0 * np.sin(phase)
    force = 900.0 + 400.0 * np.cos(phase)
    work = np.cumsum(force * velocity) * (times[1] - times[0])
    kinetic = 20.0 * velocity**2
    return DriveTable(
        "retract", times, 5.0 * (1.0 - np.cos(phase)), velocity, 3.0 * np.cos(phase), force,
        force * velocity, work, kinetic, work - kinetic,
    )  # fmt: skip


def beam_check() -> BeamCheck:
    z = np.linspace(0.0, 5.0, 101)
    rest = 5.0 - np.maximum(z, 2.0)
    shear = 1000.0 * rest / 3.0
    moment = 1000.0 * rest / 3.0 * (0.5 * (np.maximum(z, 2.0) + 5.0) - z)
    beam = moment * 0.5 / (np.pi / 64.0)
    root = np.exp(-z / 0.08)
    return BeamCheck(
        "B", "landing", "strut B", 1000.0, 1.0, 0.1, (2.0, 5.0), z, shear, moment, beam,
        beam * (1.0 + 0.9 * root) - 900.0 * (z / 5.0) ** 4, beam * (1.0 + 0.9 * root),
        -4.74, -8.18,
    )  # fmt: skip


def motion_check(times: np.ndarray) -> MotionCheck:
    phase = np.linspace(0.0, np.pi, len(times))
    speed, acceleration = 11.0 * np.sin(phase), 8.6 * np.abs(np.cos(phase)) + 1.0
    return MotionCheck(
        "B", "retract", times, speed, acceleration, speed, acceleration,
        ((1.0, 7.78, 7.08, 7.7781745, 7.0811183), (2.0, 11.0, 1.0, 11.0, 1.0)),
    )  # fmt: skip


def make_field() -> Field:
    """Return one quadratic tetrahedron with its middle nodes on the straight edges."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 3]])
    edges = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
    points = np.vstack([corners, [0.5 * (corners[a] + corners[b]) for a, b in edges]])
    stress = np.arange(60.0).reshape(10, 6)
    envelope = np.linspace(110.0, 210.0, 10)
    envelope[7] = np.nan
    return Field(
        "B", "landing", points, np.arange(10).reshape(1, 10), 1e-3 * points, stress,
        np.linspace(100.0, 200.0, 10), envelope,
    )  # fmt: skip


def ranged(pin: str, verdict: str = "converged", factor: float = 4.0) -> LandingRange:
    times, speeds = (x.ravel() for x in np.meshgrid([0.1, 0.2], [10.0, 25.0]))
    force = speeds / times
    return LandingRange(
        pin=pin,
        case="landing",
        impulse_time=times,
        velocity_change=speeds,
        force=force,
        max_von_mises=10.0 * force,
        safety_factor=factor * 100.0 / force,
        nominal=(0.1, 10.0),
        verdict=verdict,
        pulses=("rectangular",) * len(force),
        nominal_pulse="rectangular",
    )
