"""What richer models leave, to judge a fit by."""
