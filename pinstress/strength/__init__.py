"""Checks of strength of a study's pins."""
