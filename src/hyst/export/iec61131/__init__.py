"""Export as structured text of IEC 61131-3, translated from the C of the same block."""
