"""Plots of the loads over a motion or a drop."""
