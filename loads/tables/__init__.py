"""Files of the user, read strictly: CSV tables, and nothing but regular files."""
