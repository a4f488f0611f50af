"""Limits and expectations of a machine file, and what `kurbel check` says."""
