"""What all models of a pin share: material, loads, linear solver, equilibrium, results."""
