"""The page: one part a file."""
