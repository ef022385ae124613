"""Results of mechanisms: forces, drives, motion, drops; cases one after the other."""
