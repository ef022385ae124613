"""Derivatives of the largest stress with respect to shape, loads and material."""
