"""Reads llvm-cov's summary and prints a row of docs/fuzzing.md: TARGET INPUTS SOURCE..."""

import json
import sys

target, inputs, *sources = sys.argv[1:]
files = json.load(sys.stdin)["data"][0]["files"]
covered = total = 0
below = []
for source in sources:
    lines = next(f["summary"]["lines"] for f in files if ("/" + f["filename"]).endswith("/" + source))
    covered += lines["covered"]
    total += lines["count"]
    if lines["covered"] < 0.9 * lines["count"]:
        below.append(f"{source} {100 * lines['covered'] / lines['count']:.0f} %")
print(f"| `{target}` | {inputs} | {covered} of {total}: {100 * covered / total:.1f} % | {', '.join(below)} |")
