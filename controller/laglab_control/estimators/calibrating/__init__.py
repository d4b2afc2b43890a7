"""Estimators that learn how the robot differs from its model, besides its pose."""
