"""Input decks for a reviewer: one pin at its governing instant, for another program, in the
reviewer's units.

The decks are those of the second opinion. For a pin with prescribed loads, the deck has the first
mesh, supports and nodal forces of the solid model, so that pinstress's result on the same mesh is
known. For a pin in lugs, it has pin and lugs in contact, on CalculiX's finer mesh of
`calculix_in_lugs`, at full loads.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from assess.opinion.calculix_compare import compared_nodes, first_solid_solution
from assess.opinion.calculix_deck import deck_lines
from assess.opinion.calculix_in_lugs import PinInLugs, meshes_for, transverse
from assess.opinion.calculix_joint import joint_deck
from assess.opinion.calculix_joint_deck import Dialect, JointDeck, Part
from fea.core.material import Material
from fea.core.peak import Maximum
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.solid.stress_recovery import nodal_stress
from geometry import PinLike
from pinbase.arrays import Floats


@dataclass(frozen=True)
class DeckUnits:
    """The SI values of a deck's units of length and force; stress is force over length squared."""

    length: float
    force: float

    @property
    def stress(self) -> float:
        return self.force / self.length**2


@dataclass(frozen=True)
class ReviewDeck:
    """A deck without its header.

    lines: the text of the deck.
    node, at: number and coordinates (3,), m, in the deck's axes, of the node at which the stress is
    compared.
    von_mises: stress by pinstress there, Pa. same_mesh: whether this stress was computed on the
    mesh of the deck.
    under: name of the lug on whose band the node lies; the stress is then without the local stress
    of the lug's pressure (fea.harmonic.free_surface). Empty elsewhere.
    unknowns: of the model.
    angle: angle by which the deck's axes are rotated from the pin's about z, rad.
    half: whether only the half in y > 0 is modelled.
    """

    lines: Iterable[str]
    node: int
    at: Floats
    von_mises: float
    same_mesh: bool
    unknowns: int
    angle: float = 0.0
    half: bool = False
    under: str = ""


def prescribed_deck(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    peak: Maximum,
    distance: float,
    units: DeckUnits,
) -> ReviewDeck:
    """Return the deck of a pin under prescribed loads at the governing instant of a peak.

    clamps: names of the clamped surfaces. cases: must include the case of the peak. distance: as in
    fea.core.requirement.Requirement.

    Raises: MeshError, SolveError.
    """
    assert peak.governing is not None
    live = tuple(case for case in cases if case.case == peak.case)
    solution = first_solid_solution(pin, material, clamps, live, distance)
    fields, space = solution.fields, solution.fields.space
    c = fields.coefficients(peak.governing)[0]
    stress = von_mises(nodal_stress(space, material, (fields.displacement @ c)[..., None])[..., 0])
    outside = compared_nodes(solution)
    node = int(outside[stress[outside].argmax()])
    lines = deck_lines(
        space.nodes / units.length, space.elements, _in_units(material, units), fields.fixed,
        fields.forces @ c / units.force,
    )  # fmt: skip
    return ReviewDeck(lines, node + 1, space.nodes[node], float(stress[node]), True, space.unknowns)


def contact_deck(
    seated: PinInLugs, peak: Maximum, units: DeckUnits, dialect: Dialect = "calculix"
) -> ReviewDeck:
    """Return the deck of a pin in contact with its lugs at the governing instant of a peak.

    Raises: ArgumentError for loads and joints that a deck cannot have; SolveError for unbalanced
    forces.
    """
    loads = transverse(seated, peak.governing)
    fineness = replace(meshes_for(loads)[1], scale=1.0)
    pin = seated.whole
    deck, angle = joint_deck(pin, seated.material, seated.lugs, loads, fineness)
    surface = peak.places.surface if peak.places is not None else None
    place = peak.location if surface is None else surface.location
    stress = peak.max_von_mises if surface is None else surface.max_von_mises
    assert place is not None
    assert stress is not None
    c, s = np.cos(angle), np.sin(angle)
    at = np.array(place) @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    at[1] = abs(at[1]) if deck.half else at[1]
    nodes = deck.pin.mesh.nodes
    node = int(np.linalg.norm(nodes - at, axis=1).argmin())
    bands = {lug.connection: pin.band(lug.connection) for lug in seated.lugs}
    under = next((name for name, b in bands.items() if b.z0 < place[2] < b.z1), "")
    lines = replace(_joint_in_units(deck, units), dialect=dialect).lines()
    return ReviewDeck(
        lines, node + 1, nodes[node], stress, False, deck.unknowns, angle, deck.half, under
    )


def _in_units(material: Material, units: DeckUnits) -> Material:
    """Return a material with its modulus in the units of a deck."""
    return replace(material, youngs_modulus=material.youngs_modulus / units.stress)


def _joint_in_units(deck: JointDeck, units: DeckUnits) -> JointDeck:
    """Return the same deck in other units than SI."""

    def part(one: Part) -> Part:
        mesh = replace(
            one.mesh,
            nodes=one.mesh.nodes / units.length,
            inner=one.mesh.inner / units.length,
            outer=one.mesh.outer / units.length,
        )
        lining = one.lining and (one.lining[0] / units.length, _in_units(one.lining[1], units))
        return replace(one, mesh=mesh, material=_in_units(one.material, units), lining=lining)

    moment = units.force * units.length
    eyes = tuple(
        replace(
            eye,
            part=part(eye.part),
            force=eye.force / units.force,
            tilt=eye.tilt / moment,
            couple=(eye.couple[0] / moment, eye.couple[1] / moment),
        )
        for eye in deck.eyes
    )
    hardness = deck.stiffness * units.length / units.stress
    return replace(deck, pin=part(deck.pin), eyes=eyes, stiffness=hardness)
