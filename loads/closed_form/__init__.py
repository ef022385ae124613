"""Closed forms, which checks and tests compare with."""
