"""Plots as SVG, small whatever the length of the record."""
