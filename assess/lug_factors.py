"""Factors of lugs, which the author of a study reads off the figures of a source, or off rules."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LugFactors:
    """Dimensionless factors of a lug, None where the study does not give them.

    K, K_n: factors of AFFDL-TR-69-42, figures 9-2 and 9-4. k_br, k_t: efficiency factors of Melcon
    and Hoblit for shear-bearing and tension; C: for the yield load; k_tru, k_try: for transverse
    loads, ultimate and yield. gamma: factor for the pressure of a bent pin, which peaks at the
    faces of the lug. bearing: the special factor of 14 CFR 25.623 and 25.693.
    """

    K: float | None = None
    K_n: float | None = None
    k_br: float | None = None
    k_t: float | None = None
    C: float | None = None
    k_tru: float | None = None
    k_try: float | None = None
    gamma: float | None = None
    bearing: float | None = None
