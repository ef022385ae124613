"""What would make a pin reach its factor of safety, and what its dimensions do to it."""
