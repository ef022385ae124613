"""Made-up rows of every verdict, with singular zones and hand checks; the surface of a
stepped pin.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from assess.margin import Margin
from fea.core.peak import SingularZone
from reports.data.fields import Field
from reports.data.results import Results
from reports.data.row import PinResult
from tests.support.results.made_up_run import make_results, shape
from tests.support.results.rows import with_values

SHIGLEY = "Budynas & Nisbett, Shigley's Mechanical Engineering Design, 8-12"


def zones(turned: float = 0.0, governs: bool = True) -> tuple[SingularZone, ...]:
    """Return a corner, the edge of a clamp and that of a load, rotated by `turned` (rad) about the
    axis.
    """
    c, s = np.cos(turned), np.sin(turned)

    def at(r: float, z: float) -> tuple[float, float, float]:
        return float(r * c), float(r * s), z

    return (
        SingularZone(
            at(0.5, 0.25), "a sharp corner", ("head", "drag brace A"), 0.4321, 0.45556, 0.1,
            governs, 7654.321, "a fillet of at least 0.1 x the smaller diameter here",
        ),
        SingularZone(
            at(0.75, 0.0), "the edge of a clamp", ("start", "head"), None, 0.2888, 0.15, False,
            321.0, "model the hub that holds the pin",
        ),
        SingularZone(
            at(0.5, 1.5), "the edge of a load", ("drag brace A", "gap"), None, 0.0, 0.01, False,
            123.0, 'use distribution = "cosine"',
        ),
    )  # fmt: skip


def checks(time: float | None = None) -> tuple[Margin, ...]:
    """Return hand checks against yield, in the units of the made-up run."""
    made = (
        ("single shear, mean", "gap", 1234.5678901, 68127.3, "V / A"),
        ("bending", "drag brace A", 0.0, 118000.0, "M c / I"),
        ("bearing", "strut A", 250.0, None, "F / (d L)"),
    )
    return tuple(
        Margin(method, SHIGLEY, "hand", "limit", 1.0, stress, strength, at=at, time=time, formula=f)
        for method, at, stress, strength, f in made
    )


def row(case: str, verdict: str, factor: float, meets: bool | None, **more: object) -> PinResult:
    """Return a row of pin A with a yield stress of 118,000 psi."""
    largest = 118000.0 / factor
    base = next(p for p in make_results().pins if p.pin == "A")
    made = with_values(
        base, case=case, model="harmonic", verdict=verdict, note="known to 0.5%", time=None,
        position=None, max_von_mises=largest, error_estimate=0.005 * largest, safety_factor=factor,
        decided=meets, required=1.5, published_max_von_mises=None,
        published_safety_factor=None, why="harmonic: a beam is never known to 2.0%",
    )  # fmt: skip
    return with_values(made, **more)


def judged() -> Results:
    """Return results with rows of pin A with all verdicts; the required safety factor is 1.5."""
    rows = (
        row("fine", "converged", 3.0, True, singular_at=zones(0.3, False), margins=checks()),
        row("sharp", "singular", 2.5, None, singular_at=zones(), margins=checks()),
        row("weak", "singular", 1.25, False, singular_at=zones(), margins=checks(2.0)),
        row("flows", "singular", 0.8, False, singular_at=zones()),
        row("beyond", "converged", 0.9, False),
        row("loose", "unconverged", 2.0, None),
    )
    return replace(
        make_results(), pins=rows, shapes=(shape("A"),), reactions=(), drive=(), motion=(),
        published=(), beam_check=None, motion_check=None,
    )  # fmt: skip


def tube(strength: float | None = 118000.0) -> Field:
    """Return a field on the surface of a stepped pin revolved in 24 sectors, closed at its ends by
    rings.
    """
    profile = np.array(
        [(0.05, 0.0), (0.75, 0.0), (0.75, 0.25), (0.5, 0.25), (0.5, 1.5), (0.5, 2.5), (0.05, 2.5)]
    )
    sectors = 24
    turn = np.arange(sectors) * 2.0 * np.pi / sectors
    r, z = (np.repeat(x, sectors) for x in profile.T)
    angle = np.tile(turn, len(profile))
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)
    i, j = np.arange(len(profile) - 1)[:, None] * sectors, np.arange(sectors)[None]
    k = (j + 1) % sectors
    cells = np.stack([i + j, i + k, i + sectors + k, i + sectors + j], axis=2).reshape(-1, 4)
    envelope = 1000.0 * (2.5 - z) * np.abs(points[:, 1])
    stress = np.zeros((len(points), 6))
    stress[:, 2] = envelope
    return Field(
        "A", "sharp", points, cells, 1e-3 * points, stress, envelope, envelope, "quad", strength
    )
