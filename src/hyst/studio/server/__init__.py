"""The server: one address, one token, this machine only."""
