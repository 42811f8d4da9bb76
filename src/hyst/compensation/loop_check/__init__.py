"""The loop behind the dynamics: seen through their inverse, and whether it depends on the rate."""
