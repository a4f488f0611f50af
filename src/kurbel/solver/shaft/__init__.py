"""The crankshaft as a line of throws on bearings, cut free: statics alone, whatever loads it."""
