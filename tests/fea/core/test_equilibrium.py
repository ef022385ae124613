"""A stiffness that resists moving a section as a whole gives no answer."""

from __future__ import annotations

import pytest
import scipy.sparse as sp

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import UnitLoad
from fea.harmonic.assembly import Section
from fea.harmonic.model import HarmonicModel
from geometry import Pin
from geometry.mesh.section_mesh import SectionSize, meridian_mesh
from tests.support.errors import raises


@pytest.mark.parametrize("n", [0, 1])
def test_a_stiffness_with_a_wrong_diagonal_is_refused(
    monkeypatch: pytest.MonkeyPatch, cantilever_pin: Pin, steel: Material, n: int
) -> None:
    section = meridian_mesh(cantilever_pin, SectionSize(), [])
    model = HarmonicModel(cantilever_pin, section, steel, ("start",))
    load = UnitLoad("P1", "force", n)
    model.solve((load,))
    right = Section.stiffness

    def wrong(self: Section, material: Material, n: int) -> object:
        K = right(self, material, n)
        return (K + 1e-6 * sp.diags_array(K.diagonal())).tocsr()

    monkeypatch.setattr(Section, "stiffness", wrong)
    with raises(SolveError, "no-equilibrium"):
        model.solve((load,))
