"""Input decks for a reviewer, with a row's pin at the governing instant and the expected numbers at
the head.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import degrees

from assess.opinion.calculix_in_lugs import PinInLugs
from assess.opinion.calculix_joint_deck import Dialect
from assess.opinion.review_deck import DeckUnits, ReviewDeck, contact_deck, prescribed_deck
from geometry import ArgumentError, body_of_revolution
from pinbase.processes.pool import Tell
from pinbase.processes.threads import one_thread
from pinstress.analysis.gather.gather import results_of
from pinstress.analysis.plan import prepare
from pinstress.analysis.solve import solve_tasks
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.ranges import factor_range
from reports.text.pin_sentence import pin_sentence

COMMENT_WIDTH = 96  # characters; CalculiX reads lines of at most 132
SAME_MESH_NOTE = (
    "Nodes, elements, supports and nodal forces are those of pinstress's first solid mesh, where "
    "node_von_mises is its own stress: CalculiX, which averages at nodes likewise, agrees to 1e-4. "
    "What differs from the row: tetrahedra (C3D10) on a coarse mesh replace its model, so "
    "max_von_mises may differ by its error and 30 % at a fillet. The tractions of the links are "
    "nodal forces. Without clamps six displacements are zero so that nothing moves freely; they "
    "carry nothing, since the loads are in equilibrium."
)
CONTACT_NOTE = (
    "What differs from pinstress: the mesh (C3D20R); contact without friction has a linear "
    "stiffness instead of exact conditions, and is found between the moved bodies. The stress of "
    "the node agrees to 30 % and the bending moment to 5 % (10 % with fillets in lugs), besides "
    "the row's error; the stress under lugs and at their edges is not compared. Each lug begins "
    "where it touches: shifted by half of its clearance along its force. The mean of its outer "
    "surface is an auxiliary node (*EQUATION) with its force; lugs of a structure, or the first, "
    "stand still, and springs of 1e-7 of the pin's stiffness hold what nothing else does."
)
UNDER_LUG_NOTE = (
    "The node lies under lug {}: node_von_mises is of the stress without that of the pressure "
    "itself. With p = -s_rr at the node, add p to s_rr and s_zz and 2 nu p to s_tt there (r, t "
    "about z) before comparing; where nothing presses, p is 0."
)
DIALECT_NOTES = {
    "calculix": "Run: ccx -i NAME, with NAME.inp; the stress at the nodes is in NAME.frd.",
    "abaqus": "Run: abaqus job=NAME. Written from its manual, not run: only keywords that those of "
    "CalculiX and Abaqus both define.",
}


@dataclass(frozen=True)
class ExpectedNumbers:
    """The numbers that a reviewer compares, as lines "key = value" in the deck's units.

    row, results: in the same units.
    """

    row: PinResult
    results: Results
    deck: ReviewDeck
    units: DeckUnits

    def lines(self) -> Iterator[tuple[str, object]]:
        """Yield the keys with their values; a number that the row lacks is left out."""
        row, deck = self.row, self.deck
        section = row.places.section if row.places is not None else None
        moment = row.joint.bending_moment if row.joint is not None else None
        moment = section.bending_moment if section is not None else moment
        for key, value in (
            ("max_von_mises", row.max_von_mises),
            ("error_estimate", row.error_estimate),
            ("time", row.time),
            ("safety_factor", row.safety_factor),
            ("required_safety_factor", row.required),
            ("section_z", section and section.z),
            ("section_moment", moment),
            ("section_shear_force", section and section.shear_force),
            ("section_axial_force", section and section.axial_force),
            ("section_torque", section and section.torque),
            ("node", deck.node),
            ("node_von_mises", deck.von_mises / self.units.stress),
        ):
            if value is not None:
                yield key, f"{value:.6g}"
        yield "node_at", ", ".join(f"{x / self.units.length:.6g}" for x in deck.at)


def review_deck(study: Study, pin: str, case: str, dialect: Dialect, tell: Tell) -> list[str]:
    """Return the lines of the deck of a pin in a case, its head first.

    Raises: InputError for a pin or case that does not exist, a row without a stress, and a pin that
    the deck cannot represent.
    """
    plan = prepare(study, pins=[pin], cases=[case])
    plan = replace(plan, explained=False)
    task = next((t for t in plan.tasks if any(x.case == case for x in t.loads)), None)
    if task is None:
        raise study.error(f"pin {pin} has no loads in case {case}", code="no-loads")
    tell(f"pin {pin}, {case}")
    with one_thread():
        outcomes = solve_tasks(plan)
        row = next(r for outcome in outcomes for r in outcome.rows if r.case == case)
        if not row.max_von_mises or row.maximum.governing is None:
            why = f"{row.verdict}: {row.note}" if row.note else row.verdict
            raise study.error(f"pin {pin} in case {case} has no stress to export ({why})",
                              code="no-stress")  # fmt: skip
        system = study.system
        units = DeckUnits(system.factor("length"), system.factor("force"))
        tell(f"pin {pin}, {case}: deck")
        try:
            deck = _deck(task, row, plan.requirement.distance, units, dialect)
        except (ArgumentError, ArithmeticError) as error:  # MeshError, SolveError
            raise study.error(f"pin {pin} in case {case} cannot be written: {error}",
                              code="no-deck") from None  # fmt: skip
    results = results_of(plan, outcomes)
    numbers = ExpectedNumbers(results[pin, case], results, deck, units)
    return [*_head(numbers, dialect), *deck.lines]


def _deck(
    task: Task, row: PinResult, distance: float, units: DeckUnits, dialect: Dialect
) -> ReviewDeck:
    if not task.lugs:
        return prescribed_deck(
            task.pin, task.material, task.clamps, task.loads, row.maximum, distance, units
        )
    profile = body_of_revolution(task.pin)
    if profile is None:
        raise ArgumentError("the deck of a pin in lugs has no holes, flats, slots", "cut-in-lugs")
    return contact_deck(PinInLugs(profile, task.material, task.lugs), row.maximum, units, dialect)


def _head(numbers: ExpectedNumbers, dialect: Dialect) -> Iterator[str]:
    """Yield the comments above the deck, in ASCII."""
    row, results, deck = numbers.row, numbers.results, numbers.deck
    u = results.units
    turned = f", turned by {degrees(deck.angle):.6g} degrees about z into the plane of the loads"
    half = " The model is the half in y > 0 of a symmetric joint; forces are halved." * deck.half
    bodies = "a pin under prescribed loads" if deck.same_mesh else "a pin in contact with its lugs"
    for paragraph in (
        f"Pin {row.pin}, case {row.case}: {bodies}, at its governing instant; pinstress "
        f"{results.versions.get('pinstress', '')}",
        f"Study: {results.study} ({results.title}), sha256 {results.study_sha256}",
        f"Units, consistent: {u.length}, {u.force}, {u.stress}; moments in {u.force} {u.length}",
        f"Axes: the pin's own, z along it{turned * bool(deck.angle)}.{half}",
        DIALECT_NOTES[dialect],
        f"Expected: {row.outcome}, safety factor {factor_range(row, ' to ')}. "
        f"{pin_sentence(row, u)}",
    ):
        yield from _comment(paragraph)
    yield "** Expected numbers:"
    for key, value in numbers.lines():
        yield f"**   {key} = {value}"
    if deck.under:
        yield from _comment(UNDER_LUG_NOTE.format(deck.under))
    yield from _comment(SAME_MESH_NOTE if deck.same_mesh else CONTACT_NOTE)


def _comment(text: str) -> Iterator[str]:
    plain = text.replace("±", "+/-").replace("−", "-").replace("–", "-").replace("·", " ")
    plain = plain.encode("ascii", "replace").decode("ascii")
    for line in textwrap.wrap(plain, COMMENT_WIDTH - 3):
        yield f"** {line}"
