"""The safety factor of a sheave axle against its diameter."""

import pinstress

AXLE = pinstress.study_from("""
title = "Axle of a sheave between two hangers"
units = "mm-N-s"
material.S355 = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, yield_strength = "335 MPa" }

[pin.axle]
material = "S355"
profile = [
  { length = 20, diameter = 30, connection = "left hanger" },
  { length = 90, diameter = 30 },
  { length = 60, diameter = 30, connection = "sheave" },
  { length = 90, diameter = 30 },
  { length = 20, diameter = 30, connection = "right hanger" },
]

[case.lift]
kind = "given"
distribution = "cosine"
forces = { "left hanger" = [0, 9000], sheave = [0, -18000], "right hanger" = [0, 9000] }
""")


def factor(diameter: int) -> float:
    thick = {f"pin.axle.profile[{i}].diameter": diameter for i in range(1, 6)}
    study = pinstress.changed_study(AXLE, thick)
    return pinstress.run(study)["axle", "lift"].safety_factor


print("diameter  factor")
for diameter in range(30, 71, 10):
    print(f"{diameter:5} mm  {factor(diameter):6.2f}")
