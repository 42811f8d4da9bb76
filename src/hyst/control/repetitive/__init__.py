"""References that repeat: a memory of a period in front of the inverse, its design and its proof."""
