"""All reports on one page: what decides first, then the sections of the commands."""
