"""Predictions of the program beside measured, printed and exact numbers: docs/evidence.md."""
