"""How results are found, for the page and the PDF."""

METHOD = (
    "Linkage forces are those of rigid bodies, from the principle of virtual work, at every "
    "instant of a motion. Each pin is linear elastic, of one material, and loaded by tractions on "
    "its bands. The simplest adequate model was used: a stepped beam, a Fourier (harmonic) model "
    "of a body of revolution on its half section, or a tetrahedral solid model. Meshes are refined "
    "until the grid convergence index is within the requested tolerance. All instants are "
    "superposed from unit-load solutions, so the maximum covers the whole motion.",
    "At a sharp re-entrant corner or the edge of a clamp, linear elasticity predicts unbounded "
    "stress (a singularity). Stress is not evaluated within the excluded distance of a "
    "singularity: a tenth of the local diameter, unless the study sets another value. Where lugs "
    "press on a pin, its stress is that of its free surface and of its sections under axial force, "
    "bending, shear and torsion; what lies beneath the contact decides with it, and pressure at "
    "the edges of lugs is reported separately. Not modelled: plasticity and friction in the pins; "
    "for pins without lugs, contact and clearance.",
)
