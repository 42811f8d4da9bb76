"""Commands for one bank of rate-dependent plays: sample by sample, with a look ahead, or whole."""
