"""The shape of a pin: segments, bands, fillets, holes and flats; its outline and corners."""
