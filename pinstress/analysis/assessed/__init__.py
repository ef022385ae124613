"""Checks and limit loads of solved rows."""
