"""Fit free parameters to records: the problem, its solution, and linear steps."""
