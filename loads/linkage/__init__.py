"""Bodies, joints and drives of a mechanism."""
