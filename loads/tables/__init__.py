"""Strict reading of the user's files: CSV tables, and only regular files."""
