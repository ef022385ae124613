"""Strict reading of the user's files, which are tables in regular files."""
