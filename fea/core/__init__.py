"""The common parts of all models: material, loads, linear solver, equilibrium, results."""
