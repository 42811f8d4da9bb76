"""What a fit may leave and that has a name: one cause a file."""
