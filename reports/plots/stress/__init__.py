"""Plots of stress along pins and over meshes."""
