"""What an identification gives back."""
