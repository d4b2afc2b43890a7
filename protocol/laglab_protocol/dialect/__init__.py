"""The dialect: its XML, the code generated from it, and what looks after both."""
