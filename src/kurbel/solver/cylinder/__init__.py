"""One cylinder with its mechanism: motion, forces, work and friction."""
