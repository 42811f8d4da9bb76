from hyst.jax.primitive import evaluate as evaluate
