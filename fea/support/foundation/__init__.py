"""A beam on elastic foundations, the smallest model of a pin in its lugs."""
