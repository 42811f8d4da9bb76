"""The loop that people use: its margins, a designed controller, feedforward, a comparison."""
