"""The command `size`: by scaling, or to the least weight."""
