"""A results folder as a neighbour's: what is in it may be damaged, or meant to mislead."""
