"""Pins of many segments and thin walls converge, within the memory there is."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.memory import section_memory
from fea.core.mesh_result import MeshMaximum
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.quiet_corners import NUMEROUS_FILLETS_ABOVE, numerous_fillets
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import singularities_of
from fea.solve.refine import MESH_RATIO, count_loads
from fea.solve.solve import solve_pin
from geometry import Pin, Segment
from geometry.mesh.section_mesh import meridian_mesh
from geometry.mesh.sizing import SectionSize, largest, stretches, triangles
from tests.support.each import sampled
from tests.support.pins.section_pins import nodes

D = 0.02


def shaft(count: int, thick: float, fillet: float = 0.0) -> Pin:
    """Every second segment is `thick` times as thick; the middle one and the last are loaded."""
    names = {count // 2: "A", count - 1: "B"}
    segments = (
        Segment(D, D * (thick if i % 2 else 1.0), connection=names.get(i)) for i in range(count)
    )
    return Pin("P", tuple(segments), fillet)


def ends(pin: Pin) -> PinLoads:
    """50 N back at the middle and 100 N at the end."""
    forces = np.array([[[0.0, -50.0, 0.0], [0.0, 100.0, 0.0]]])
    return PinLoads("c", pin.connections, forces, distribution="cosine")


def known(pin: Pin, steel: Material) -> float:
    """The maximum, which three meshes or more know to 2 %."""
    (found,) = solve_pin(pin, steel, ("start",), (ends(pin),), Requirement(model="harmonic"))
    peak = found.peak
    assert peak.max_von_mises is not None
    assert peak.parts is not None
    assert peak.parts.total <= 0.02 * peak.max_von_mises
    assert len(peak.history) >= 3
    return peak.max_von_mises


@pytest.mark.slow
@pytest.mark.parametrize("count", sampled([50, 200], every=2))
def test_equal_segments_are_a_plain_shaft(count: int, steel: Material) -> None:
    """Bending at the clamp, less 0.1 D that is excluded and what the clamp's rim changes."""
    moment = 100.0 * (count - 0.5) * D - 50.0 * (count // 2 + 0.5) * D
    expected = moment * 32.0 / math.pi / D**3
    assert known(shaft(count, 1.0), steel) == pytest.approx(expected, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("count", sampled([50, 100], every=2))
def test_a_crowd_of_fillets(count: int, steel: Material) -> None:
    """Stress at the first fillet is that of a pin of two segments under the same moment and shear
    there: 3 %, both being known to 2.
    """
    found = known(shaft(count, 1.2, 0.05 * D), steel)
    moment = 100.0 * (count - 1.5) - 50.0 * (count // 2 - 0.5)  # over D, where the first one is
    short = Pin(
        "S",
        (
            Segment(D, D),
            Segment(D, 1.2 * D),
            Segment(D, D),
            Segment(D, 1.2 * D),
            Segment(D, D, connection="B"),
        ),
        0.05 * D,
    )
    load = PinLoads(
        "c",
        ("B",),
        np.array([[[0.0, 50.0, 0.0]]]),
        moments=np.array([-(moment - 50.0 * 3.5) * D, 0.0, 0.0]),
        distribution="cosine",
    )
    (beside,) = solve_pin(short, steel, ("start",), (load,), Requirement(model="harmonic"))
    assert found == pytest.approx(beside.peak.max_von_mises, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("wall", sampled([0.005, 0.02], every=2))
def test_a_thin_tube(wall: float, steel: Material) -> None:
    bore = D * (1.0 - 2.0 * wall)
    names = (None, "A", "B")
    known(Pin("T", tuple(Segment(2 * D, D, bore, connection=n) for n in names)), steel)


def test_quiet_fillets_stay_coarse_and_the_others_do_not(steel: Material) -> None:
    """Of a cantilever those near the clamp count; each mesh is known from the first."""
    pin = shaft(NUMEROUS_FILLETS_ABOVE + 4, 1.2, 0.05 * D)
    loads = ends(pin)
    singularities = singularities_of(pin, steel, ("start",), (loads,))
    results: tuple[MeshMaximum, ...] = ()
    for level in range(2):
        solution = harmonic_solution(
            SectionProblem(pin, steel, ("start",), (loads,), singularities),
            level,
            MESH_RATIO,
            results[-1:],
        )
        results += (harmonic_result(solution, singularities, loads),)
    first, second = results
    assert first.quiet == second.quiet
    assert set(first.quiet) == set(numerous_fillets(pin)) - set(range(min(first.quiet)))
    assert 0 < min(first.quiet) < 0.5 * len(pin.segments)
    assert first.location[2] < pin.stations[2]


def test_memory_ends_a_section_too(steel: Material) -> None:
    """What the first mesh takes is enough for no second one, and that is reported."""
    pin = shaft(4, 1.0)
    requirement = Requirement(model="harmonic", tolerance=1e-6, meshes=2)
    loads = ends(pin)
    (free,) = solve_pin(pin, steel, ("start",), (loads,), requirement)
    first = free.peak.history[0].dofs
    enough = section_memory(first, count_loads((loads,)))
    (found,) = solve_pin(pin, steel, ("start",), (loads,), replace(requirement, memory=enough))
    assert [h.dofs for h in found.peak.history] == [first]
    assert "memory-limit" in found.peak.reasons
    assert f"{2 * first:,} unknowns" in found.peak.note


def test_few_fillets_are_no_crowd() -> None:
    assert numerous_fillets(shaft(NUMEROUS_FILLETS_ABOVE + 1, 1.2, 0.05 * D)) == ()
    assert numerous_fillets(shaft(NUMEROUS_FILLETS_ABOVE + 2, 1.2, 0.05 * D)) == tuple(
        range(NUMEROUS_FILLETS_ABOVE + 1)
    )
    assert numerous_fillets(shaft(200, 1.0, 0.05 * D)) == ()


def test_parts_have_elements_of_their_own_thickness() -> None:
    """A pin of 1000 diameters with a neck: 2 million elements of the neck's size otherwise."""
    thick, neck = 1000 * D, D
    pin = Pin("P", (Segment(thick, thick), Segment(neck, neck, connection="B")))
    size = SectionSize()
    assert triangles(pin, size) < 100.0 < 1e6 < thick**2 / 2 / largest(pin, size) ** 2
    found = meridian_mesh(pin, size)
    corners = nodes(found)[found.mesh.dofs.element_dofs[:3].T]
    edge = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1)
    z = corners[..., 1].mean(axis=1)
    assert edge[z > thick].max() < neck
    assert edge.max() > 100 * neck


def test_where_few_elements_do_they_are_the_same_all_over() -> None:
    pin = Pin("P", (Segment(3 * D, 2 * D), Segment(2 * D, D)))
    (only,) = stretches(pin, SectionSize())
    assert (only.z0, only.z1, only.near) == (0.0, pin.length, largest(pin, SectionSize()))
