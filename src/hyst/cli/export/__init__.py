"""hyst export: a model as code for other tools; one file a target."""
