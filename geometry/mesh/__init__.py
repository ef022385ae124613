"""Meshes of sections and solids by gmsh, and how fine they are where."""
