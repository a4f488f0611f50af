"""Forms of the values of keys in the machine file; each form reads and describes its values."""
