"""Many analyses: sweeps, sizes, weights, probabilities, charts."""
