"""Many designs of one machine: sweeps over keys of its file, their key values and uncertainties, and inputs sought."""
