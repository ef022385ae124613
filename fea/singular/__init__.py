"""Stress singularities: where they are, how strong by theory, and as measured."""
