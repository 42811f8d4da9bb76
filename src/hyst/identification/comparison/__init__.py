"""Models of one actuator side by side, on records that none of them has seen."""
