"""What of the records an identification uses."""
