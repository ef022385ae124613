"""Pins with cuts: the harmonic model of the uncut pin, and a solid about each cut."""
