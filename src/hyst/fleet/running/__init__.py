"""Where the work of a fleet is done: threads, processes, or a cluster."""
