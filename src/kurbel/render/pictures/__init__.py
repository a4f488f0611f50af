"""From a neutral picture to a terminal, to SVG, and to PNG or PDF."""
