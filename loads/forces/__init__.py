"""Forces on a linkage that are known from its motion: constant, tabulated, springs and dampers."""
