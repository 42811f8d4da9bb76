"""What single values tell, one algorithm a file, on plain vectors."""
