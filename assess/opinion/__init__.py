"""Second opinions on a solution: beam theory, and CalculiX."""
