"""Checks JSON reports against their schema.

Usage: validate_reports.py SCHEMA FOLDER    prints how many reports follow the schema; exits with
1 and the first complaint about each file when one does not. The schema itself is checked, too.
"""

import json
import pathlib
import sys

import jsonschema

schema = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
kind = jsonschema.validators.validator_for(schema)
kind.check_schema(schema)
validator = kind(schema)
complaints = []
paths = sorted(pathlib.Path(sys.argv[2]).glob("*.json"))
for path in paths:
    report = json.loads(path.read_text(encoding="utf-8"))
    error = jsonschema.exceptions.best_match(validator.iter_errors(report))
    if error is not None:
        complaints.append(f"{path.name}: {error.json_path}: {error.message[:300]}")
print("\n".join(complaints) if complaints else f"{len(paths)} reports follow the schema")
sys.exit(bool(complaints))
