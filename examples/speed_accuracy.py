"""Error and time of the beam and of every mesh of a run."""

import pinstress

study = pinstress.load_study(pinstress.shipped_studies()["one_pin"])
beam = pinstress.run(study, model="beam").pins[0]
finest = pinstress.run(study, model="harmonic", tolerance=0.0005).pins[0]
reference = finest.max_von_mises

print(f"reference {reference:.2f} psi, known to {finest.error_estimate / reference:.2%}")
print("model     unknowns  time [ms]    error")
for model, meshes in (("beam", beam.history), ("harmonic", finest.history)):
    for mesh in meshes:
        error = mesh.max_von_mises / reference - 1.0
        print(f"{model:8} {mesh.dofs:9,} {1000 * mesh.seconds:10.0f} {error:+8.3%}")
