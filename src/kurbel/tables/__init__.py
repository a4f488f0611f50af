"""From results to tables: the request, the rows, and the parts of a report that every format prints."""
