"""Formulas of a pin whose joint was solved take its own moments, shear forces and reactions.

hand_checks.csv had the bending moment of even loads, 37.9 MPa, as "bending", where the joint itself
has 69.4 MPa: one of two lugs was guided, and the couple that it carries was shared by both. Only
margins.csv had both. Forces on the lugs of a structure were those of simple supports, whatever
couples the lugs carry, and none with more than two of them. Of a cone the section at its start was
taken for that at the moment.

Independent values: statics on paper, and a clamped beam, next to each.
"""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from assess.checks import margins_of
from assess.margin import Margin
from assess.situation import Situation
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.records import JointForces
from geometry import Pin, Segment
from pinstress import run, study_from
from pinstress.cli.commands import run_command_line
from reports.data.results import Results

F, GAP, A, B, D = 5000.0, 2.0, 20.0, 15.0, 20.0  # N; gap and lugs along the pin, diameter, mm
BESIDE = "bending, for comparison", "bending, concentrated forces, for comparison"


def study(bore: float = 0.0, **analysis: Any) -> dict[str, Any]:
    """A pin in single shear; lug B is free to tilt, and A is not."""
    profile = [
        {"length": A, "diameter": D, "bore": bore, "connection": "A"},
        {"length": GAP, "diameter": D, "bore": bore},
        {"length": B, "diameter": D, "bore": bore, "connection": "B"},
    ]
    return {
        "title": "Two lugs, one of them guided",
        "units": "mm-N-s",
        "material": {
            "steel": {
                "youngs_modulus": "210 GPa",
                "poisson_ratio": 0.3,
                "yield_strength": "700 MPa",
                "ultimate_strength": "900 MPa",
            }
        },
        "analysis": {"joints": "foundation", "tolerance": 0.9, **analysis},
        "case": {"pull": {"kind": "given", "forces": {"A": [-F, 0], "B": [F, 0]}}},
        "pin": {
            "P": {
                "material": "steel",
                "profile": profile,
                "lug": {
                    "A": {"outer_diameter": 50, "tilt": "guided"},
                    "B": {"outer_diameter": 50, "tilt": "free"},
                },
            }
        },
    }


def on_structure(tilt: str, *names: str) -> dict[str, Any]:
    """The lugs `names` are the structure's, 8 mm of 10 along the pin; the link M is nearest to the
    first of them.
    """
    given = study()
    profile: list[dict[str, Any]] = []
    for name in (names[0], "M", *names[1:]):
        own = {"connection": "M"} if name == "M" else {"name": name}
        profile += [{"length": 8, "diameter": D, **own}, {"length": 2, "diameter": D}]
    profile[3]["length"] = 12.0
    lugs = {name: {"outer_diameter": 50, "tilt": tilt} for name in names}
    lugs["M"] = {"outer_diameter": 50, "tilt": "free"}
    given["pin"]["P"] |= {"profile": profile, "lug": lugs}
    given["case"]["pull"]["forces"] = {"M": [F, 0]}
    return given


def checks(found: Results) -> dict[str, Margin]:
    """By name; of several places the last one."""
    return {check.method: check for check in found[("P", "pull")].hand_checks}


def bearing(found: Results, at: str) -> float:
    """Force across, N, by the pressure on a band of 8 mm."""
    row = found[("P", "pull")].hand_checks
    return next(c.demand or 0.0 for c in row if c.method == "bearing" and c.at == at) * D * 8.0


