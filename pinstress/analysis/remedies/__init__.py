"""Remedies by which a pin reaches its factor of safety, and the sensitivities of that factor."""
