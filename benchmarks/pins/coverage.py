"""Tests whether the estimated error contains the true one, and whether sharp corners are
distinguished from fillets.

The true value is that of the same model on a mesh of four times the unknowns, with more harmonics
of a bearing pressure.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from benchmarks.random_pins import STEEL, Trial, trials
from benchmarks.timing import table
from fea.core.material import Material
from fea.core.requirement import Requirement
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.singular.singularities import singularities_of
from fea.solve.refine import MESH_RATIO
from fea.solve.solve import solve_pin
from fea.support.support import Solution

Row = dict[str, Any]

PINS, CORNERS = 50, 20
BEYOND = 2  # refinements beyond the last mesh of the solution
TERMS = 10  # harmonics of a bearing pressure for the true value


def solved(trial: Trial, tolerance: float = 0.02) -> Solution:
    """Return the solution with the program's own choice of model."""
    (found,) = solve_pin(
        trial.pin, STEEL, trial.clamps, (trial.loads,), Requirement(tolerance, required=1.0)
    )
    return found


def truth(trial: Trial, meshes: int, material: Material = STEEL, beyond: int = BEYOND) -> float:
    """Return the maximum outside the excluded zones, Pa, on the mesh that is `beyond` the last of
    `meshes`.
    """
    singularities = singularities_of(trial.pin, material, trial.clamps, (trial.loads,))
    constrained = tuple(trial.pin.surface(c) for c in trial.clamps)
    level = meshes - 1 + beyond
    loads = replace(trial.loads, terms=TERMS)
    problem = SectionProblem(trial.pin, material, constrained, (loads,), singularities)
    fine = harmonic_solution(problem, level, MESH_RATIO)
    return harmonic_result(fine, singularities, loads).maximum


def coverage(count: int = PINS, seed: int = 4, tolerance: float = 0.02) -> Iterator[Row]:
    """Yield a row for each pin: estimated and true error over the maximum, verdict, unknowns."""
    for trial in trials(count, seed):
        peak = solved(trial, tolerance).peak
        value, error = peak.max_von_mises or 0.0, peak.error_estimate or 0.0
        exact = truth(trial, len(peak.history))
        yield {
            "pin": trial.pin.name,
            "verdict": peak.verdict,
            "unknowns": peak.dofs,
            "estimate": error / value,
            "error": abs(value - exact) / exact,
            "contained": abs(value - exact) <= error,
        }


def corners(count: int = CORNERS, seed: int = 5) -> list[Row]:
    """Return rows of sharp and filleted pins: verdicts, and the zones of sharp corners
    that govern.
    """
    rows: list[Row] = []
    for sharp in (True, False):
        for trial in trials(count, seed, None if sharp else (0.04, 0.2)):
            peak = solved(trial).peak
            zones = [z for z in peak.singular_at if z.kind == "a sharp corner"]
            rows.append(
                {
                    "sharp": sharp,
                    "pin": trial.pin.name,
                    "verdict": peak.verdict,
                    "found": bool(zones),
                    "governs": [z for z in zones if z.governs],
                }
            )
    return rows


def contained() -> str:
    """Return the comparison of estimated and true errors, pin by pin."""
    rows = list(coverage())
    lines = (
        (
            row["pin"],
            row["verdict"],
            row["unknowns"],
            f"{100.0 * row['estimate']:.2f}",
            f"{100.0 * row['error']:.2f}",
            "yes" if row["contained"] else "no",
        )
        for row in rows
    )
    head = ("pin", "verdict", "unknowns", "estimated error [%]", "true error [%]", "contained")
    count = sum(row["contained"] for row in rows)
    return f"Contained: {count} of {len(rows)}.\n\n{table(head, lines)}"


def singular() -> str:
    """Return the numbers of detected sharp corners and of fillets mistaken for corners, and the
    exponents.
    """
    rows = corners()
    zones = [zone for row in rows if row["sharp"] for zone in row["governs"]]
    off = [abs(z.exponent - z.exponent_theory) for z in zones if z.exponent is not None]
    head = ("pins", "number", "sharp corner detected", "verdict singular")
    return (
        table(head, [_counted(rows, sharp) for sharp in (True, False)])
        + f"\n\nExponents of {len(off)} of {len(zones)} governing corners were measured; the "
        f"largest difference from theory is {max(off):.3f}."
    )


def _counted(rows: list[Row], sharp: bool) -> tuple[str, int, int, int]:
    here = [row for row in rows if row["sharp"] == sharp]
    return (
        "with a sharp corner" if sharp else "with a fillet",
        len(here),
        sum(row["found"] for row in here),
        sum(row["verdict"] == "singular" for row in here),
    )
