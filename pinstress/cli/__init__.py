"""The command line, and the folders it writes."""
