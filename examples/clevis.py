"""A pin in double shear without clamps: the fork and eye forces are in equilibrium."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pinstress

STUDY = """
title = "Clevis of a tie rod"
units = "mm-N-s"

[material."34CrNiMo6"]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "800 MPa"

[pin.clevis]
material = "34CrNiMo6"
profile = [
  { length = 12, diameter = 20, connection = "left arm" },
  { length = 2, diameter = 20 },                            # clearance
  { length = 24, diameter = 20, connection = "eye" },
  { length = 2, diameter = 20 },
  { length = 12, diameter = 20, connection = "right arm" },
]

[case.pull]
kind = "given"
distribution = "cosine"
forces = { "left arm" = [0, "-10 kN"], eye = [0, "20 kN"], "right arm" = [0, "-10 kN"] }
"""

with TemporaryDirectory() as folder:
    file = Path(folder) / "clevis.toml"
    file.write_text(STUDY, encoding="utf-8")
    pin = pinstress.run(pinstress.load_study(file)).pins[0]

print(f"finite elements: {pin.max_von_mises:.0f} ± {pin.error_estimate:.1f} MPa ({pin.verdict})")
for check in pin.hand_checks:
    print(f"{check.method} at {check.at}: {check.demand:.1f} MPa, factor {check.safety_factor:.2f}")
