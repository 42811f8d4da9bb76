"""References that repeat: memory of a period before the inverse, design and proof."""
