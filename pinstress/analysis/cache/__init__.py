"""Answers and drawings of earlier runs, found by what they depend on."""
