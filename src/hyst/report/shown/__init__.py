"""What records, models, results and comparisons show when they are asked to, in notebooks too."""
