"""A pin as a body of revolution: its section with Fourier terms about the axis."""
