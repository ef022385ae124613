"""Services that depend on the operating system: processes, signals, threads."""
