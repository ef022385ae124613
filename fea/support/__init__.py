"""The supports of a pin: clamps with prescribed loads, contact with lugs, elastic foundations."""
