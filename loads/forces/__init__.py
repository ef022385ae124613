"""Forces that act on a linkage, and those that its pins and drives must carry in turn."""
