"""The shape of a pin, with its segments, bands, fillets, cuts, outline and corners."""
