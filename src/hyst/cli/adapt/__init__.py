"""hyst adapt: constants followed along a record, by the estimator that suits the model."""
