"""What a number and an array are: each check in one place, with one sentence to refuse by."""
