"""The paper's estimators: what it compares with, its filter, as printed, and with the true gain."""
