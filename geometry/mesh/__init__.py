"""Meshes of sections and solids by gmsh, with their element sizes."""
