#!/usr/bin/env python3
"""The tables of docs/explore_measured.md from results of `rubble batch mission`.

  scenarios/sweeps/mission_table.py FOLDER...    each with a results.jsonl
"""
import collections
import json
import os
import statistics
import sys

# What is wanted of each kind: share that ends by itself, most that get stuck of 48, known (median, worst), share of the
# visible victims, most false ones in 48 runs, median of the contact [s], share at home in time.
GOALS = {
    "yellow": (1.0, 0, 0.999, 0.98, 0.99, 0, 0.5, 0.98),
    "orange": (0.98, 1, 0.98, 0.85, 0.92, 1, 15.0, 0.90),
    "red": (0.98, 1, 0.97, 0.85, 0.90, 1, 10.0, 0.90),
}

BY_ITSELF = ("home", "explored", "lost", "stuck")  # not `time`, nor `fell`


def rows_of(folders):
    kinds = collections.defaultdict(list)
    for folder in folders:
        results = os.path.join(folder, "results.jsonl")
        if not os.path.exists(results):
            sys.exit(f"mission_table.py: {results}: is not there; name the folder that `rubble batch mission --out` wrote, "
                     "of shards the one that `rubble batch merge` made of them")
        with open(results) as lines:
            for line in lines:
                run = json.loads(line)
                kinds[run["config"]].append(run.get("score"))
    return kinds


def at_home(run):
    """Of a result that was written before there was `lost` as well."""
    return run["end_code"] == "home" and run["home_m"] <= 1.0


def value_of(run, key):
    """Of a map that was not aligned nothing counts as known."""
    return 0.0 if key == "known" and run[key] is None else run[key]


def rooms(runs):
    """Empty for results that were written before rooms were counted."""
    if not all("rooms_entered" in run for run in runs):
        return ""
    return f"{sum(run['rooms_entered'] for run in runs)} of {sum(run['rooms_reachable'] for run in runs)}"


def false_of(runs):
    """With the victims that it was sure of on the way and later no more, where they were counted."""
    text = str(sum(run["victims_false"] for run in runs))
    if all("victims_withdrawn" in run for run in runs):
        text += f" ({sum(run['victims_withdrawn'] for run in runs)})"
    return text


def spread(values, digits, worst):
    return f"{statistics.median(values):.{digits}f}, {worst(values):.{digits}f}"


def against_goals(kind, runs):
    """Cells of one row: what was reached, what was wanted, and whether that is met."""
    of = lambda key: [value_of(run, key) for run in runs]
    ends, stuck, median, worst, found, false, contact, home = GOALS[kind]
    count, shown = len(runs), []

    def cell(text, met):
        shown.append(met)
        return text if met else f"**{text}: missed**"

    ended = sum(end in BY_ITSELF for end in of("end_code"))
    at = sum(map(at_home, runs))
    share = sum(of("victims_found")) / sum(of("victims_visible"))
    known = of("known")
    cells = [
        cell(f"{100 * ended / count:.1f} (>= {100 * ends:.0f})", ended >= ends * count),
        cell(f"{of('end_code').count('stuck')} (<= {stuck})", of("end_code").count("stuck") <= stuck * count / 48),
        cell(f"{statistics.median(known):.3f} (>= {median})", statistics.median(known) >= median),
        cell(f"{min(known):.3f} (>= {worst})", min(known) >= worst),
        cell(f"{100 * share:.2f} (>= {100 * found:.0f})", share >= found),
        cell(f"{sum(of('victims_false'))} (<= {false})", sum(of("victims_false")) <= false * count / 48),
        cell(f"{statistics.median(of('contact_s')):.1f} (<= {contact})", statistics.median(of("contact_s")) <= contact),
        cell(f"{100 * at / count:.1f} (>= {100 * home:.0f})", at >= home * count),
    ]
    return cells + ["yes" if all(shown) else "no"]


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    arenas = rows_of(sys.argv[1:])
    kinds = collections.defaultdict(list)
    for name, runs in arenas.items():
        kinds[name.split("-")[0]] += runs
    order = ["yellow", "orange", "red"]
    print("| kind | runs | ends by itself | at home in time | stuck | known, median and worst | victims found of those visible | false (taken back on the way) | "
          "contact s, median and most | trajectory error, aligned, median and worst, m | m2 a minute | score, mean | of its floor can be seen, mean | rooms entered of those that can be |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|")
    for kind in order:
        runs = kinds.get(kind)
        if not runs:
            continue
        if None in runs:
            sys.exit(f"{kind}: {runs.count(None)} runs have no score")
        of = lambda key: [value_of(run, key) for run in runs]
        found, visible = sum(of("victims_found")), sum(of("victims_visible"))
        print(f"| {kind} | {len(runs)} | {sum(end in BY_ITSELF for end in of('end_code'))} | {sum(map(at_home, runs))} | {of('end_code').count('stuck')} | "
              f"{spread(of('known'), 3, min)} | {found} of {visible} ({100 * found / visible:.1f} %) | "
              f"{false_of(runs)} | {spread(of('contact_s'), 1, max)} | {spread(of('ate_aligned_m'), 3, max)} | "
              f"{statistics.mean(of('area_per_min')):.1f} | {statistics.mean(of('score')):.3f} | {statistics.mean(of('visible_share')):.3f} | {rooms(runs)} |")
    print("\n| kind | ends by itself, % (goal) | stuck | known, median | known, worst | victims found of those visible, % | false | "
          "contact s, median | at home in time, % | all met |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for kind in order:
        if kinds.get(kind):
            print(f"| {kind} | " + " | ".join(against_goals(kind, kinds[kind])) + " |")
    print("\n| arenas | runs | known, median and worst | victims found of those visible (false) | contact s, median and most | "
          "trajectory error, median and worst, m |")
    print("|---|---|---|---|---|---|")
    for name, runs in arenas.items():
        kind, size, ramps = name.split("-")
        of = lambda key: [value_of(run, key) for run in runs]
        false = f" ({sum(of('victims_false'))})" if any(of("victims_false")) else ""
        print(f"| {kind} {size.replace('x', ' x ')}, {ramps} | {len(runs)} | {spread(of('known'), 3, min)} | "
              f"{sum(of('victims_found'))} of {sum(of('victims_visible'))}{false} | {spread(of('contact_s'), 1, max)} | "
              f"{spread(of('ate_aligned_m'), 3, max)} |")


main()
