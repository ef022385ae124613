"""Tables, one per file."""
