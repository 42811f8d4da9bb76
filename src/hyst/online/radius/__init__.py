"""Radii of plays of known weights: the paper's law, and least squares on the same regression."""
