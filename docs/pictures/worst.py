#!/usr/bin/env python3
"""The worst five runs of each kind of `rubble batch mission`, as a line each and as a picture of their maps.

  docs/pictures/worst.py FOLDER [OUT]    OUT: where KIND_worst.png go, beside this file unless told

Badness: a twentieth of the floor unknown, a victim missed or half a minute in contact count as much as each other.
Needs python3-pil.
"""
import json
import os
import sys

from PIL import Image, ImageDraw

SIDE = 560  # of a map [pixels]


def badness(score):
    known = score["known"] or 0.0
    return (1.0 - known) / 0.05 + score["victims_visible"] - score["victims_found"] + score["contact_s"] / 30.0


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    top = sys.argv[1]
    out = sys.argv[2] if len(sys.argv) == 3 else os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(top, "results.jsonl")) as lines:
        runs = [json.loads(line) for line in lines]
    if any(run.get("score") is None for run in runs):
        sys.exit(f"{top}: some runs have no score")
    for kind in ("yellow", "orange", "red"):
        worst = sorted((r for r in runs if r["config"].startswith(kind)), key=lambda r: (-badness(r["score"]), r["seed"]))[:5]
        if not worst:
            continue
        sheet = Image.new("RGB", (SIDE * len(worst), SIDE + 18), "white")
        draw = ImageDraw.Draw(sheet)
        for i, run in enumerate(worst):
            s = run["score"]
            line = f"{run['config']} {run['seed']}: known {s['known'] or 0.0:.3f}, {s['victims_found']} of {s['victims_visible']}, {s['contact_s']:.0f} s"
            print(line)
            picture = Image.open(os.path.join(top, run["folder"], "overlay.png")).convert("RGB")
            picture.thumbnail((SIDE, SIDE))
            sheet.paste(picture, (SIDE * i + (SIDE - picture.width) // 2, 18 + (SIDE - picture.height) // 2))
            draw.text((SIDE * i + 6, 3), line, fill="black")
        sheet.quantize(64).save(os.path.join(out, f"{kind}_worst.png"), optimize=True)


if __name__ == "__main__":
    main()
