"""AFFDL-TR-69-42, Stress Analysis Manual (reprint of October 1986), 9.6, table 9-1, as a study.

The example is a joint in double shear with bushings, whose printed loads docs/evidence.md compares.
The same joint by three codes shows what a user sees: work, units, what would pass, codes side by
side.
"""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

import pinstress
from pinstress import load_study
from reports.data.results import Results
from reports.tables.strength.codes import codes_table
from reports.tables.strength.margins import margins_table
from reports.text.safety_factors import print_safety_factors
from reports.text.work import print_work
from tests.conftest import ROOT

STUDY = (ROOT / "studies" / "evidence" / "affdl_joint.toml").read_text(encoding="utf-8")
FACTOR = 1.5 * 1.15  # ultimate, and of fittings


@dataclass(frozen=True)
class Joint:
    """The results of the study, and the rows of margins.csv by method."""

    results: Results
    rows: dict[str, dict[str, Any]]


def joint(folder: Path, text: str = STUDY) -> Joint:
    path = folder / "joint.toml"
    path.write_text(text, encoding="utf-8")
    results = pinstress.run(load_study(path))
    return Joint(results, {row["method"]: row for row in margins_table(results).records()})


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Joint:
    return joint(tmp_path_factory.mktemp("joint"))


def printed(write: object, results: Results) -> str:
    console = Console(file=io.StringIO(), width=400, force_terminal=False)
    write(results, console)  # type: ignore[operator]
    return console.file.getvalue()  # type: ignore[attr-defined,no-any-return]


def test_the_checks_of_the_code(found: Joint) -> None:
    """Their loads are in docs/evidence.md."""
    for method in ("AFFDL lug bearing", "AFFDL bushing", "AFFDL joint in double shear"):
        row = found.rows[method]
        assert row["factor"] == pytest.approx(FACTOR)
        assert row["code"] == "aircraft"
        assert row["unit"] == "lbf"


def test_the_work_has_the_numbers_of_the_study(found: Joint) -> None:
    """In inches and psi, with what would pass, and what is not covered."""
    text = printed(print_work, found.results)
    assert "= 1.304 × 60,000 psi × 0.75 in × 0.75 in = 44,010 lbf" in text
    assert "P_u = 1.304 × F_cy × D_p × t" in text
    assert "= min(44,010 lbf, 72,450 lbf, max(30,050 lbf, 37,840 lbf)) = 37,840 lbf" in text
    assert "ultimate load: 1.725 × 20,000 lbf against 37,840 lbf: margin +0.0969" in text
    assert "Not covered: loads across the shank" in text
    assert 'not checked: needs material."AISI 4130".bearing_strength' in text
    for passing in re.findall(r"(\S+ [\d.]+ \S+) would pass", text):
        assert passing.endswith(" in")


def test_what_would_pass_passes(found: Joint, tmp_path: Path) -> None:
    """EN 1993 bending misses; with the diameter that is named it is loaded to 1."""
    before = found.rows["EN 1993 bending"]
    assert before["utilisation"] > 1.0
    key, diameter, unit = before["would_pass"].split()
    assert (key, unit) == ("diameter", "in")
    after = joint(tmp_path, STUDY.replace("diameter = 0.75", f"diameter = {diameter}"))
    used = after.rows["EN 1993 bending"]["utilisation"]
    assert used == pytest.approx(1.0, abs=1e-3)  # four digits of the diameter


def test_codes_side_by_side(found: Joint) -> None:
    """At the outer lugs each code has its own governing clause; what all have is left out."""
    table = codes_table(found.results)
    assert [c.heading for c in table.columns] == ["pin", "at", "aircraft", "lifting", "civil"]
    rows = {row.at: {code: m.method for code, m in row.margins.items()} for row in table.rows}
    assert rows["A"] == {
        "aircraft": "AFFDL lug bearing",
        "lifting": "BTH-1 plate, bearing",
        "civil": "EN 1993 shear",
    }
    assert "Least margin of each code" in printed(print_safety_factors, found.results)


def test_an_idle_case_adds_no_place_to_the_codes(tmp_path: Path) -> None:
    """Its checks have no margin, and name the pin's first segment, on which no link bears."""
    forces = "forces = { A = [0, 0], B = [0, 0], C = [0, 0] }"
    text = STUDY.replace("profile = [", "profile = [\n  { length = 0.1, diameter = 0.75 },")
    both = joint(tmp_path, f'{text}\n[case.idle]\nkind = "given"\n{forces}\n')
    assert [row.case for row in both.results.pins] == ["pull", "idle"]
    assert {row.at for row in codes_table(both.results).rows} == {"A", "B", "C"}


def test_one_code_is_not_compared(tmp_path: Path) -> None:
    """Nor are those of the general one named, which a study has without a choice."""
    text = re.sub(r"(code|design_factor|bending_factor|factors) = .*\n", "", STUDY)
    general = joint(tmp_path, text)
    assert not codes_table(general.results).rows
    assert {row["code"] for row in general.rows.values()} == {""}
    assert "lug, net section" in general.rows
    assert not any("AFFDL" in method for method in general.rows)


def test_a_lug_without_a_size_is_named(tmp_path: Path) -> None:
    """No clause of a lug is made of it, and none is green."""
    text = STUDY.replace("outer_diameter = 2.5\n", "")
    bare = joint(tmp_path, text)
    for name in "AC":
        row = bare.rows[f"clauses for the lug of {name}"]
        assert row["not_made"] == f"needs pin.P.lug.{name}.outer_diameter"
        assert row["utilisation"] is None
    assert "symmetrical double shear" in bare.rows["AFFDL joint in double shear"]["not_made"]
