"""The command line and the folders that it writes."""
