"""hyst watch: follow an actuator through a file that grows, or through standard input."""
