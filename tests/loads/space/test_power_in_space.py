"""Power of drives, loads and gravity against the rate of the kinetic energy, for ten machines.

Velocities alone are taken from the motion; the energy is summed here and differentiated by central
differences, so that accelerations, couples and reactions have no part in it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.space.machines import MACHINES, Machine
from benchmarks.space.ours import space_linkage
from loads import CycloidalDrive
from loads.space import equations
from loads.space.acting import SpaceForce
from loads.space.dynamics import space_reactions
from loads.space.motion import SpaceCourse, SpaceMotion
from pinbase.arrays import Floats
from tests.support.each import each

DIFFERENCES = (4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0)  # central, of order eight
STEP = 2e-3  # of the duration: truncation and round-off are both below 1e-10 there
TOLERANCE = 1e-9  # of the largest power of any drive, load or weight


def kinetic_energy(machine: Machine, motion: SpaceMotion) -> Floats:
    """Kinetic energy of all bodies, (T,) J."""
    energy = np.zeros(len(motion))
    for name, body in machine["bodies"].items():
        velocity = motion.point(name, body["centre"])[1]
        own = np.einsum("tji,tj->ti", motion.rotation(name), motion.spin(name))  # in body axes
        energy += 0.5 * body["mass"] * np.sum(velocity**2, axis=1)
        energy += 0.5 * np.einsum("ti,ij,tj->t", own, np.array(body["inertia"]), own)
    return energy


@each("name", sorted(set(MACHINES) - {"gyroscope", "landing-gear"}))
def test_power_becomes_kinetic_energy(name: str) -> None:
    _holds(name, MACHINES[name]())


@each(("name", "drive"), [("gyroscope", "spin"), ("landing-gear", "roll")])
def test_power_becomes_kinetic_energy_beside_a_spinning_wheel(name: str, drive: str) -> None:
    """At a quarter of the spin, so that differences resolve it."""
    machine = MACHINES[name]()
    machine["drives"][drive]["to"] *= 0.25
    _holds(name, machine)


def _holds(name: str, machine: Machine) -> None:
    laws = [CycloidalDrive(0.0, d["to"], machine["duration"]) for d in machine["drives"].values()]
    course = SpaceCourse(space_linkage(machine), laws, 0.0, machine["duration"])
    times, h = machine["duration"] * np.linspace(0.1, 0.9, 9), STEP * machine["duration"]
    rate = np.zeros(len(times))
    for k, weight in enumerate(DIFFERENCES, start=1):
        ahead, behind = (kinetic_energy(machine, course.at(times + s * k * h)) for s in (1, -1))
        rate += weight * (ahead - behind) / h
    motion = course.at(times)
    loads = [SpaceForce(body, at, force) for body, at, force in machine["forces"]]
    found = space_reactions(name, motion, loads)
    speeds = np.stack([law(times)[1] for law in laws], axis=1)
    powers = list((found.drive * speeds).T)
    powers += [motion.point(body, at)[1] @ force for body, at, force in machine["forces"]]
    powers += [
        body["mass"] * (motion.point(part, body["centre"])[1] @ machine["gravity"])
        for part, body in machine["bodies"].items()
    ]
    largest = max(float(np.abs(p).max()) for p in powers)
    assert np.sum(powers, axis=0) == pytest.approx(rate, abs=TOLERANCE * largest)


def test_energies_of_a_long_motion_are_summed_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """As at once, without the velocities and inertias of all instants in memory."""
    machine = MACHINES["crane"]()
    laws = [CycloidalDrive(0.0, d["to"], machine["duration"]) for d in machine["drives"].values()]
    course = SpaceCourse(space_linkage(machine), laws, 0.0, machine["duration"])
    motion = course.at(machine["duration"] * np.linspace(0.1, 0.9, 9))
    loads = [SpaceForce(body, at, force) for body, at, force in machine["forces"]]
    monkeypatch.setattr(equations, "MIN_BATCH", 4)
    whole = space_reactions("whole", motion, loads)
    assert len(list(motion.parts)) == 1
    monkeypatch.setattr(equations, "MATRIX_BATCH_ENTRIES", 1)
    blocks = space_reactions("blocks", replace(motion), loads)
    assert len(list(blocks.motion.parts)) == 3
    assert blocks.imbalance == pytest.approx(whole.imbalance, abs=1e-12 * np.abs(whole.power).max())
    assert blocks.motion.kinetic_energy == pytest.approx(whole.motion.kinetic_energy, rel=1e-14)
    assert not {"velocities", "accelerations", "inertias"} & vars(blocks.motion).keys()
