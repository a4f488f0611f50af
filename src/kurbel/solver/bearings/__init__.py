"""What pins and main bearings carry over the cycle, and in which directions."""
