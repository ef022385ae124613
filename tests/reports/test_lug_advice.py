"""What to change in a lug that fails: in words, and by solving the changed joint again."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import pinstress
from assess.margin import Margin
from assess.strength.fatigue_life import FATIGUE_LIFE
from assess.work import WorkQuantity
from reports.data.overview import PinLine, pin_lines
from reports.data.results import LugSketch, Results
from reports.format.words import headline
from reports.tables.strength.overview import check_words
from reports.text.lug_advice import lug_advice, lug_peaks
from reports.text.overview import actions
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.pins.remembered import remembered
from tests.support.results.made_up_run import make_results
from tests.support.results.rows import with_values
from tests.support.study_text import edited

STRESS = Margin(
    "lug, von Mises stress at the bore", "14 CFR 25.305", "model", "limit", 2.0, 50e3, 80e3,
    at="L", z=0.5,
)  # fmt: skip
CLAUSE = Margin(
    "BTH-1 plate, tension", "ASME BTH-1", "clause", "limit", 1.0, 1200.0, 1000.0, "force", "L",
    passing=WorkQuantity("outer_diameter", 3.25, "length"),
)  # fmt: skip


def failing(margin: Margin) -> tuple[Results, list[PinLine]]:
    """A pin of 1 in a lug of 2.5 by 1 in, whose margin is the worst of its checks."""
    results = make_results()
    row = with_values(
        results.pins[0], safety_factor=9.0, required=2.0, decided=True, safety_factor_interval=None,
        verdict="converged",
    )  # fmt: skip
    row = replace(row, worst=(margin,), margins=(margin,), depends_on=())
    lug = LugSketch("L", (0.0, 1.0), 2.5, 0.0, "steel")
    shape = replace(
        results.shapes[0], pin=row.pin, segments=((1.0, 1.0, 0.0, "L", "band"),), lugs=(lug,)
    )
    results = replace(results, pins=(row,), shapes=(shape,), changes=(), stated=())
    return results, pin_lines(results)


def test_a_lug_that_is_loaded_evenly() -> None:
    """Used 1.25: thickness by that, W/D - 1 by its power 1 / 0.675, strength by that."""
    (text,) = lug_advice(*failing(STRESS))
    wide = 1.0 + 1.5 * 1.25 ** (1.0 / 0.675)
    assert text == (
        "Lug L of A (factor 1.60 at the bore) needs a thickness of 1.25 in (now 1.00), an eye of "
        f"{wide:.2f} in (now 2.50) or a yield strength of 100,000 psi."
    )


def test_a_lug_whose_face_a_bending_pin_loads() -> None:
    (text,) = lug_advice(*failing(replace(STRESS, z=0.95)))
    assert "thickness" not in text
    assert "a stiffer pin, of 1.25 in (now 1.00), in an eye of 3.12 in (now 2.50)" in text


@each(("used", "needs"), [(1.25, "a yield strength of 100,000 psi"), (9.0, "less interference or")])
def test_no_size_takes_off_the_stress_of_a_press_fit(used: float, needs: str) -> None:
    """Thickness and width were named as for stress that grows with the load alone."""
    results, lines = failing(replace(STRESS, demand=50e3 * used / 1.25))
    (shape,) = (x for x in results.shapes if x.lugs)
    lugs = tuple(replace(x, bushing=0.1, interference=0.002) for x in shape.lugs)
    results = replace(results, shapes=(replace(shape, lugs=lugs),))
    (text,) = lug_advice(results, lines)
    assert f" needs {needs}" in text
    assert "thickness" not in text


def test_a_bushing_and_the_hole_about_it_need_strengths_of_their_own() -> None:
    """The strength that the bushing needs was told of the lug, whose own wall fails, too; a lug
    that fails in two cases was named twice.
    """
    bushing = replace(STRESS, method=f"{STRESS.method}, bushing", demand=50e3)
    hole = replace(STRESS, method=f"{STRESS.method}, hole", demand=60e3, allowable=100e3)
    results, _ = failing(bushing)
    lugs = tuple(
        replace(x, bushing=0.1, interference=0.002) for s in results.shapes for x in s.lugs
    )
    shapes = tuple(replace(s, lugs=lugs) if s.lugs else s for s in results.shapes)
    cold = replace(results.pins[0], worst=(bushing, hole), margins=(bushing, hole))
    hot = with_values(cold, case="hot")
    results = replace(results, pins=(cold, hot), shapes=shapes)
    lines = pin_lines(results)
    assert check_words(lines[0]) == "lug L, bushing: 1.60 of 2"
    assert lug_advice(results, lines) == [
        "The bushing of lug L of A (factor 1.60 at the bore) needs a yield strength of 100,000 "
        "psi.",
        "Lug L of A (factor 1.67 at the hole about its bushing) needs a yield strength of 120,000 "
        "psi.",
    ]
    assert lug_peaks(lines, results.units) == (
        "At the bore of lug L (bushing) 50,000 psi (with error)."
    )


def test_every_lug_of_the_pin_that_fails_is_told() -> None:
    """The worst alone was, so that its twin was found to fail only after it was mended."""
    clause = replace(CLAUSE, at="N")
    results, _ = failing(STRESS)
    row = replace(
        results.pins[0],
        worst=(STRESS, clause),
        margins=(STRESS, replace(STRESS, at="M"), clause, replace(CLAUSE, factor=0.8)),
    )
    (shape,) = (x for x in results.shapes if x.lugs)
    (lug,) = shape.lugs
    twin, other = (replace(lug, connection=name) for name in "MN")
    results = replace(results, pins=(row,), shapes=(replace(shape, lugs=(lug, twin, other)),))
    both, third = lug_advice(results, pin_lines(results))
    assert both.startswith("Lugs L and M of A (factor 1.60 at the bore) need a thickness of 1.25 ")
    assert third.startswith("Lug N of A (factor 0.833 BTH-1 plate, tension) needs an eye of 3.25")


def test_a_joint_that_is_much_too_small() -> None:
    """Of 16 times the stress no eye is free: all of the joint 4 times as large."""
    results, lines = failing(replace(STRESS, demand=640e3))
    (text,) = lug_advice(results, lines)
    assert "pin, eye and thickness about 4.0 times as large" in text
    assert lug_peaks(lines, results.units) == "At the bore of lug L 640,000 psi (with error)."


def test_a_clause_gives_the_dimension_that_passes() -> None:
    (text,) = lug_advice(*failing(CLAUSE))
    assert text == (
        "Lug L of A (factor 0.833 BTH-1 plate, tension) needs an eye of 3.25 in or 20 % more "
        "strength."
    )


def test_first_screen_names_the_lug() -> None:
    results, lines = failing(STRESS)
    assert check_words(lines[0]) == "lug L, bore: 1.60 of 2"
    assert not any("more strength" in text for text in actions(results, lines).repairs)
    second = with_values(results.pins[0], pin="B")
    both = replace(results, pins=(results.pins[0], second))
    assert headline(both) == f"2 of 2 pins fail ({second.case}): A (lug L), B (lug L)."


def test_a_pin_that_fails_by_itself_gets_no_advice_on_lugs() -> None:
    of_pin = replace(STRESS, method="bending", at="L")
    assert lug_advice(*failing(of_pin)) == []


def clevis(folder: Path, required: float, **sizes: float) -> Results:
    """The clevis with shanks; sizes of the pin, its eyes, and the thickness of side and middle."""
    text = (ROOT / "studies" / "clevis.toml").read_text(encoding="utf-8")
    size = {"pin": 20.0, "eye": 50.0, "side": 10.0, "middle": 20.0} | sizes
    changes = {
        "required_safety_factor = 1.5": f"required_safety_factor = {required}",
        "outer_diameter = 50": f"outer_diameter = {size['eye']}\nshank = {{}}",
        "{ length = 10, diameter = 20": f"{{ length = {size['side']}, diameter = 20",
        "{ length = 20, diameter = 20": f"{{ length = {size['middle']}, diameter = 20",
        "diameter = 20,": f"diameter = {size['pin']},",
        "diameter = 20 }": f"diameter = {size['pin']} }}",
    }
    path = folder / "clevis.toml"
    path.write_text(edited(text, changes.items()), encoding="utf-8")
    return remembered(pinstress.load_study(path))


def advised(results: Results, lug: str) -> dict[str, float]:
    """The numbers of the advice on a lug, by the words before them."""
    (text,) = [x for x in lug_advice(results, pin_lines(results)) if x.startswith(f"Lug {lug}")]
    words = "a thickness of", "an eye of", "a stiffer pin, of"
    return {w: float(m[1]) for w in words if (m := re.search(rf"{w} ([\d.]+)", text))}


def least(results: Results, lug: str) -> float:
    """The factor of a lug at its bore, with its error."""
    stresses = results.pins[0].joint.lugs  # type: ignore[union-attr]
    return min(
        (x.yield_strength or 0.0) / (x.max_von_mises + x.error_estimate)
        for x in stresses
        if x.connection == lug and x.place == "free"
    )


@pytest.mark.slow
def test_a_stiffer_pin_in_a_wider_eye_is_enough(tmp_path: Path) -> None:
    """The slender pin of the clevis loads the faces."""
    given = advised(clevis(tmp_path, 2.6), "EYE")
    assert set(given) == {"a stiffer pin, of", "an eye of"}
    changed = clevis(tmp_path, 2.6, pin=given["a stiffer pin, of"], eye=given["an eye of"])
    assert least(changed, "EYE") > 2.6


@pytest.mark.long
@pytest.mark.slow
def test_a_thicker_lug_of_a_slender_pin_is_not_enough(tmp_path: Path) -> None:
    """At 1.42 times the thickness."""
    assert least(clevis(tmp_path, 2.6, middle=28.4), "EYE") < 2.6


@pytest.mark.long
@pytest.mark.slow
def test_a_thicker_lug_or_a_wider_eye_is_enough_of_a_stiff_pin(tmp_path: Path) -> None:
    stiff = {"pin": 40.0, "eye": 100.0}
    given = advised(clevis(tmp_path, 6.0, **stiff), "EYE")
    thick = given["a thickness of"]
    thicker = clevis(tmp_path, 6.0, **stiff, middle=thick, side=thick / 2.0)
    assert least(thicker, "EYE") == pytest.approx(6.0, rel=0.04)
    wider = clevis(tmp_path, 6.0, pin=40.0, eye=given["an eye of"])
    assert least(wider, "EYE") == pytest.approx(6.0, rel=0.04)


def test_a_check_that_fails_in_two_cases_is_advised_once() -> None:
    results, (line, *_) = failing(replace(STRESS, method="bending", at="L"))
    worse = replace(line, check=replace(line.check, used=2.0 * line.check.used))
    (told,) = (x for x in actions(results, [line, worse]).repairs if "more strength" in x)
    share = 100.0 * (2.0 * line.check.used - 1.0)
    assert told == f"A needs {share:.0f} % more strength, or less load (bending)."


def test_a_life_that_is_too_short_is_no_lack_of_strength() -> None:
    """Of a life of 0.0654 it said that 1,400 % more strength are needed, where 73 % are enough."""
    results, (line, *_) = failing(replace(STRESS, method=FATIGUE_LIFE, at="point 1"))
    line = replace(line, check=replace(line.check, used=1.0 / 0.0654))
    (told,) = actions(results, [line]).repairs
    assert told == "A needs 15.3 times the life that it has (fatigue life)."
