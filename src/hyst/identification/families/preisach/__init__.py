"""Preisach models: weights of the cells of a grid, under a prior of smoothness."""
