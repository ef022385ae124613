"""The matrix of requirements on the first screen: no cell hides what is not met."""

from __future__ import annotations

from dataclasses import replace

from reports.data.requirement_matrix import matrix_rows
from reports.data.requirements import RequirementRow, keys_in
from reports.data.results import Results
from reports.page.overview import overview_part


def requirement(
    pin: str, case: str, outcome: str, check: str = "yield", needs: str = "", stated: bool = True
) -> RequirementRow:
    return RequirementRow(pin, case, "limit", check, 10.0, 1.0, outcome, needs, stated)  # type: ignore[arg-type]


def test_the_matrix_hides_nothing_that_is_not_met() -> None:
    rows = [requirement(pin, f"c{k}", "met") for pin in "AB" for k in range(9)]
    rows[3] = replace(rows[3], outcome="missed")
    rows += [requirement("A", "c0", "missed", "shear", stated=False)]
    rows += [requirement("B", "c0", "met", "shear", stated=False)]
    rows += [requirement("A", "c0", "not checked", "rupture", "material.x.ultimate_strength")]
    rows += [requirement(pin, "c0", "met", "bending", stated=False) for pin in "AB"]
    matrix = matrix_rows(rows)
    assert [(m.check, m.case) for m in matrix] == [
        ("yield", "c3"), ("rupture", ""), ("yield", "8 other cases"), ("shear", "c0"),
        ("other checks (1)", ""), ("", ""),
    ]  # fmt: skip
    assert matrix[0].cells == {"A": "missed", "B": "met"}
    assert matrix[1].cells == {"A": "not checked"}
    assert matrix[2].cells == {"A": "met", "B": "met"}
    assert matrix[3].cells == {"A": "missed", "B": "met"}
    assert matrix[4].cells == {"A": "met", "B": "met"}
    assert matrix[5].needs == {("ultimate_strength",): ["rupture"]}
    assert "met" not in matrix[5].cells.values()
    worst = {p: min(r.outcome == "met" for r in rows if r.pin == p) for p in "AB"}
    shown = {p: min(m.cells.get(p, "met") == "met" for m in matrix) for p in "AB"}
    assert shown == worst
    (one,) = matrix_rows([requirement(pin, f"c{k}", "met") for pin in "AB" for k in range(9)])
    assert one.case == "all 9 cases"


def test_a_comma_in_the_name_of_a_material_does_not_split_what_is_needed() -> None:
    steel = 'material."steel, tempered"'
    needs = f"{steel}.shear_strength, {steel}.ultimate_strength, lug.A.E1.shank"
    keys = [f"{steel}.shear_strength", f"{steel}.ultimate_strength", "lug.A.E1.shank"]
    assert keys_in(needs) == keys
    assert keys_in("") == []
    row = RequirementRow("A", "c", "limit", "shear", 1.5, None, "not checked", needs)
    needed = ("shear_strength", "ultimate_strength", "shank")
    assert matrix_rows([row])[-1].needs == {needed: ["shear"]}
    without = replace(row, needs='analysis.limit_load other than "never", fatigue')
    (words,) = matrix_rows([without])[-1].needs
    assert words == ('analysis.limit_load other than "never"', "[fatigue]")


def test_a_stated_requirement_is_in_the_matrix_where_it_was_not_checked(results: Results) -> None:
    """Its cell was empty for a pin without a strength, as if nothing were required of it, and its
    row was missing where no pin had one.
    """
    steel = "material.steel.shear_strength"
    rows = [requirement("A", "c0", "met", "shear"), requirement("A", "c1", "met", "shear")]
    rows += [requirement("B", c, "not checked", "shear", steel) for c in ("c0", "c1")]
    rows += [requirement(p, c, "not checked", "rupture", "material.steel.ultimate_strength")
             for p in "AB" for c in ("c0", "c1")]  # fmt: skip
    *stated, last = matrix_rows(rows)
    assert [(m.check, m.case, m.required, m.cells) for m in stated] == [
        ("shear", "c0", 10.0, {"A": "met", "B": "not checked"}),
        ("shear", "c1", 10.0, {"A": "met", "B": "not checked"}),
        ("rupture", "", 10.0, {"A": "not checked", "B": "not checked"}),
    ]
    assert last.needs == {("shear_strength",): ["shear"], ("ultimate_strength",): ["rupture"]}
    lacking = overview_part(results, {}, "")["matrix"][-1]
    assert all(" need" in text for text in lacking["needs"])
