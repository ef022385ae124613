"""What lets go first: load factors against closed forms, and against runs at other loads."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

import pinstress
from assess.margin import OMITS_CUTS, Margin
from assess.plastic.records import LimitLoad, LugCollapse
from fea.core.places import ContactEdge, ContactPlace, Places, SectionPlace, SurfacePlace
from fea.support.records import LugStress
from reports.data.governing import governing
from reports.data.headline import judged_checks
from reports.data.lets_go import COLLAPSES, LOCAL, PLASTIC, LettingGo, lets_go, steps
from reports.data.results import LugSketch, PinShape
from reports.tables.strength.lets_go import (
    first_sentence,
    lets_go_table,
    not_computed_words,
    shown_steps,
)
from reports.tables.stress.joint import lugs_table
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.once import Shipped
from tests.support.results.made_up_joint import in_lugs, make_joint
from tests.support.results.made_up_run import make_results

FORCE, ARM, WIDTH, DIAMETER, YIELD = 1000.0, 90.0, 20.0, 20.0, 700.0
CANTILEVER = """
title = "cantilever"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "700 MPa"
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  {{ length = 80, diameter = 20 }},
  {{ length = 20, diameter = 20, connection = "B" }},
]
[case.pull]
kind = "given"
forces = {{ B = [0, {force}] }}
[analysis]
model = "beam"
tolerance = 0.3
"""


def ladder_of(folder: Path, text: str) -> tuple[LettingGo, ...]:
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    (pin,) = lets_go(pinstress.run(pinstress.load_study(path)))
    return pin.known


@pytest.fixture(scope="module")
def cantilevers(tmp_path_factory: pytest.TempPathFactory) -> dict[float, tuple[LettingGo, ...]]:
    return {
        force: ladder_of(tmp_path_factory.mktemp("pin"), CANTILEVER.format(force=force))
        for force in (FORCE, 2.0 * FORCE)
    }


def factor_of(ladder: tuple[LettingGo, ...], what: str) -> float:
    (factor,) = [step.load_factor for step in ladder if step.what == what]
    assert factor is not None
    return factor


def test_closed_forms_of_a_cantilever(cantilevers: dict[float, tuple[LettingGo, ...]]) -> None:
    ladder = cantilevers[FORCE]
    modulus, area = math.pi * DIAMETER**3 / 32.0, math.pi * DIAMETER**2 / 4.0
    bending = YIELD / (FORCE * ARM / modulus)
    assert factor_of(ladder, "bending") == pytest.approx(bending, rel=1e-9)
    shear = YIELD / math.sqrt(3.0) / (FORCE / area)
    assert factor_of(ladder, "single shear, mean") == pytest.approx(shear, rel=1e-9)
    bearing = YIELD / (FORCE / (DIAMETER * WIDTH))
    assert factor_of(ladder, "bearing") == pytest.approx(bearing, rel=1e-9)


def test_twice_the_loads_halve_every_load_factor(
    cantilevers: dict[float, tuple[LettingGo, ...]],
) -> None:
    once, twice = cantilevers[FORCE], cantilevers[2.0 * FORCE]
    assert [(s.what, s.at, s.effect) for s in once] == [(s.what, s.at, s.effect) for s in twice]
    for at_once, at_twice in zip(once, twice, strict=True):
        assert at_once.in_proportion
        assert at_twice.in_proportion
        assert at_once.load_factor == pytest.approx(2.0 * (at_twice.load_factor or 0.0), rel=1e-6)


def test_what_lets_go_first_comes_first(cantilevers: dict[float, tuple[LettingGo, ...]]) -> None:
    factors = [step.load_factor or 0.0 for step in cantilevers[FORCE]]
    assert len(factors) > 5
    assert factors == pytest.approx(sorted(factors), rel=1e-9)


SURFACE = SurfacePlace(350.0, 35.0, "converged", (0.0, 1.0, 0.5))
SECTION = SectionPlace(
    280.0, 0.0, "converged", 1.5, None, 0.0, 400.0, 123.4, 0.0, plastic_utilisation=0.25
)
EDGE = ContactEdge("left", "start", 1.0, 0.23, None, 900.0, 560.0, 10.0)
CONTACT = ContactPlace(
    200.0, 10.0, (0.0, 1.0, 0.5), None, None, None,
    (EDGE, replace(EDGE, end="end", max_von_mises=1400.0)), (),
)  # fmt: skip
FREE = LugStress(
    "left", "bore", "free", "steel", 500.0, 500.0, 90.0, 0.5, None, 50.0, 25.0, 20.0, 5.0, 700.0
)


def made_up(lug: LugSketch) -> list[LettingGo]:
    """The steps of a pin of yield strength 700 with the places above, in such a lug."""
    places = Places("surface", SURFACE, SECTION, CONTACT)
    joint = replace(make_joint(), lugs=(FREE, replace(FREE, place="beneath", max_von_mises=1000.0)))
    values = {"max_von_mises": 350.0, "error_estimate": 35.0, "safety_factor": 2.0}
    results = in_lugs(make_results(), joint, places=places, required=1.5, **values)
    limit = LimitLoad("solid", 3.0, 3.5)
    row = replace(results.pins[0], limit_load=limit, margins=(), worst=())
    shape = PinShape("A", ((1.0, 2.0, 0.0, "left", "band"),), "steel", None, lugs=(lug,))
    return steps(row, shape)


LOOSE = LugSketch("left", (0.0, 1.0), 5.0, 0.01, "steel", 0.1)


def test_steps_of_a_pin_and_its_lug() -> None:
    known = [step for step in made_up(LOOSE) if step.load_factor]
    assert [(s.what, s.at, s.effect, s.load_factor) for s in known] == [
        ("pin under the edge of a lug", "left", LOCAL, 0.5),
        ("bore of the lug, where it is pressed", "left", LOCAL, 0.7),
        ("bore of the lug, free side", "left", LOCAL, 1.4),
        ("surface of the pin", "", LOCAL, 2.0),
        ("section of the pin", "", "begins to yield", 2.5),
        ("pin beneath the contact", "", LOCAL, 3.5),
        ("section of the pin", "", PLASTIC, 4.0),
    ]
    surface = known[3]
    assert (surface.low, surface.high) == pytest.approx((700.0 / 385.0, 700.0 / 315.0))
    assert [step.missed for step in known[:4]] == [False, False, True, False]


def test_lugs_that_let_go_together_have_the_ends_of_both() -> None:
    """They had those of the first, so that a lug which may let go too early was not seen."""
    right = replace(FREE, connection="right", error_estimate=100.0)
    joint = replace(make_joint(), lugs=(FREE, right))
    results = in_lugs(make_results(), joint, required=1.2)
    row = replace(results.pins[0], margins=(), worst=())
    (step,) = (x for x in steps(row, None) if x.what == "bore of the lug, free side")
    assert step.at == "left, right"
    assert (step.low, step.high) == pytest.approx((700.0 / 600.0, 700.0 / 400.0))
    assert step.missed


def test_contact_with_clearance_is_not_in_proportion() -> None:
    assert not any(step.in_proportion for step in made_up(LOOSE) if step.load_factor)
    tight = replace(LOOSE, clearance=0.0, edge_radius=0.0)
    assert all(step.in_proportion for step in made_up(tight))


def test_press_fits_have_no_load_factor() -> None:
    of_bushing = made_up(replace(LOOSE, bushing=0.1, interference=0.002))
    assert {s.what for s in of_bushing if "press fit" in s.needs} == {
        "bore of the lug, free side",
        "bore of the lug, where it is pressed",
    }
    of_pin = {"surface of the pin", "pin under the edge of a lug"}  # in which no bushing is pressed
    assert {s.what for s in of_bushing if s.load_factor} > of_pin
    pressed = made_up(replace(LOOSE, clearance=-0.002))
    assert not [step for step in pressed if step.load_factor]


@each("kind", ["band", "plain"])
def test_formulas_of_an_ear_are_those_of_a_link(kind: str) -> None:
    """The ear of a clevis is a band without loads of its own in the row; a named segment in a lug
    of the structure is none.
    """
    margin = Margin("lug, net section", "", "hand", "limit", 1.0, 100.0, 200.0, at="FAR")
    row = replace(make_results().pins[0], joint=make_joint(), margins=(margin,), worst=())
    lug = replace(LOOSE, connection="FAR", clearance=-0.01)
    shape = PinShape("A", ((1.0, 2.0, 0.0, "FAR", kind),), "steel", None, lugs=(lug,))
    (net,) = (step for step in steps(row, shape) if step.what == "lug, net section")
    assert net.load_factor == (2.0 if kind == "band" else None)


def test_a_lug_has_its_limit_load_beside_its_stress() -> None:
    """The lower end of its bracket, N, where one was computed for it."""
    results = in_lugs(make_results(), replace(make_joint(), lugs=(FREE,)))
    for lower in (4.0e5, None):
        collapse = LugCollapse("left", lower, lower and 1.03 * lower)
        pin = replace(results.pins[0], lug_collapses=(LugCollapse("right", 1.0), collapse))
        (row,) = lugs_table(replace(results, pins=(pin, *results.pins[1:]))).records()
        assert row["limit_load"] == lower


def test_what_was_not_computed_is_named() -> None:
    results = make_results()
    row = replace(results.pins[0], limit_load=None)
    unknown = [step for step in steps(row, None) if step.load_factor is None]
    lines = not_computed_words(unknown)
    assert any("limit_load" in line and "limit load of the pin" in line for line in lines)
    needed = {m.needs for m in row.worst if m.needs and m.governs}
    assert all(any(need in line for line in lines) for need in needed)


@pytest.mark.slow
def test_ladder_of_the_clevis(shipped: Shipped) -> None:
    """In files and on the page; sorted; the weakest by formula is the bending of the pin."""
    folder = shipped("clevis")
    ladder = json.loads((folder / "results.json").read_text(encoding="utf-8"))["lets_go"]
    known = [step for step in ladder if step["load_factor"] is not None]
    assert all(a["load_factor"] <= (1.0 + 1e-9) * b["load_factor"] for a, b in pairwise(known))
    assert ladder[: len(known)] == known  # what has no load factor comes last
    assert all(step["needs"] for step in ladder[len(known) :])
    net = next(s for s in known if s["what"] == "lug, net section" and s["required"] == 1.0)
    assert (net["at"], net["in_proportion"]) == ("LEFT, EYE, RIGHT", True)
    assert net["load_factor"] == pytest.approx(700.0 / 95.36429760303544)
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "Order of failure" in page
    assert f"{len(known) - 12} more" in page


@pytest.mark.slow
def test_proportion_of_the_clevis(tmp_path: Path) -> None:
    """At twice the loads: those in proportion exactly, contact within what the note states."""
    text = (ROOT / "studies" / "clevis.toml").read_text(encoding="utf-8")
    once = ladder_of(tmp_path, text)
    twice = ladder_of(tmp_path, re.sub(r"\[(-?\d+), 0\]", lambda m: f"[{2 * int(m[1])}, 0]", text))

    def factors(ladder: tuple[LettingGo, ...], step: LettingGo) -> list[float]:
        """Of the same thing, at one place after another: where shear is largest is a tie."""
        alike = [s for s in ladder if (s.what, s.effect) == (step.what, step.effect)]
        return [s.load_factor or 0.0 for s in alike]

    for step in once:
        at_once, at_twice = factors(once, step), factors(twice, step)
        assert len(at_once) == len(at_twice)
        place = at_once.index(step.load_factor or 0.0)
        ratio = 2.0 * at_twice[place] / at_once[place]
        allowed = 1e-9 if step.in_proportion else 0.35 if "edge" in step.what else 0.01
        assert abs(ratio - 1.0) <= allowed, step.what
    assert sum(step.in_proportion for step in once) > 5
    assert sum(not step.in_proportion for step in once) > 5


def test_collapse_has_a_bracket() -> None:
    margin = Margin(
        "limit load, collapse", "14 CFR 25.305", "collapse", "ultimate", 1.5, 1.0, 3.0, "1"
    )
    row = replace(
        make_results().pins[0], margins=(margin,), limit_load=LimitLoad("solid", 3.0, 3.5)
    )
    crushing = replace(margin, method="case crushing", kind="model", level="limit")
    (yielding,) = steps(replace(row, margins=(crushing,), limit_load=None), None)[:1]
    assert (yielding.what, yielding.effect) == ("case crushing", LOCAL)  # the core beneath it
    (collapse,) = [s for s in steps(row, None) if s.effect == COLLAPSES and s.load_factor]
    assert (collapse.load_factor, collapse.low, collapse.high) == (3.0, 3.0, 3.5)


def test_formulas_that_leave_out_cuts_have_no_load_factor() -> None:
    margin = Margin("bending", "Shigley", "hand", "limit", 1.0, 100.0, 500.0, omits=OMITS_CUTS)
    row = replace(make_results().pins[0], margins=(margin,))
    (bending,) = [step for step in steps(row, None) if step.what == "bending"]
    assert bending.load_factor is None
    assert "with the cuts of the pin" in bending.needs


def test_sentence_and_table() -> None:
    results = make_results()
    first = lets_go(results)[0]
    assert first_sentence(first).startswith("At ")
    assert len(shown_steps(first).rows) == len(first.known)
    keys = {"pin", "case", "what", "load_factor", "clause", "needs", "in_proportion"}
    assert keys <= set(lets_go_table(results).keys)


def test_equal_factors_keep_their_order_in_any_units() -> None:
    """Each check has twice what it needs, which round-off makes more or less in other units."""
    row = make_results().pins[0]
    names = ["bending", "shear", "bearing", "crushing"]
    for allowables in ([200.0, 200.0 * (1 - 1e-15), 200.0 * (1 + 1e-15), 200.0], [200.0] * 4):
        margins = tuple(
            Margin(name, "", "hand", "limit", 1.0, 100.0, allowable)
            for name, allowable in zip(names, allowables, strict=True)
        )
        every = replace(row, margins=margins, worst=margins)
        assert [s.what for s in steps(every, None) if s.what in names] == names
        results = replace(make_results(), pins=(every,))
        assert [m.margin.method for m in governing(results)] == ["bending"]
        checks = [c.check for c in judged_checks(results) if c.check in names]
        assert checks == names
