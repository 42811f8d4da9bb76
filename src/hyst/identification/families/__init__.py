"""The families of models, one a file: a file that is here is known to ``hyst.families``."""
