"""A page for exploring the designs of a sweep."""
