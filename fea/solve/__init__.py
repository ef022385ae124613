"""The choice of support and model for a pin, and the refinement of meshes."""
