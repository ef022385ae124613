"""Does the estimated error contain the true one, and are singular corners told from fillets?

The truth is the same model on a mesh of four times the unknowns, with more harmonics of a
bearing pressure.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from benchmarks.random_pins import STEEL, Trial, trials
from fea.core.material import Material
from fea.harmonic.evaluate import harmonic_result, harmonic_solution
from fea.solve_pin import STEP, Asked, Solution, singularities_of, solve_pin

Row = dict[str, Any]

PINS, CORNERS = 50, 20
BEYOND = 2  # meshes finer than the one that answered
TERMS = 10  # harmonics of a bearing pressure in the truth


def solved(trial: Trial, tolerance: float = 0.02) -> Solution:
    """By the ladder."""
    (found,) = solve_pin(
        trial.pin, STEEL, trial.clamps, (trial.loads,), Asked(tolerance, required=1.0)
    )
    return found


def truth(trial: Trial, meshes: int, material: Material = STEEL, beyond: int = BEYOND) -> float:
    """Maximum outside the singular places on a mesh, `beyond` the last of `meshes`, Pa."""
    singularities = singularities_of(trial.pin, material, trial.clamps, (trial.loads,))
    held = tuple(trial.pin.surface(c) for c in trial.clamps)
    level = meshes - 1 + beyond
    loads = replace(trial.loads, terms=TERMS)
    fine = harmonic_solution(trial.pin, material, held, (loads,), singularities, level, STEP)
    return harmonic_result(fine, singularities, loads).maximum


def coverage(count: int = PINS, seed: int = 4, tolerance: float = 0.02) -> Iterator[Row]:
    """A row per pin: estimate and true error over the maximum, verdict, unknowns."""
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
            "held": abs(value - exact) <= error,
        }


def corners(count: int = CORNERS, seed: int = 5) -> list[Row]:
    """Sharp and filleted pins: verdicts, and exponents of sharp corners that govern."""
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
    """The estimate beside the true error, pin by pin."""
    lines = [f"{'pin':>14} {'verdict':>12} {'unknowns':>8} {'estimate':>9} {'true':>9}"]
    held = []
    for row in coverage():
        held.append(row["held"])
        lines.append(
            f"{row['pin']:>14} {row['verdict']:>12} {row['unknowns']:>8} {row['estimate']:9.2%} "
            f"{row['error']:9.2%}" + ("" if row["held"] else "  not contained")
        )
    return "\n".join([*lines, f"contained: {sum(held)} of {len(held)}"])


def singular() -> str:
    """Sharp corners found, their exponents, and fillets taken for corners."""
    rows = corners()
    sharp, others = ([r for r in rows if r["sharp"] == is_sharp] for is_sharp in (True, False))
    zones = [zone for row in sharp for zone in row["governs"]]
    off = [abs(z.exponent - z.exponent_theory) for z in zones if z.exponent is not None]
    return "\n".join(
        [
            f"sharp corners found in {sum(r['found'] for r in sharp)} of {len(sharp)} sharp pins",
            f"  of which singular: {sum(r['verdict'] == 'singular' for r in sharp)}",
            f"  exponents of {len(off)} of {len(zones)} governing corners measured; largest "
            f"difference from theory {max(off):.3f}",
            f"sharp corners found in {sum(r['found'] for r in others)} of {len(others)} filleted",
            f"  of these singular at all: {sum(r['verdict'] == 'singular' for r in others)}",
        ]
    )
