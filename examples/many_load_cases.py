"""Twenty load cases of an actuator trunnion, from a dict: which one governs?"""

from math import cos, radians, sin

import pinstress

FORCE = {"take-off": 9.0, "climb": 6.5, "gust": 14.2, "approach": 11.0, "go-around": 12.4}  # kN
FLAPS = {0: 0.55, 10: 0.7, 25: 0.9, 40: 1.0}  # angle in degrees: fraction of the force


def case(force: float, angle: float) -> dict[str, object]:
    x, y = force * cos(radians(angle)), force * sin(radians(angle))
    forces = {"rod": [f"{x} kN", f"{y} kN"]}
    return {"kind": "given", "distribution": "uniform", "forces": forces}


STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "yield_strength": "900 MPa"}
PROFILE = [{"length": 30, "diameter": 50}, {"length": 35, "diameter": 25, "connection": "rod"}]
PIN = {"material": "steel", "clamp": ["start"], "fillet": 4, "profile": PROFILE}
study = pinstress.study_from(
    {
        "title": "Trunnion of a flap actuator",
        "units": "mm-N-s",
        "material": {"steel": STEEL},
        "pin": {"trunnion": PIN},
        "case": {
            f"{name} {angle}": case(force * part, angle)
            for name, force in FORCE.items()
            for angle, part in FLAPS.items()
        },
    }
)
results = pinstress.run(study)
rows = sorted(results.pins, key=lambda row: row.safety_factor)
for row in rows:
    print(f"{row.case:12} {row.max_von_mises:6.1f} MPa  factor {row.safety_factor:5.2f}")
print(f"worst of {len(rows)}: {rows[0].case}, factor {rows[0].safety_factor:.2f}")
