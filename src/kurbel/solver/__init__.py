"""From a machine to its results, in SI: numpy, no files, no printing."""
