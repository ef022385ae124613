"""Shoulder fillets in tension: the harmonic model beside values that CalculiX found.

Reference: CalculiX 2.20, axisymmetric elements, `python -m benchmarks tension`; W. D. Pilkey, D. F.
Pilkey, Peterson's Stress Concentration Factors, for the chart. Tolerance 0.3 %: what the two meshes
leave of error, each some 0.1 %.
"""

from __future__ import annotations

import pytest

from benchmarks.pins.shoulders import KINDS, run, shoulder
from geometry.mesh.section_mesh import SectionSize
from tests.support.each import each

# CalculiX 2.20, CAX6, 71,000 and 82,000 unknowns: `python -m benchmarks tension`.
# D/d, r/d, largest principal and von Mises stress over the nominal stress
CALCULIX = [(1.25, 0.0125, 3.9634, 3.5601), (3.0, 0.1, 2.2832, 2.0472)]


@each(("ratio", "radius", "principal", "mises"), CALCULIX)
def test_factors_are_those_of_calculix(
    ratio: float, radius: float, principal: float, mises: float
) -> None:
    """Within 0.3 %; Peterson's chart is 21 % and 11 % below (fea.beam.stress_concentration)."""
    found = run(shoulder(ratio, radius), SectionSize(6.0, 14.0, 0.3))
    tension = KINDS.index("tension")
    assert found.principal[tension] == pytest.approx(principal, rel=0.003)
    assert found.von_mises[tension] == pytest.approx(mises, rel=0.003)
