"""What is declared once: quantities with their symbols, keys of the machine file, units."""
