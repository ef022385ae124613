"""Reading of a study file, and its errors by line."""
