"""Predictions of the program compared with measured, printed and exact numbers:
docs/evidence.md.
"""
