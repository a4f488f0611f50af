"""The schema of machine files, made once: that takes a third of a second."""

from __future__ import annotations

from functools import cache

from kurbel.machine_file.schema import json_schema

whole_schema = cache(json_schema)
