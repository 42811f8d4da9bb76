"""How far from exact an inverse is: the bound of its error, slopes, inverses of few plays."""
