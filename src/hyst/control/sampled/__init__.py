"""The loop as it runs: sampled, held and late, for every plant within the uncertainty."""
