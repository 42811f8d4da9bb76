"""What a joint estimate knows: least squares over all that was measured, folded."""
