"""Fields for ParaView, and pictures of them."""
