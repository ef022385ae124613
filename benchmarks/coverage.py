"""Does the estimated error contain the true one, and are singular corners told from fillets?

The truth is the same model on a mesh of four times the unknowns, with more harmonics of a
bearing pressure.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from benchmarks.random_pins import STEEL, Trial, trials
from fea.harmonic_look import harmonic_look, harmonic_solution
from fea.ladder import STEP, Asked, Solution, places_of, solve_pin

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


def truth(trial: Trial, meshes: int) -> float:
    """Maximum outside the singular places on a much finer mesh, Pa."""
    places = places_of(trial.pin, STEEL, trial.clamps, (trial.loads,))
    held = tuple(trial.pin.surface(c) for c in trial.clamps)
    level = meshes - 1 + BEYOND
    loads = replace(trial.loads, terms=TERMS)
    fine = harmonic_solution(trial.pin, STEEL, held, (loads,), places, level, STEP)
    return harmonic_look(fine, places, loads).maximum


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


def main() -> None:
    """Print both tables."""
    rows = []
    print(f"{'pin':>14} {'verdict':>12} {'unknowns':>8} {'estimate':>9} {'true':>9}")
    for row in coverage():
        rows.append(row)
        mark = "" if row["held"] else "  NOT CONTAINED"
        print(
            f"{row['pin']:>14} {row['verdict']:>12} {row['unknowns']:>8} "
            f"{row['estimate']:9.2%} {row['error']:9.2%}{mark}",
            flush=True,
        )
    held = sum(bool(row["held"]) for row in rows)
    print(f"contained: {held} of {len(rows)}")
    worst = 0.0
    found = corners()
    sharp = [row for row in found if row["sharp"]]
    for row in sharp:
        for zone in row["governs"]:
            off = 1.0 if zone.exponent is None else abs(zone.exponent - zone.exponent_theory)
            worst = max(worst, off)
    print(f"sharp pins found: {sum(bool(r['found']) for r in sharp)} of {len(sharp)}")
    print(f"of these singular: {sum(r['verdict'] == 'singular' for r in sharp)}")
    print(f"largest difference of an exponent from theory: {worst:.3f}")
    others = [row for row in found if not row["sharp"]]
    print(f"filleted pins taken for sharp: {sum(bool(r['found']) for r in others)} of {len(others)}")
    print(f"of these singular for any reason: {sum(r['verdict'] == 'singular' for r in others)}")


if __name__ == "__main__":
    sys.exit(main())
