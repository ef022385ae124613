"""The error of the cells of contact is added to that of the meshes, and the note follows."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fea.core.peak import ErrorParts, Maximum, accuracy
from fea.core.requirement import Requirement
from fea.support.contact.error_parts import with_cells
from tests.support.each import each

ASKED = Requirement(tolerance=0.02)


def peak(mesh: float) -> Maximum:
    known = mesh <= ASKED.tolerance
    own = accuracy(mesh, ASKED.tolerance, known)
    return Maximum(
        "P", "pull", "harmonic", "converged" if known else "unconverged",
        f"{own.text}; another note", 200.0, 200.0 * mesh, parts=ErrorParts(200.0 * mesh),
        reasons=(*own.codes, "another"),
    )  # fmt: skip


@each(
    ("mesh", "cells", "verdict", "note", "reason"),
    [
        (0.005, 0.01, "converged", "estimated error 1.5%", "within-tolerance"),
        (0.015, 0.01, "unconverged", "estimated error 2.5%, above the tolerance of 2.0%",
         "above-tolerance"),
        (0.05, 0.01, "unconverged", "estimated error 6.0%, above the tolerance of 2.0%",
         "above-tolerance"),
    ],
)  # fmt: skip
def test_note_error_and_verdict_agree(
    mesh: float, cells: float, verdict: str, note: str, reason: str
) -> None:
    found = with_cells(peak(mesh), cells, ASKED)
    assert (found.verdict, found.note) == (verdict, f"{note}; another note")
    assert found.reasons == (reason, "another")
    assert found.error_estimate == pytest.approx(200.0 * (mesh + cells))
    assert found.parts is not None
    assert found.parts.cells == pytest.approx(200.0 * cells)


def test_a_singular_row_has_a_wider_range() -> None:
    before = replace(peak(0.01), verdict="singular", interval=(180.0, 230.0), note="no maximum")
    found = with_cells(before, 0.01, ASKED)
    assert found.interval == pytest.approx((178.0, 232.0))
    assert (found.verdict, found.note) == ("singular", "no maximum")


def test_without_a_maximum_nothing_changes() -> None:
    failed = Maximum("P", "pull", "harmonic", "failed", "why")
    assert with_cells(failed, 0.01, ASKED) is failed
