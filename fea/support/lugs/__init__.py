"""The surroundings of a pin: eyes, their fit, their links, and the rings into which bands are
cut.
"""
