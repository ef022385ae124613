"""What depends on the operating system: processes, signals, threads."""
