"""A clamped pin, which `pinstress init` writes: safety factor, error, verdict and hand checks."""

import pinstress

results = pinstress.run(pinstress.load_study(pinstress.shipped_studies()["one_pin"]))
unit = results.units.stress
pin = results.pins[0]

print(f"pin {pin.pin}, case {pin.case}, {pin.model} model")
print(f"largest von Mises stress  {pin.max_von_mises:.0f} ± {pin.error_estimate:.0f} {unit}")
print(f"factor of safety          {pin.safety_factor:.1f} against yield")
print(f"required                  {results.required_safety_factor:g}, met: {pin.meets_required}")
print(f"verdict                   {pin.verdict} ({pin.note})")

for check in pin.hand_checks:
    print(f"hand check: {check.method:34} {check.demand:6.0f} {unit} = {check.formula}")
