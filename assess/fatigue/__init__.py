"""Fatigue: stress histories at critical points, cycles, damage."""
