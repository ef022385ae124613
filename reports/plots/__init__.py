"""Plots, one per file."""
