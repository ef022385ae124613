"""Formatting of numbers, words, files and pictures."""
