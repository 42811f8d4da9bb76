"""The families of models, one a file; ``hyst.families`` lists them."""
