"""Motions of clamps as unit loads, and what cuts change of redundant supports and loaded bands."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.requirement import Requirement
from fea.cut.field import CutField
from fea.cut.local_model import LocalModel
from fea.cut.lost_loads import bearings, trial_forces
from fea.cut.region import loaded_bands, pieces
from fea.harmonic.model import HarmonicModel
from fea.solid.boundary import resultants
from fea.solve.solve import solve_pin
from fea.support.support import Solution
from geometry import Cut, CutPin, Flat, Hole, Pin, Segment, Slot
from geometry.mesh.cut_piece import piece_mesh
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.plain_pins import TWICE
from tests.support.pins.section_grid import rectangle

A, L = 0.01, 0.2
BAR = Pin("bar", (Segment(L, 2.0 * A, name="side"),))
PLAIN = Material("no contraction", 2.0e11, 0.0)
STEEL = Material("steel", 2.1e11, 0.3, yield_strength=5e8)
D, d = 0.02, 0.004


def test_moved_clamps_stretch_twist_and_bend_a_bar() -> None:
    """Without contraction exactly E u / L, G r angle / L; turned about the far end's own middle (a
    turn about the origin and a shift back) Timoshenko's beam, with Cowper's shear coefficient.
    """
    shifts = (UnitLoad("end", "shift", n) for n in (0, 1))
    units = (*shifts, *(UnitLoad("end", "turn", n) for n in (0, 1)))
    section = rectangle(0.0, A, L, 4, 40, "side")
    fields = HarmonicModel(BAR, section, PLAIN, ("start", "end")).solve(units)
    r, z = fields.points.T
    along, across, twist, turned = np.moveaxis(fields.stress, -1, 0)
    E, G = PLAIN.youngs_modulus, PLAIN.youngs_modulus / 2.0
    assert along[:, 2] == pytest.approx(E / L, rel=1e-9)
    assert np.abs(twist[:, 3]) == pytest.approx(G * r / L, abs=1e-9 * G * A / L)
    middle = (np.abs(z - L / 2.0) < 0.1 * L) & (np.abs(r - A) < 1e-9)
    about_end = turned - L * across  # its shift at z = L is taken back
    phi = 3.0 * (A / L) ** 2 * (E / G) * 7.0 / 6.0  # 12 E I / (kappa G area L^2)
    near, far = -(2.0 - phi) / (1.0 + phi), (4.0 + phi) / (1.0 + phi)
    expected = E * A / L * (near + (far - near) * z[middle] / L)
    assert np.abs(about_end[middle, 2]) == pytest.approx(np.abs(expected), abs=3e-3 * E * A / L)


PRESSED = Pin(
    "pressed",
    (Segment(0.04, D, name="a"), Segment(0.02, D, connection="B"), Segment(0.04, D, name="b")),
)
HOLED = CutPin(PRESSED, (Hole(0.05, d),))


@pytest.mark.parametrize("shears", [True, False])
def test_what_is_lost_goes_to_the_band(shears: bool) -> None:
    """Tractions on the rest of the band have the resultants of a force and a couple: the area of
    the band without the mouths, half of it where they are normal to it.
    """
    bands = loaded_bands(HOLED, ("B",))
    assert np.array(bands) == pytest.approx(np.array([[0.04, 0.06]]))
    (piece,) = pieces(HOLED, (), bands=bands)
    (bearing,) = bearings(piece, bands)
    assert [bearing.z0, bearing.z1] == pytest.approx([-0.01, 0.01])
    model = LocalModel(piece, piece_mesh(piece, 1.0), STEEL, (), (bearing,))
    forces = trial_forces(model.faces, bearing, shears)
    found = resultants(model.space.nodes, forces.reshape(-1, 3, 6)) * 8.0  # an eighth is meshed
    band, mouths = np.pi * D * 0.02, 2.0 * np.pi * d**2 / 4.0
    areas = (band - mouths, band - mouths) if shears else (band / 2.0 - mouths, band / 2.0)
    assert found[0, 0] == pytest.approx(areas[0], rel=6e-3)
    assert found[1, 1] == pytest.approx(areas[1], rel=6e-3)


def test_a_load_on_what_is_cut_away_needs_its_band() -> None:
    """A shear that grows along the axis leaves a force on the wall: of what lies in the hole."""
    (piece,) = pieces(HOLED, ())
    mesh = piece_mesh(piece, 1.0)
    model = LocalModel(piece, mesh, STEEL)
    stress = np.zeros((*model.faces.images.shape[:2], 6, 1))
    stress[:, :, 4, 0] = model.faces.images[..., 2]
    with raises(SolveError, "cut-unbalanced"):
        model.solve(stress)
    held = LocalModel(piece, mesh, STEEL, (), bearings(piece, loaded_bands(HOLED, ("B",))))
    read = held.solve(stress, 0.0, [False])
    assert np.isfinite(read.stress).all()


def pulled_between_clamps(requirement: Requirement) -> Solution:
    """A hole near one of two clamps, a force along the pin between them."""
    pin = CutPin(TWICE, (Hole(0.025, 0.008, 0.3),))
    loads = PinLoads("pull", ("B",), np.array([[[0.0, 0.0, 40e3]]]))
    return solve_pin(pin, STEEL, ("start", "end"), (loads,), requirement)[0]


@pytest.mark.long
@pytest.mark.slow
def test_a_cut_between_clamps_beside_the_whole_solid() -> None:
    local, solid = (
        pulled_between_clamps(requirement).peak
        for requirement in (Requirement(0.01), Requirement(0.1, "solid"))
    )
    assert (local.model, solid.model) == ("harmonic+local", "solid")
    assert local.max_von_mises == pytest.approx(solid.max_von_mises, rel=0.04)


@pytest.mark.slow
def test_the_side_that_a_cut_makes_softer_takes_less() -> None:
    """By 15 %."""
    local = pulled_between_clamps(Requirement(0.01))
    answer, loads = local.answer, local.loads
    assert isinstance(answer, CutField)
    assert local.peak.max_von_mises is not None
    rigid = max(float(p.largest(loads)[0][0]) for p in answer.solution.pieces)
    assert rigid > 1.1 * local.peak.max_von_mises  # without what the hole's softness changes


def three(band: float) -> Pin:
    """With a band of a length between two others; its middle is 30 mm and half of that on."""
    return Pin(
        "three",
        (
            *(Segment(0.02, D, connection="A"), Segment(0.01, D)),
            *(Segment(band, D, connection="B"), Segment(0.01, D)),
            Segment(0.02, D, connection="C"),
        ),
    )


IN_BAND: dict[str, Cut] = {
    "flat under the load": Flat(0.039, 0.051, 0.0085, 0.0, 0.002),
    "flat in tension": Flat(0.039, 0.051, 0.0085, np.pi, 0.002),
    "keyway under the load": Slot(0.037, 0.053, 0.004, 0.003, 0.0, 0.001),
    "keyway in tension": Slot(0.037, 0.053, 0.004, 0.003, np.pi, 0.001),
    "hole": Hole(0.045, d),
}


@each("name", ["flat under the load", "keyway under the load"])
@each("shears", [True, False])
def test_what_cuts_lose_comes_back_to_round_off(name: str, shears: bool) -> None:
    """Forces and couples on the cut, of a pressure on the side that is cut away, and on the band:
    none is left over, and none acts on the floor of the cut.
    """
    pin = CutPin(three(0.03), [IN_BAND[name]])
    bands = loaded_bands(pin, ("A", "B", "C"))
    assert np.array(bands) == pytest.approx(np.array([[0.03, 0.06]]))
    (piece,) = pieces(pin, (), bands=bands)
    bearing = bearings(piece, bands)
    model = LocalModel(piece, piece_mesh(piece, 1.0), STEEL, (), bearing)
    stress = np.zeros((*model.faces.images.shape[:2], 6, 1))
    stress[:, :, 0, 0] = np.maximum(model.faces.images[..., 0], 0.0) / (D / 2.0)
    (even, *_) = model.parities.split(stress)
    parity = model.parities.classes[0]
    spread, _ = model.relief.of_lost_loads(even, parity, np.array([shears]))
    lost = model.relief._forces(even)
    own = model.parities.rigid(parity)
    assert own.any()
    nodes = model.space.nodes[model.faces.nodes_once]
    both = [resultants(nodes, x.reshape(-1, 3, 1))[own, 0] for x in (lost, spread)]
    assert np.abs(both[0]).max() > 0.0
    assert np.abs(both[0] + both[1]).max() < 1e-10 * np.abs(both[0]).max()
    floor = ~np.isin(model.faces.nodes_once, model.faces.nodes[~model.faces.cut])
    assert floor.any()
    assert not spread.reshape(-1, 3)[floor].any()


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("name", IN_BAND)
def test_a_cut_in_a_loaded_band_beside_the_whole_solid(name: str) -> None:
    """Whose pressure acts on what is left of the band, with the force of the link."""
    forces = 10e3 * np.array([[[1.0, 0.0, 0.0], [-2.0, 0.0, 0.0], [1.0, 0.0, 0.0]]])
    loads = PinLoads("pressed", ("A", "B", "C"), forces, distribution="cosine")
    pin = CutPin(three(0.03), [IN_BAND[name]])
    local, solid = (
        solve_pin(pin, STEEL, (), (loads,), requirement)[0].peak
        for requirement in (Requirement(0.02), Requirement(0.1, "solid", meshes=2))
    )
    assert (local.model, solid.model) == ("harmonic+local", "solid")
    assert local.max_von_mises == pytest.approx(solid.max_von_mises, rel=0.04)