@pytest.mark.parametrize("joints", ["foundation", pytest.param("contact", marks=pytest.mark.slow)])
@pytest.mark.parametrize("bore", [0.0, 12.0])
def test_the_couple_of_the_guided_lug_is_in_bending(joints: str, bore: float) -> None:
    """A lug that is free to tilt carries no couple, so its force is at its middle: at the edge of
    the guided lug the moment is F (gap + B / 2), and inside it is more yet. 32 M D / (pi (D^4 -
    d^4)).
    """
    found = run(study_from(study(bore, joints=joints, limit_load="never")))
    row, own = found[("P", "pull")], checks(found)
    assert row.joint is not None
    moments = dict(row.joint.bending_moments)
    at_the_edge = F * (GAP + B / 2.0)
    assert moments[min(moments, key=lambda z: abs(z - A))] == pytest.approx(at_the_edge, rel=1e-6)
    per_moment = 32.0 * D / (math.pi * (D**4 - bore**4))
    stress = own["bending, joint model"].demand or 0.0
    assert stress == pytest.approx(max(moments.values()) * per_moment)
    assert stress > at_the_edge * per_moment
    for name in BESIDE:
        assert not own[name].governs
        assert (own[name].demand or math.inf) < 0.75 * at_the_edge * per_moment
    assert "bending" not in own
    shear = own["single shear, mean"]
    assert shear.demand == pytest.approx(4.0 * F / (math.pi * (D**2 - bore**2)), rel=1e-3)
    assert shear.basis == "joint model"


def test_tables_json_and_page_have_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every check by hand is a margin with the same demand, and both govern or neither does."""
    monkeypatch.chdir(tmp_path)
    Path("s.toml").write_text(study_from(study()).text)
    assert run_command_line(["run", "s.toml", "--out", "out", "--vtk", "none", "--quiet"]) == 0
    by_hand, margins = (
        list(csv.DictReader(Path(f"out/{name}.csv").read_text(encoding="utf-8").splitlines()))
        for name in ("hand_checks", "margins")
    )
    made = {m["method"]: m for m in margins if m["level"] == "limit" and not m["not_made"]}
    names = {check["check"] for check in by_hand}
    assert names >= {"bending, joint model", *BESIDE, "lug, bearing"}
    for name in names:
        worst = max(
            (c for c in by_hand if c["check"] == name),
            key=lambda c: float(c["stress"]) / float(c["strength"]),
        )
        assert worst["stress"] == made[name]["demand"]
        assert worst["strength"] == made[name]["allowable"]
        assert worst["governs"] == made[name]["governs"] == ("no" if name in BESIDE else "yes")
        assert worst["basis"] in made[name]["basis"]
    (pin,) = json.loads(Path("out/results.json").read_text(encoding="utf-8"))["pins"]
    listed = [(c["name"], c["stress"], c["governs"], c["basis"]) for c in pin["hand_checks"]]
    assert listed == [
        (c["check"], float(c["stress"]), c["governs"] == "yes", c["basis"]) for c in by_hand
    ]
    page = Path("out/report.html").read_text(encoding="utf-8")
    for said in ("bending, joint model", *BESIDE, "single shear, mean (joint model)"):
        assert said in page


def test_every_instant_and_case_has_its_own(tmp_path: Path) -> None:
    """Half of the load, then all of it, then a third, each turned: bending as under all of it."""
    rows = ["connection,fx,fy,time"]
    for time, part, turn in ((0.0, 0.5, 0.0), (1.0, 1.0, 1.0), (2.0, 1.0 / 3.0, 2.0)):
        x, y = part * F * math.cos(turn), part * F * math.sin(turn)
        rows += [f"A,{-x},{-y},{time}", f"B,{x},{y},{time}"]
    (tmp_path / "t.csv").write_text("\n".join(rows) + "\n")
    still, swept = study(), study()
    swept["case"]["sweep"] = {"kind": "given", "table": "t.csv"}
    row = run(study_from(swept, folder=tmp_path))[("P", "sweep")]
    turned = {check.method: check for check in row.hand_checks}
    for name, check in checks(run(study_from(still))).items():
        assert turned[name].demand == pytest.approx(check.demand, rel=1e-6)
        assert turned[name].time == 1.0


def test_even_loads_that_are_asked_for_do_not_govern_alone_without_the_couple() -> None:
    """A couple that is left over is no statics: both govern, so that the larger one does."""
    found = run(study_from(study(bending_moment="formula")))
    own = checks(found)
    assert own["bending"].governs
    assert own["bending, joint model"].governs
    assert own["bending"].basis.endswith("the couple that is left over is shared by all bands")
    bent = [m.margin for m in found.margins if m.margin.method == "EN 1993 bending"]
    demands = [m.demand or 0.0 for m in bent]
    assert all(m.governs for m in bent)
    assert max(demands) > F * (GAP + B / 2.0) > min(demands)


def test_a_structure_whose_lugs_tilt_freely_is_a_beam_on_two_supports() -> None:
    """F b / (a + b) at the nearer one, with a, b to the middles of the lugs: 10 and 20 mm."""
    found = run(study_from(on_structure("free", "near", "far")))
    assert bearing(found, "near") == pytest.approx(F * 20.0 / 30.0, rel=1e-6)
    assert bearing(found, "far") == pytest.approx(F * 10.0 / 30.0, rel=1e-6)


def test_a_guided_lug_of_a_structure_carries_a_couple_and_another_force() -> None:
    """Less at the far one than of simple supports, F a / l, and more than of a beam clamped at the
    near one, F a^2 (3 l - a) / (2 l^3): 0.333 and 0.148 of F.
    """
    given = on_structure("guided", "near", "far")
    given["pin"]["P"]["lug"]["far"]["tilt"] = "free"
    found = run(study_from(given))
    near, far = bearing(found, "near"), bearing(found, "far")
    assert near + far == pytest.approx(F, rel=1e-6)
    assert 10.0**2 * 80.0 / (2.0 * 30.0**3) < far / F < 0.98 * 10.0 / 30.0
    lug = {c.at: c.demand for c in found[("P", "pull")].hand_checks if c.method == "lug, bearing"}
    assert lug["near"] == pytest.approx(near / (D * 8.0))


def test_more_lugs_of_a_structure_than_statics_can_tell() -> None:
    """Their forces are the joint's: together they take F, and every formula has them."""
    found = run(study_from(on_structure("guided", "near", "far", "farther")))
    assert sum(bearing(found, at) for at in ("near", "far")) > F  # the last one pulls back
    assert bearing(found, "near") + bearing(found, "far") - bearing(
        found, "farther"
    ) == pytest.approx(F, rel=1e-6)
    assert not [m for m in found.margins if "equilibrium" in m.margin.needs]
    row = found[("P", "pull")]
    assert row.joint is not None
    largest = max(moment for _, moment in row.joint.bending_moments)
    assert checks(found)["bending, joint model"].demand == pytest.approx(
        largest * 32.0 / (math.pi * D**3)
    )


