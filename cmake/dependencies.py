#!/usr/bin/env python3
"""Prints the Debian packages that rubble is built from as CycloneDX 1.4, with the versions installed here.

    python3 cmake/dependencies.py > dependencies.cdx.json
"""
import json
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent


def packages(name, scope):
    for line in (TOP / name).read_text().splitlines():
        if line and not line.startswith("#"):
            yield line.strip(), scope


def component(package, scope):
    query = ["dpkg-query", "-W", "-f", "${Version}\t${Architecture}\t${Homepage}", package]
    found = subprocess.run(query, capture_output=True, text=True)
    version, architecture, homepage = (found.stdout.split("\t") + ["", "", ""])[:3]
    entry = {"type": "library", "name": package, "scope": scope}
    if version:
        entry["version"] = version
        entry["purl"] = f"pkg:deb/debian/{package}@{version}?arch={architecture}"
    if homepage:
        entry["externalReferences"] = [{"type": "website", "url": homepage}]
    return entry


def main():
    listed = [*packages("packages.txt", "required"), *packages("packages-test.txt", "excluded")]
    json.dump({"bomFormat": "CycloneDX", "specVersion": "1.4", "version": 1,
               "metadata": {"component": {"type": "application", "name": "rubble"}},
               "components": [component(*one) for one in listed]}, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
