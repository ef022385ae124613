"""Description of the methods, for the page and the PDF."""

METHOD_NOTE = (
    "Linkage forces are those of rigid bodies, from the principle of virtual work, at every "
    "instant of a motion. Each pin is linear elastic, of one material, and loaded by tractions on "
    "its bands. The simplest adequate model was used: a stepped beam, a Fourier (harmonic) model "
    "of a body of revolution on its half section, or a tetrahedral solid model. Meshes are refined "
    "until the grid convergence index is within the requested tolerance. All instants are "
    "superposed from unit-load solutions, so the maximum covers the whole motion.",
    "Stress is read on the surface of a pin, except where lugs press at their edges, and in its "
    "sections, by axial force, bending, shear and torsion; the larger governs. Contact has its own "
    "numbers: the strength of each lug's edge, mean bearing pressures, and the largest stress "
    "beneath, farther than a tenth of the diameter from where lugs press.",
    "At a sharp re-entrant corner, the edge of a clamp or of a prescribed load, linear elasticity "
    "predicts unbounded stress (a singularity). Stress is not evaluated within the excluded "
    "distance of a singularity: a tenth of the local diameter, unless the study sets another "
    "value, but no farther than where a fillet, a groove or a hole begins. Not modelled: "
    "plasticity and friction in the pins; for pins without lugs, contact and clearance.",
)
