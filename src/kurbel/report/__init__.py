"""Results as neutral tables: the only place that picks what is shown. `kurbel.render` turns them into text."""
