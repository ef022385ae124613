"""The study: a file, read, validated and checked for implausible values."""
