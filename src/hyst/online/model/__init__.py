"""Estimation of all constants of any model from derivatives of its kernel."""
