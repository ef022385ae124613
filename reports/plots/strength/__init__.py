"""Plots of safety factors, fatigue and limit load."""
