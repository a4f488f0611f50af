"""Pictures as data: curves of results, the machine in section, constructions of the books."""
