"""A pin as tetrahedra: for what is no body of revolution, and to check the others."""
