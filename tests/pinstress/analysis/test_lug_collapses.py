"""Limit loads of lugs are found where they are requested, and say what they lack."""

from pathlib import Path

import pytest

from pinstress import load_study
from pinstress.analysis.assessed.limits import lug_collapses
from pinstress.analysis.plan import Plan, prepare

CLEVIS = Path("studies/clevis.toml")
SHANK = 'shank = { shape = "square", width = 50, length = 60, end = 30 }'


def _plan(folder: Path, requested: str, shank: str = SHANK, limit_load: bool = False) -> Plan:
    text = CLEVIS.read_text(encoding="utf-8")
    text = text.replace("[analysis]", f"[analysis]\nlimit_load = {requested}", 1)
    text = text.replace("outer_diameter = 50", f"outer_diameter = 50\n{shank}", 1)
    path = folder / "clevis.toml"
    path.write_text(text, encoding="utf-8")
    return prepare(load_study(path), limit_load=limit_load)


def _found(plan: Plan) -> dict[str, tuple[float | None, float | None, str]]:
    limits = lug_collapses(plan, plan.tasks[0], lambda _: None)
    return {x.connection: (x.lower, x.upper, x.needs) for x in limits}


@pytest.mark.slow
def test_lugs_carry_in_proportion_to_their_thickness(tmp_path: Path) -> None:
    """10, 20 and 10 mm; between yield of the bore's projected area and three times as much."""
    found = _found(_plan(tmp_path, '["P"]'))
    for lower, upper, needs in found.values():
        assert not needs
        assert lower is not None
        assert upper is not None
        assert lower < upper < 1.035 * lower
    left, eye = (found[name][0] or 0.0 for name in ("LEFT", "EYE"))
    assert eye == pytest.approx(2.0 * left)
    (task,) = _plan(tmp_path, '["P"]').tasks
    strength = next(x.material.yield_strength for x in task.given) or 0.0
    assert 1.0 < left / (strength * 0.02 * 0.01) < 3.0


def test_nothing_is_found_that_is_not_requested(tmp_path: Path) -> None:
    for requested in ('"auto"', '"never"'):
        assert not _found(_plan(tmp_path, requested))


def test_a_lug_without_a_shank_says_what_it_lacks(tmp_path: Path) -> None:
    for plan in (_plan(tmp_path, '"always"', ""), _plan(tmp_path, '"auto"', "", True)):
        assert _found(plan)["EYE"] == (None, None, "pin.P.lug.EYE.shank")
