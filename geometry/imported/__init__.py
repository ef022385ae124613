"""Pins from CAD and mesh files."""
