"""Past yield: the load that a pin carries when it flows, and what is left of its shape."""
