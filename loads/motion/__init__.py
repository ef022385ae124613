"""Positions, velocities, accelerations and mobility of a linkage."""
