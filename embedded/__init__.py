"""Exported models on emulated Cortex-M processors: right numbers, and what they cost."""
