"""Each measurement where it belongs: the past is gone through again, or kept as one motion."""
