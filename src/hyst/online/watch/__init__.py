"""Watching an actuator: samples as they come, gaps and all, through an estimator into alarms."""
