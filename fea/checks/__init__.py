"""Comparisons with the answers: hand formulas, beam theory, CalculiX."""
