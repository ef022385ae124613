"""A results folder from elsewhere: its files may be damaged, or made to mislead."""
