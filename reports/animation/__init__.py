"""Pages on which a linkage moves."""
