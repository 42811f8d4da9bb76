"""Scale and offset of any model's output, estimated while the system runs."""
