"""Find a first-order lag of the drive beside hysteresis, and tell it from a pure delay."""
