"""Lines, labels and cameras of drawings."""
