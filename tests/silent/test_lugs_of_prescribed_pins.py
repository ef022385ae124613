"""Lugs that a study gives are known to every check, whatever holds the pin.

With `joints = "prescribed"` they were not: bearing by EN 1993 took the yield strength of the pin,
700 MPa, for that of the lug, 400 MPa, and said "no lug given"; net section, shear-out and bearing
of the lugs were not made, and nothing said so.

Independent values: sums on paper, next to each.
"""

from __future__ import annotations

import copy
import math
from typing import Any

import pytest

from pinstress import InputError, run, study_from
from reports.data.requirements import requirement_rows
from reports.data.results import Results

F, W, D, T = 50e3, 50.0, 20.0, 20.0  # N; of the middle lug: outer diameter, bore, thickness, mm
CUT = {"hole": [{"z": 21, "diameter": 4}]}


def study(joints: str, lug: dict[str, Any], **pin: Any) -> dict[str, Any]:
    """A fork and an eye of another steel than the pin's, of whose lugs the sizes are given."""
    elastic = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
    pulled, pushed = ({"L": -f / 2, "M": f, "R": -f / 2} for f in (F, -F / 2))
    profile = [
        {"length": 10, "diameter": D, "connection": "L"},
        {"length": 1, "diameter": D},
        {"length": T, "diameter": D, "connection": "M"},
        {"length": 1, "diameter": D},
        {"length": 10, "diameter": D, "connection": "R"},
    ]
    lugs = {name: {"outer_diameter": W, "material": "soft", **lug} for name in "LMR"}
    return {
        "title": "A fork and an eye",
        "units": "mm-N-s",
        "material": {
            "hard": {**elastic, "yield_strength": "700 MPa"},
            "soft": {**elastic, "yield_strength": "400 MPa"},
            "bronze": {**elastic, "youngs_modulus": "110 GPa", "yield_strength": "150 MPa"},
        },
        "analysis": {"joints": joints, "tolerance": 0.5, "limit_load": "never"},
        "case": {
            "pull": {"kind": "given", "forces": {k: [f, 0] for k, f in pulled.items()}},
            "push": {"kind": "given", "forces": {k: [0, f] for k, f in pushed.items()}},
        },
        "pin": {"P": {"material": "hard", "profile": profile, "lug": lugs, **pin}},
    }


def bearing_by_eurocode(found: Results, case: str = "pull") -> tuple[float | None, str]:
    """Allowable, N, and its basis."""
    (margin,) = [
        m.margin for m in found.margins if m.margin.method == "EN 1993 bearing" and m.case == case
    ]
    return margin.allowable, margin.basis


def of_lugs(found: Results, case: str) -> dict[tuple[str, str], float]:
    """Stresses of the checks of lugs, MPa."""
    return {
        (c.method, c.at): c.demand or 0.0
        for c in found[("P", case)].hand_checks
        if "lug" in c.method
    }


@pytest.mark.parametrize(
    ("joints", "pin"),
    [
        ("prescribed", {}),
        ("foundation", {}),
        pytest.param("prescribed", CUT, marks=pytest.mark.slow),
        pytest.param("contact", CUT, marks=[pytest.mark.slow, pytest.mark.long]),
    ],
)
def test_lugs_are_checked_with_their_own_strength(joints: str, pin: dict[str, Any]) -> None:
    """1.5 t d f_y of the softer one: 1.5 x 10 x 20 x 400 N. F / (2 t b_eff) with 0.6 sqrt(D/b) of b
    (W - D)/2, as no ultimate strength is given, F / (d t), and in
    shear-out two planes of (sqrt(W^2 - (D sin 40)^2) - D cos 40) / 2; half in the other case.
    """
    found = run(study_from(study(joints, {}, **pin)), tolerance=0.5)
    allowable, basis = bearing_by_eurocode(found)
    assert allowable == pytest.approx(120e3)
    assert not basis
    forty = math.radians(40.0)
    net_stress = F / ((W - D) * T) / (0.6 * math.sqrt(2.0 * D / (W - D)))
    planes = math.sqrt(W**2 - (D * math.sin(forty)) ** 2) - D * math.cos(forty)
    for case, part in (("pull", 1.0), ("push", 0.5)):
        stress = of_lugs(found, case)
        assert len(stress) == 9
        names = {check.method for check in found["P", case].hand_checks}
        assert ("bending, joint model" in names) is (joints != "prescribed")
        assert stress["lug, net section", "M"] == pytest.approx(part * net_stress)
        assert stress["lug, shear-out", "L"] == pytest.approx(part * F / 2.0 / (planes * 10.0))
        assert stress["lug, bearing", "R"] == pytest.approx(part * F / 2.0 / (D * 10.0))
        (net,) = [
            m.margin
            for m in found.margins
            if m.margin.method == "lug, net section" and m.case == case and not m.margin.needs
        ]
        assert net.margin == pytest.approx(400.0 / (part * net_stress) - 1.0)


