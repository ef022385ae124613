"""Pins from CAD and mesh files, as meshes or as recognised profiles with cuts."""
