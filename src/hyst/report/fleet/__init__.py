"""The page of a fleet: distributions, loops, the odd ones, and what failed."""
