"""The model's maximum von Mises stress as margins: yield at limit load, rupture at ultimate load.

The demand is the upper end of the maximum: with its error, or of a singular row the upper end of
its interval. Past yield a linear stress is larger than the true one, so the second is cautious for
a ductile material.

Source: 14 CFR 25.305 (no detrimental permanent deformation at limit load, no failure at ultimate).
"""

from __future__ import annotations

from dataclasses import replace

from assess.strength.margin import Level, Margin, skipped
from assess.strength.situation import LoadFactors
from assess.strength.worst import strength_key
from fea.core.material import Material
from fea.core.peak import Maximum

CLAUSE = "14 CFR 25.305"
YIELD_METHOD, RUPTURE_METHOD = "von Mises stress, yield", "von Mises stress, rupture"
STRESS_METHODS: tuple[tuple[str, Level, str], ...] = (
    (YIELD_METHOD, "limit", "yield"),
    (RUPTURE_METHOD, "ultimate", "ultimate"),
)


def model_margins(
    peak: Maximum, material: Material, factors: LoadFactors, required: float | None = None
) -> list[Margin]:
    """Both, of one pin in one case. required: the safety factor against yield that the study asks
    for, which counts in place of a smaller factor at limit load.
    """
    demand = None if peak.max_von_mises is None else peak.upper_end
    out = []
    for method, level, which in STRESS_METHODS:
        factor = factors.at(level)
        if method == YIELD_METHOD:
            factor = max(factor, required or 0.0)
        strength: float | None = getattr(material, f"{which}_strength")
        if strength is None:
            needs = strength_key(material.name, which)
            out.append(skipped(method, CLAUSE, level, factor, needs))
        elif demand is None:
            needs = f"a maximum of the model, which is {peak.verdict}"
            out.append(skipped(method, CLAUSE, level, factor, needs))
        else:
            found = Margin(method, CLAUSE, level, demand, strength, factor)
            out.append(replace(found, time=peak.time, basis=_basis(peak)))
    return out


def _basis(peak: Maximum) -> str:
    if peak.verdict == "singular":
        return "outside the excluded zones, upper end of its interval"
    return f"maximum with its error ({peak.verdict})"
