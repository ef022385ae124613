"""Pins in lugs beside CalculiX's contact in three dimensions, on meshes and decks written apart
from the program.

CalculiX 2.20: C3D20R, half or a quarter of the joint, 10 to 15 degrees to an element, lugs with
their shanks clamped where they end, contact of 200 E / d between meshes that match, loads and
clearances scaled by 0.01. The stress in the fillet and in the bore is of the pin alone on finer
elements, under the forces of that contact. Moments are good for 0.5 %, stresses for 2 %.

The cantilever's is the largest difference: its rod is pulled by its shank, which lets an eye tilt
more than its outline says (`python -m benchmarks shanks`); with 0.79 of that stiffness the moments
are the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

import pinstress

HEAD = """
title = "Beside CalculiX"
units = "mm-N-s"
material.steel = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, yield_strength = "700 MPa" }
material.aluminium = { youngs_modulus = "70 GPa", poisson_ratio = 0.33, yield_strength = "400 MPa" }
analysis = { joints = "contact" }
pin.P.material = "steel"
"""


@dataclass(frozen=True)
class Joint:
    """A joint, and CalculiX's largest moment, N mm, and largest stress, MPa.

    segments: of the pin, mm: length, diameter, what else a segment has.
    """

    segments: tuple[tuple[float, float, str], ...]
    forces: str
    lugs: str
    moment: float
    stress: float

    @property
    def text(self) -> str:
        rows = [f"{{ length = {z}, diameter = {d}{more} }}" for z, d, more in self.segments]
        return (
            f"{HEAD}pin.P.profile = [{', '.join(rows)}]\n{self.lugs}\n"
            f'[case.pull]\nkind = "given"\nforces = {{ {self.forces} }}\n'
        )


def _on(name: str) -> str:
    return f', connection = "{name}"'


USUAL = "lug_defaults.outer_diameter = 50\nlug_defaults.shank = { length = 50 }\n"
CLEVIS = "LEFT = [-25000, 0], EYE = [50000, 0], RIGHT = [-25000, 0]"
GUIDED = 'pin.P.lug.EYE.tilt = "guided"'
WIDTHS = (2, ""), (10, "LEFT"), (1, ""), (20, "EYE"), (1, ""), (10, "RIGHT"), (2, "")
JOINTS = {
    "hollow pin": Joint(
        tuple((z, 20, (_on(name) if name else "") + ", bore = 12") for z, name in WIDTHS),
        CLEVIS, USUAL + GUIDED, 216_600.0, 635.0,
    ),
    "aluminium lugs, clearance of 0.5 %": Joint(
        tuple((z, 20, _on(name) if name else "") for z, name in WIDTHS),
        "LEFT = [-10000, 0], EYE = [20000, 0], RIGHT = [-10000, 0]",
        USUAL + 'lug_defaults.material = "aluminium"\nlug_defaults.clearance = 0.1\n' + GUIDED,
        103_900.0, 133.6,
    ),
    "unequal sides": Joint(
        ((2, 20, ""), (8, 20, _on("L")), (1, 20, ""), (16, 20, _on("EYE")), (1, 20, ""),
         (14, 20, _on("R")), (2, 20, "")),
        "L = [-28000, 0], EYE = [50000, 0], R = [-22000, 0]", USUAL, 226_800.0, 301.0,
    ),
    "fillet beside a lug": Joint(
        ((2, 20, ""), (12, 20, _on("L")), (1, 20, ""), (21, 20, _on("EYE")),
         (0.5, 20, ", fillet = 1.5"), (1.7, 17, ""), (10, 17, _on("R")), (2, 17, "")),
        "L = [-20000, 0], EYE = [40000, 0], R = [-20000, 0]", USUAL, 202_000.0, 488.0,
    ),
    "cantilever in a thick lug": Joint(
        ((2, 20, ""), (40, 20, ', name = "BASE"'), (2, 20, ""), (12, 20, _on("ROD")), (2, 20, "")),
        "ROD = [10000, 0]",
        "pin.P.lug.BASE = { outer_diameter = 60, shank = { length = 60 } }\n"
        "pin.P.lug.ROD = { outer_diameter = 40, shank = { length = 60 } }\n",
        85_460.0, 108.3,
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", JOINTS)
def test_joints_are_bent_and_stressed_as_calculix_says(name: str, tmp_path: Path) -> None:
    joint = JOINTS[name]
    study = tmp_path / "joint.toml"
    study.write_text(joint.text, encoding="utf-8")
    (row,) = pinstress.run(pinstress.load_study(study)).pins
    assert row.joint is not None
    assert row.joint.bending_moment == pytest.approx(joint.moment, rel=0.022)
    assert row.max_von_mises == pytest.approx(joint.stress, rel=0.023)
