"""What a fit leaves, by name, and how far it can be trusted."""
