"""Commands about designs."""
