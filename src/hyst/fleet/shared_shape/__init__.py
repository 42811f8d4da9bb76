"""What a fleet shares: one shape, and few numbers for each device."""
