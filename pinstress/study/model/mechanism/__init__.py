"""Linkage of a study's mechanism, its drives and the forces on it."""
