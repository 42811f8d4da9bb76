"""Hammerstein identification: hysteresis followed by linear dynamics."""
