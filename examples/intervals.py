"""A sharp shoulder has no maximum stress: its results, and the effect of a fillet."""

import pinstress

STUDY = pinstress.load_study(pinstress.shipped_studies()["one_pin"])


def solved(fillet: float) -> pinstress.RunResults:
    return pinstress.run(pinstress.changed_study(STUDY, {"pin.B.fillet": fillet}), tolerance=0.02)


sharp = solved(fillet=0.0)["B", "landing"]
corner = next(zone for zone in sharp.singular_at if zone.governs)
low, high = sharp.max_von_mises_interval
close = corner.strength
print(f"sharp: {sharp.verdict} at {corner.kind} between {' and '.join(corner.between)}")
print(f"  {sharp.max_von_mises:.0f} psi farther away than {corner.excluded:g} in")
print(f"  {low:.0f} to {high:.0f} psi over twice and half that distance")
print(f"  grows as distance^-{corner.exponent:.3f}, in theory ^-{corner.exponent_theory:.3f}")
print(f"  {close.along:.1f} psi * (distance / in)^-{close.exponent:.3f} close to it")
print(f"  notch stress intensity {close.notch:.1f} psi in^{close.exponent:.3f}")
for fillet in (0.05, 0.1, 0.2, 0.4):
    pin = solved(fillet)["B", "landing"]
    print(f"fillet {fillet}: {pin.max_von_mises:.0f} ± {pin.error_estimate:.0f} psi, {pin.verdict}")
