"""Linkage, pins, cases and tasks, built from a study."""
