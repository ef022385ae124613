"""The shape of a pin: its segments, bands, fillets, cuts, outline and corners."""
