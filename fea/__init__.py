"""Fea: from a pin's mesh, material and forces to its maximum von Mises stress, error and verdict.

SI units. This room imports geometry and nothing else of ours. Its front door is
`fea.solve.solve.solve_pin`; nothing is imported here, because scikit-fem takes a while.
"""
