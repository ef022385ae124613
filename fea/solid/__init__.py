"""A pin as tetrahedra: for pins that are not bodies of revolution, and to check the others."""
