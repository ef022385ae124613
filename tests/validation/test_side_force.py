"""The main job with a side force on its tyre, from the study to rows, in contact with lugs."""

from pathlib import Path

import pytest

import pinstress
from pinstress.study.reading.file import load_study
from tests.conftest import ROOT

SIDE = """
[case.side]
kind = "static"
position = 30.70

[[case.side.apply]]
body = "tyre"
at = "J"
force = [0, 20000, 5000]
"""


def _study(folder: Path, more: str = SIDE) -> pinstress.Study:
    text = (ROOT / "studies" / "landing_gear.toml").read_text(encoding="utf-8")
    # Tables of its own before those that a copied study would need files for.
    text = text.split("[published]")[0] + "[mechanism]" + text.split("[mechanism]", 1)[1]
    path = folder / "gear.toml"
    path.write_text(text + more, encoding="utf-8")
    return load_study(path)


@pytest.mark.slow
def test_pins_carry_all_six_components(tmp_path: Path) -> None:
    """E is floating, A fixed in the ground and without a shoulder; others are as without it."""
    results = pinstress.run(_study(tmp_path), pins=["A", "E"], cases=["landing", "side"])
    rows = {(row.pin, row.case): row for row in results.pins}
    alone = pinstress.run(_study(tmp_path, ""), pins=["E"], cases=["landing"])
    for row in alone.pins:
        both = rows[row.pin, "landing"]
        assert both.verdict == row.verdict == "converged"
        assert both.max_von_mises == pytest.approx(row.max_von_mises, rel=0.01)
        assert both.sharing is None
    for pin in "AE":
        row = rows[pin, "side"]
        assert row.max_von_mises
        assert row.verdict in ("converged", "unconverged")
        assert row.sharing is not None
        low, high = row.sharing.max_von_mises
        assert low < row.max_von_mises < high
        needs = [margin.needs for margin in row.worst if margin.needs]
        assert "a check of lugs under forces along the pin and moments of their links" in needs
    assert "forces along the axis: that of A on its own band" in rows["A", "side"].note
