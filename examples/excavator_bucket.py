"""A digging excavator: the maximum force at every joint, and the bucket pin."""

import pinstress

study = pinstress.load_study(pinstress.shipped_studies()["excavator"])
results = pinstress.run(study, pins=["K"], cases=["dig"])
table = results.reactions[0]

print("largest forces while digging")
for peak in table.largest:
    print(f"  {peak.connection:3} {peak.force / 1000:6.1f} kN at {peak.time:5.2f} s")

foot = [table.connections.index(name) for name in ("O", "P")]
x, y, _ = table.forces[0, foot].sum(axis=0) / 1000
print(f"the arm loads its machine at the start with {x:.2f} kN forward, {-y:.2f} kN down")

for cylinder in results.drive:
    print(f"{cylinder.name:15} pushes or pulls with up to {cylinder.largest / 1000:.1f} kN")

pin = results.pins[0]
print(f"pin K: {pin.max_von_mises / 1e6:.1f} MPa at {pin.time:.2f} s, {pin.verdict}")
print(f"pin K: factor {pin.safety_factor:.2f}, required {results.required_safety_factor:g}")
