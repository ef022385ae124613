"""Assess: what an engineer signs, from the stress of a pin.

Strength by hand and by clause, fatigue, limit load, derivatives of a maximum, and second opinions
by other programs. SI units. Imports `fea`, `geometry` and `pinbase`.
"""
