"""Charts of error against time and memory, for every model and mesh."""