def test_the_pin_bears_on_the_bushing_and_a_hollow_one_as_well() -> None:
    """1.5 x 10 x 20 x 150 N: of bronze; the bore of the lug is wider by twice its thickness."""
    lug = {"bushing": {"thickness": 2, "material": "bronze"}}
    whole = study("prescribed", lug)
    hollow = copy.deepcopy(whole)
    for segment in hollow["pin"]["P"]["profile"]:
        segment["bore"] = 8
    for found in (run(study_from(whole)), run(study_from(hollow))):
        assert bearing_by_eurocode(found)[0] == pytest.approx(45e3)
        stress = of_lugs(found, "pull")
        used = 0.6 * math.sqrt(2.0 * (D + 4.0) / (W - D - 4.0))
        assert stress["lug, net section", "M"] == pytest.approx(F / ((W - D - 4.0) * T) / used)
        assert stress["lug, bearing", "M"] == pytest.approx(F / ((D + 4.0) * T))


def test_a_required_bearing_is_that_of_the_bushing_too() -> None:
    """50,000 over 20 x 20 is 125 MPa on bronze of 150 MPa: 1.2, where the steel of pin and lug has
    400 x 24 x 20 / 50,000 = 3.84 and was said to meet 3.
    """
    whole = study("prescribed", {"bushing": {"thickness": 2, "material": "bronze"}})
    whole["require"] = [{"check": "bearing", "factor": 3.0, "cases": ["pull"]}]
    found = run(study_from(whole))
    assert of_lugs(found, "pull")["lug, bearing, bushing", "M"] == pytest.approx(F / (D * T))
    (row,) = (x for x in requirement_rows(found) if x.stated)
    assert row.outcome == "missed"
    assert row.reached == pytest.approx(1.2)


@pytest.mark.parametrize("code", ["general", "aircraft", "lifting", "civil"])
def test_requirements_are_on_lugs_under_every_code(code: str) -> None:
    """25,000 over 10 x 20 is 125 MPa on lugs of 400 MPa: 3.2, where the pin has 700 / 125 = 5.6.
    Under codes other than "general" 5.6 was said to meet 4, and the shear of pins alone 2.5.
    """
    whole = study("prescribed", {"outer_diameter": 30})
    whole["analysis"]["code"] = code
    whole["require"] = [{"check": "bearing", "factor": 4.0}, {"check": "shear", "factor": 2.5}]
    found = {
        x.check: x for x in requirement_rows(run(study_from(whole), cases=["pull"])) if x.stated
    }
    forty = math.radians(40.0)
    planes = math.sqrt(30.0**2 - (D * math.sin(forty)) ** 2) - D * math.cos(forty)
    out = F / (planes * T)
    assert [found[x].outcome for x in ("bearing", "shear")] == ["missed", "missed"]
    assert found["bearing"].reached == pytest.approx(3.2)
    assert found["shear"].reached == pytest.approx(400.0 / math.sqrt(3.0) / out)


def test_a_requirement_on_a_lug_without_a_size_is_not_checked() -> None:
    """It was met by the pin's own numbers."""
    whole = study("prescribed", {})
    del whole["pin"]["P"]["lug"]["M"]["outer_diameter"]
    whole["require"] = [{"check": "bearing", "factor": 1.0}]
    rows = [x for x in requirement_rows(run(study_from(whole))) if x.stated]
    assert [x.case for x in rows] == ["pull", "push"]
    for row in rows:
        assert (row.outcome, row.needs) == ("not checked", "pin.P.lug.M.outer_diameter")


def test_a_lug_that_is_not_given_is_still_said_to_be_none() -> None:
    given = study("prescribed", {})
    given["pin"]["P"]["lug"] = {"M": given["pin"]["P"]["lug"]["M"]}
    allowable, basis = bearing_by_eurocode(run(study_from(given)))
    assert allowable == pytest.approx(1.5 * 20.0 * 20.0 * 400.0)  # at M: 50 of 240, not 25 of 210
    assert basis == "strength of the pin alone at L, R: no lug given"


def test_a_lug_at_a_clamp_is_not_left_out_without_a_word() -> None:
    """Its force is what the clamp takes, which no formula has."""
    given = study("prescribed", {}, clamp=["L", "R"])
    found = run(study_from(given))
    assert {at for _, at in of_lugs(found, "pull")} == {"M"}
    lacking = {m.margin.method for m in found.margins if "clamp" in m.margin.needs}
    assert lacking == {f"lug of {x}: net section, shear-out, bearing" for x in "LR"}


@pytest.mark.parametrize(
    ("lug", "code"),
    [({"outer_diameter": 20}, "lug-too-narrow"), ({"clearance": 30}, "clearance-too-large")],
)
def test_a_lug_that_cannot_be_is_refused_before_anything_is_solved(
    lug: dict[str, Any], code: str
) -> None:
    with pytest.raises(InputError) as caught:
        run(study_from(study("prescribed", lug)))
    assert caught.value.code == code


def test_an_interference_that_no_stress_has_is_said() -> None:
    """Pressed lugs, prescribed loads: fatigue would take the assembly stress for what it has."""
    given = study("prescribed", {"clearance": -0.005})
    given["fatigue"] = {"occurrences": {"pull": 1}}
    curve = {"knee_stress": "300 MPa", "knee_cycles": 1e6, "slope": 5, "mean_stress": "none"}
    given["material"]["hard"]["fatigue"] = curve
    found = run(study_from(given)).fatigue
    assert found is not None
    (said,) = [x for x in found.left_out if "interference" in x]
    assert said == (
        "Assembly stress of interference fits is left out where loads are prescribed: pin P."
    )
