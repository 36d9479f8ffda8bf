# The table of missions against their goals: what is met by a hair and what is missed by one.
. "$(dirname "$0")/lib.sh"
table=$source/scenarios/sweeps/mission_table.py

# results FOLDER KIND CODE: 48 perfect missions of a kind, changed by Python that sees them as `runs`.
results() {
  mkdir -p "$1"
  python3 - "$2" "$3" >>"$1/results.jsonl" <<'PYTHON'
import json, sys
kind, code = sys.argv[1:]
runs = [dict(end_code="home", home_m=0.2, known=1.0, victims_found=6, victims_visible=6, victims_false=0,
             victims_withdrawn=0, contact_s=0.0, ate_aligned_m=0.01, area_per_min=20.0, score=0.99, visible_share=1.0,
             rooms_entered=5, rooms_reachable=5) for _ in range(48)]
exec(code)
for run in runs:
    print(json.dumps({"config": f"{kind}-8x8-0.3", "score": run}))
PYTHON
}

# goals FOLDER KIND: its row of the table against the goals.
goals() { "$table" "$1" | awk '/ends by itself, % \(goal\)/ {on = 1} on' | grep -m1 "^| $2 |"; }

results good yellow 'for run in runs[:2]: run["victims_found"] = 5'
goals good yellow | grep -q '| 100.0 (>= 100) | 0 (<= 0) | 1.000 (>= 0.999) | 1.000 (>= 0.98) | 99.31 (>= 99) .* yes |$' ||
  fail "good yellow missions: $(goals good yellow)"
results few yellow 'for run in runs[:3]: run["victims_found"] = 5'
goals few yellow | grep -q '| \*\*98.96 (>= 99): missed\*\* .* no |$' || fail "three victims missed: $(goals few yellow)"
results late red 'runs[0].update(end_code="time", home_m=2.6)'
goals late red | grep -q '^| red | \*\*97.9 (>= 98): missed\*\* | .* 97.9 (>= 90) | no |$' || fail "one late: $(goals late red)"
results stuck orange 'runs[0]["end_code"] = runs[1]["end_code"] = "stuck"'
goals stuck orange | grep -q '| \*\*2 (<= 1): missed\*\* .* no |$' || fail "two stuck: $(goals stuck orange)"
results away red 'runs[0]["home_m"] = 1.4; runs[1]["known"] = None; runs[2]["victims_false"] = 2'
goals away red | grep -q '\*\*0.000 (>= 0.85): missed\*\* .* \*\*2 (<= 1): missed\*\* .* 97.9 (>= 90) | no |$' ||
  fail "not at home, not aligned, false: $(goals away red)"
results back orange 'runs[0]["victims_withdrawn"] = 3'
"$table" back | grep -q '^| orange | 48 .* | 0 (3) |' || fail "victims taken back: $("$table" back | head -3)"
expect_exit 1 "nowhere/results.jsonl: is not there" "$table" nowhere
finish
