"""Stress and displacement of a pin for ParaView, and the same mesh in Python."""

from pathlib import Path

import pinstress

results = pinstress.run(pinstress.load_study(pinstress.shipped_studies()["one_pin"]))
mesh = results.to_pyvista("B", "landing")
file = Path("pin_B.vtu")  # into the current folder
mesh.save(file)

print(f"{file}: {mesh.n_points} points, {mesh.n_cells} cells of the surface")
for name, values in mesh.point_data.items():
    print(f"  {name}: {values.min():.4g} to {values.max():.4g}")

name = f"von Mises [{results.units.stress}]"
stress = mesh.point_data[name]
x, y, z = mesh.points[stress.argmax()]
print(f"largest von Mises stress at x = {x:.2f}, y = {y:.2f}, z = {z:.2f} {results.units.length}")

hot = mesh.threshold(0.8 * stress.max(), scalars=name)
print(f"{hot.area:.2f} of {mesh.area:.2f} square inches bear more than 80 % of it")
