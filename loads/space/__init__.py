"""Linkages in space, with rigid bodies, joints of eight kinds, and the wrench in every joint."""
