"""The stress at the bores of a clevis's lugs, beside CalculiX's contact in three dimensions.

CalculiX 2.20 had the lugs with their shanks, 50 mm wide and clamped 50 mm away: a quarter of the
joint, C3D20R, 48 elements around the bores, 5 and 6 through the thickness of half the eye and of a
side of the fork, finest at their faces, contact of 500 E / d, loads and clearance scaled by 0.01;
edges of the bores sharp. One mesh, whose extrapolation to nodes beside the end of contact is good
for about 2 %: 337 MPa at the eye, 1.5 mm inside its face and 112.5 degrees from its shank; 349 MPa
at the sides, 1 mm inside of their inner faces at the same angle.

Why we differ. Hoop stress plus pressure of each ring agrees within 2 % at the eye. But near its
faces, which carry twice the mean load, the pin presses on a wider arc than the plane lug's, and
hoop stress is read 7 degrees further beneath the pin, where the sum is larger: safe. The sides of
the fork bend as their shanks do (fea.lug.shank_bending), without which they were 5 % low.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import pinstress

STUDY = Path(__file__).parents[2] / "studies" / "clevis.toml"
CALCULIX = {"EYE": 337.0, "LEFT": 349.0, "RIGHT": 349.0}  # MPa
CLOSE = {"EYE": 0.08, "LEFT": 0.02, "RIGHT": 0.02}  # +6.9 % and -0.3 % measured
MESH = 0.02  # of CalculiX's


@pytest.mark.slow
def test_the_lugs_of_a_clevis_are_stressed_as_calculix_says(tmp_path: Path) -> None:
    text = STUDY.read_text(encoding="utf-8")
    lugs = 'edge_radius = 0\nshank = { shape = "round", length = 50 }'
    assert "edge_radius = 0.5" in text
    study = tmp_path / "clevis.toml"
    study.write_text(text.replace("edge_radius = 0.5", lugs), encoding="utf-8")
    joint = pinstress.run(pinstress.load_study(study)).pins[0].joint
    assert joint is not None
    free = {lug.connection: lug for lug in joint.lugs if lug.place == "free"}
    assert set(free) == set(CALCULIX)
    for name, lug in free.items():
        theirs = CALCULIX[name]
        assert lug.max_hoop_stress == pytest.approx(theirs, rel=CLOSE[name]), name
        assert abs(lug.max_hoop_stress - theirs) < lug.error_estimate + MESH * theirs, name