def test_a_cone_is_as_thin_as_it_is_at_the_moment() -> None:
    """From 30 to 20 mm over 40: 22.5 mm at three quarters. 32 M / (pi d^3), 4 V / (pi d^2)."""
    pin = Pin(
        "P",
        (
            Segment(0.02, 0.03, connection="A"),
            Segment(0.04, 0.03, end_diameter=0.02),
            Segment(0.02, 0.02, connection="B"),
        ),
    )
    loads = PinLoads("pull", ("A", "B"), np.array([[[-F, 0.0, 0.0], [F, 0.0, 0.0]]]))
    s = Situation(pin, Material("steel", 210e9, 0.3, None, 700e6), loads)
    z, at = np.array([0.0, 0.02, 0.05, 0.08]), np.array([[0.0, 0.0, 1.0, 0.0]])
    along = JointForces(z, None, 4000.0 * at, 100.0 * at, (), np.zeros((1, 0, 2)))
    found = {check.method: check for check in margins_of(replace(s, joint=along))}
    d = 0.0225
    bent, sheared = found["bending, joint model"], found["single shear, mean"]
    assert bent.demand == pytest.approx(32.0 * 100.0 / (math.pi * d**3))
    assert sheared.demand == pytest.approx(4.0 * 4000.0 / (math.pi * d**2))
    assert (bent.at, bent.z) == ("segment 2", 0.05)
