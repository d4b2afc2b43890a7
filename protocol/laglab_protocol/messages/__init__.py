"""Messages as records that cannot be changed, and how their fields lie on the wire."""
