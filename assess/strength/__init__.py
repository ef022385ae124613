"""Margins of safety: checks by formula, and of the model's stress against strengths."""
