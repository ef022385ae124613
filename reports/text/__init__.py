"""Text for the terminal, and summaries."""
