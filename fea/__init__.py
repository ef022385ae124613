"""Fea: from a pin's mesh, material and forces to its maximum von Mises stress, error and verdict.

All quantities are in SI units. This package imports geometry and pinbase and nothing else of ours.
Its entry point is `fea.solve.solve.solve_pin`. Nothing is imported here, because importing
scikit-fem takes a while.
"""
