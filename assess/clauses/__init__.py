"""Clauses of codes for pins and their lugs, one file each."""
