"""The joint estimator: weights, radii, offset and maps at once, and the inverse it keeps."""
