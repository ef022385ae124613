"""Forces that come back from tables: our own output gives the same loads and stresses again."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pinstress import InputError, load_study, prepare
from pinstress.study.model.cases import case_loads
from pinstress.study.model.mechanism.linkage import linkage
from pinstress.study.schema.cases import GivenCase
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import QUICK, run_here

STUDIES = ROOT / "studies"
WIDE = "# rig 3\ncase;B.fx [kN];B.fy [kN]\nother;9;9\nlanding;0,0;-4,398670429\n"


def given(text: str, table: str) -> str:
    """A study's text with the forces of its case from a table."""
    assert "forces = { B = [0.0, -988.86] }" in text
    return text.replace("forces = { B = [0.0, -988.86] }", f'table = "{table}"')


def safety_factor(folder: Path, name: str, text: str) -> list[str]:
    (folder / f"{name}.toml").write_text(text)
    done = run_here("run", f"{name}.toml", cwd=folder)
    assert done.returncode == 0, done.stderr
    return (folder / "out" / name / "safety_factors.csv").read_text().splitlines()


def test_stresses_are_the_same_from_our_own_reactions(tmp_path: Path) -> None:
    before = safety_factor(tmp_path, "before", QUICK)
    for name in ("reactions", "reactions_pin_axes"):
        shutil.copy(tmp_path / "out" / "before" / f"{name}.csv", tmp_path)
        assert safety_factor(tmp_path, name, given(QUICK, f"{name}.csv")) == before


def test_a_wide_table_with_units_gives_the_same_stress(tmp_path: Path) -> None:
    (tmp_path / "rig.csv").write_text(WIDE)
    (before,), (after,) = (
        [float(x) for x in rows[1].split(",")[3:4]]
        for rows in (
            safety_factor(tmp_path, "before", QUICK),
            safety_factor(tmp_path, "wide", given(QUICK, "rig.csv")),
        )
    )
    assert after == pytest.approx(before, rel=1e-6)


@each(
    ("cell", "remedy"),
    [
        ('"1,988"', "write 1988, or 1.988 with a point"),
        ('"1,98"', "write 1.98, with a point"),
        ("988 lb/in", "cells have no units"),
        ("\N{MINUS SIGN}988", "write its minus as a hyphen: -988"),
    ],
)
def test_a_cell_that_is_not_a_number_has_a_remedy(tmp_path: Path, cell: str, remedy: str) -> None:
    (tmp_path / "t.csv").write_text(f"connection,fx,fy\nB,0,{cell}\n", encoding="utf-8")
    study = given((STUDIES / "one_pin.toml").read_text(), "t.csv")
    (tmp_path / "study.toml").write_text(study)
    with pytest.raises(InputError, match=f"line 2: fy = .* is not a number; {remedy}"):
        prepare(load_study(tmp_path / "study.toml"))


def test_a_long_cell_is_answered_at_once(tmp_path: Path) -> None:
    """The pattern of a number with a unit, tried on it, would not have ended."""
    (tmp_path / "t.csv").write_text(f"connection,fx,fy\nB,0,{'1' * 20_000}{' ' * 20_000}!\n")
    study = given((STUDIES / "one_pin.toml").read_text(), "t.csv")
    (tmp_path / "study.toml").write_text(study)
    with pytest.raises(InputError, match=r"line 2: fy = '1{40}' is not a number$"):
        prepare(load_study(tmp_path / "study.toml"))


def test_every_case_of_a_mechanism_comes_back(tmp_path: Path) -> None:
    """Motions and positions alike, on pins that turn: in pin axes."""
    done = run_here("loads", str(STUDIES / "grenier2008.toml"), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    study = load_study(STUDIES / "grenier2008.toml")
    mechanism = linkage(study)
    table = tmp_path / "out" / "grenier2008-loads" / "reactions_pin_axes.csv"
    for name in study.table.case:
        again = GivenCase(kind="given", table=str(table), table_case=name)
        tables = study.table.model_copy(update={"case": {"again": again}})
        found = case_loads(replace(study, table=tables), "again", None).reactions
        ours = case_loads(study, name, mechanism, extremes=False).reactions
        assert (found.times is None) == (ours.times is None)
        assert len(found.connections) > 5
        for c in found.connections:
            size = np.abs(ours.forces).max()
            same = pytest.approx(ours.in_pin_axes(c), rel=1e-12, abs=1e-12 * size)
            assert found.in_pin_axes(c) == same
