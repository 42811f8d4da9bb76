"""The start of a fit: dynamics behind plays, and what is settled behind them."""
