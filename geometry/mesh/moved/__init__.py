"""Meshes of near shapes, with their nodes moved."""
