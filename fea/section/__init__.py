"""The stress of sections from section forces."""
