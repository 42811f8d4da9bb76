"""Parts that are known before, and creep between them."""
