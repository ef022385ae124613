"""Reading a study file, and what is wrong with it, by line."""
