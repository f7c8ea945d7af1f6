"""Validates the HED tags of BIDS data sets: every events.tsv (of long ones, rows all over it) with its sidecar, against the schema
in their description.

Usage: validate_hed.py FOLDERS...; prints the issues, and how many files and annotated rows there were.
"""

import io
import json
import pathlib
import sys

from hed import Sidecar, TabularInput, load_schema_version
from hed.errors import ErrorHandler, get_printable_issue_string

errors = files = annotated = 0
for folder in map(pathlib.Path, sys.argv[1:]):
    schema = load_schema_version(json.loads((folder / "dataset_description.json").read_text())["HEDVersion"])
    for table in sorted(folder.rglob("*_events.tsv")):
        # hedtools takes every key for a column, and stops at texts such as TaskName.
        keys = json.loads(table.with_suffix(".json").read_text())
        sidecar = Sidecar(io.StringIO(json.dumps({k: v for k, v in keys.items() if isinstance(v, dict)})), name=table.name)
        header, *rows = table.read_text().splitlines(keepends=True)
        rows = rows[:: 1 + len(rows) // 60]  # all categories are in the sidecar; rows combine them
        events = TabularInput(io.StringIO(header + "".join(rows)), sidecar=sidecar, name=table.name)
        issues = events.validate(schema, name=table.name, error_handler=ErrorHandler(check_for_warnings=False))
        files += 1
        annotated += sum(1 for row in events.series_a if row)
        issues = [i for i in issues if i.get("severity", 1) == 1]
        errors += len(issues)
        if issues:
            print(get_printable_issue_string(issues[:20], str(table)))
print(f"{files} files, {annotated} annotated rows, {errors} errors")
sys.exit(1 if errors or not annotated else 0)
