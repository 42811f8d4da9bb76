"""Drivers that are commanded in whole codes: a table between codes and volts."""
