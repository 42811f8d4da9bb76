"""C for a target: the stages of a model, the core sources they need, and a project around them."""
