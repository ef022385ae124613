"""CSV, Parquet and Markdown."""
