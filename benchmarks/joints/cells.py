"""The errors by contact cells and meshes in surface, section and beneath contact.

Pins drawn at random are compared with cells half as large and meshes half as coarse.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.joints.random_pins import PinTrial, pin_trials
from benchmarks.timing import table
from fea.core.pin_loads import Floats
from fea.core.requirement import Requirement
from fea.harmonic.beneath import beneath
from fea.harmonic.evaluate import SECTION_MESHES
from fea.harmonic.field import HarmonicField
from fea.section.place import FLEXIBILITY_ERROR
from fea.section.section_stress import SectionField
from fea.solve.solve import solve_pin
from fea.support.contact.contact_support import profile_of
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import resultants
from fea.support.contact.resolution import Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.variations import compare, nowhere

COUNT, SEED = 24, 3
REFERENCE = Resolution(16, 72, 16, 16.0)
FINE_MESHES = Resolution(8, 36, 12, 20.0)
PLACES = "surface", "section", "beneath"
OFTEN = 0.95


@dataclass(frozen=True)
class CellError:
    """The errors of a pin by place, (3,), relative.

    estimate: of the usual cells, from cells twice as large. off: the true one.
    mesh: the change of the surface by the second mesh, and the true error on this mesh.
    flexibilities: the error of sections by the meshes of flexibilities.
    """

    name: str
    estimate: Floats
    off: Floats
    mesh: tuple[float, float] | None = None
    flexibilities: float | None = None


def cells() -> str:
    """Return the two tables."""
    found = list(cell_errors(COUNT, SEED))
    rows = [(name, *_row(found, k)) for k, name in enumerate(PLACES)]
    head = ("place", "pins", "off, median [%]", "95 % [%]", "largest [%]", "estimated covers")
    first = table((*head, "with meshes", "largest off / both"), rows)
    meshes = [x.mesh for x in found if x.mesh]
    soft = [x.flexibilities for x in found if x.flexibilities is not None]
    off = np.array([m[1] for m in meshes])
    estimate = np.maximum([m[0] for m in meshes], SECTION_MESHES.scatter / 4.0)
    more = [
        ("surface, second mesh", str(len(off)), *_spread(off), f"{np.mean(off <= estimate):.0%}"),
        ("section, meshes of flexibilities", str(len(soft)), *_spread(np.array(soft)),
         f"{np.mean(np.array(soft) <= FLEXIBILITY_ERROR):.0%}"),
    ]  # fmt: skip
    return f"{first}\n\n{table((*head[:5], 'estimated covers'), more)}"


def _row(found: list[CellError], k: int) -> tuple[str, ...]:
    off, told = (np.array([getattr(x, name)[k] for x in found]) for name in ("off", "estimate"))
    meshes = FLEXIBILITY_ERROR if PLACES[k] == "section" else SECTION_MESHES.scatter / 4.0
    covered = [f"{np.mean(off <= told + x):.0%}" for x in (1e-4, meshes)]
    return str(len(off)), *_spread(off), *covered, f"{(off / (told + meshes)).max():.2f}"


def _spread(off: Floats) -> tuple[str, ...]:
    if not len(off):
        return "-", "-", "-"
    return tuple(f"{100.0 * x:.2f}" for x in (np.median(off), np.quantile(off, OFTEN), off.max()))


def cell_errors(count: int, seed: int) -> Iterator[CellError]:
    """Yield the errors of pins at one instant, every fourth also on a third mesh."""
    trials = [t for t in pin_trials(2 * count, seed) if t.given.cases[0].times is None][:count]
    for k, trial in enumerate(trials):
        yield cell_error(trial, k % 4 == 0)


def cell_error(trial: PinTrial, meshes: bool) -> CellError:
    """Return the errors of a pin. meshes: whether those of meshes are included."""
    model = _model(trial, Resolution())
    contact = model.solve(trial.given.cases[0])
    (compared,) = compare(model, [contact], Requirement(), vary=nowhere)
    estimate = np.array([getattr(compared.cells, name) for name in PLACES])
    history, here = _stress(model, contact, 3 if meshes else 2)
    finer = _model(trial, REFERENCE)
    _, truth = _stress(finer, finer.solve(trial.given.cases[0]), 2)
    mesh = soft = None
    if meshes:
        mesh = abs(history[1] / history[0] - 1.0), abs(history[1] / history[2] - 1.0)
        other = _model(trial, FINE_MESHES)
        soft = abs(here[1] / _section(other, other.solve(trial.given.cases[0])) - 1.0)
        here = np.array([history[1], *here[1:]])
    return CellError(trial.name, estimate, np.abs(here / truth - 1.0), mesh, soft)


def _model(trial: PinTrial, size: Resolution) -> ContactModel:
    given = trial.given
    return ContactModel(profile_of(given.pin), given.material, given.lugs, size)


def _stress(model: ContactModel, contact: JointContact, meshes: int) -> tuple[list[float], Floats]:
    """Return the surface's maximum on each mesh, and surface, section and stress beneath contact on
    the last, Pa.
    """
    requirement = Requirement(model="harmonic", meshes=meshes, tolerance=1e-9)
    (found,) = solve_pin(model.pin, model.material, (), (contact.loads,), requirement)
    assert isinstance(found.answer, HarmonicField)
    history = [step.max_von_mises for step in found.peak.history]
    below = beneath(found.answer.fields, contact.loads, found.answer.singularities).value
    surface = found.peak.places.surface.max_von_mises if found.peak.places else history[-1]
    return history, np.array([surface, _section(model, contact), below])


def _section(model: ContactModel, contact: JointContact) -> float:
    waves = model.waves(contact.contact)
    loads = resultants(model.pin, model.rings, waves, contact.loads.links)
    return SectionField(model.pin, model.material, (), [loads]).largest(loads)[0]
