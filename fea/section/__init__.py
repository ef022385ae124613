"""Stress of sections by their section forces."""
