"""Error against time and memory, for every model and mesh."""
