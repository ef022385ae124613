"""One plot per file."""
