"""Records that do not fit into memory: chosen on a part, fitted to all of it."""
