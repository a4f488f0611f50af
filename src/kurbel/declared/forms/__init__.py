"""What may stand under a key of the machine file; each form reads and describes itself."""
