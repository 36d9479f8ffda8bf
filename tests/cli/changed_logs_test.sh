# bench/changed_logs.py: each variant of a log differs from it as it says, and in nothing else.
. "$(dirname "$0")/lib.sh"
change() { python3 "$source/bench/changed_logs.py" "$@" >out.txt 2>err.txt || fail "changed_logs.py $* ended with $?: $(tail -1 err.txt)"; }

# A corrected log: ODOM goes on by the same step, from the pose of the scan before where that repeats it.
cat >laws.py <<'PYTHON'
import math
import random
import sys

BEAMS, SCANS, STEP = 180, 21, (0.1, 0.01, 0.05)


def compose(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], math.remainder(a[2] + b[2], 2 * math.pi)


def write(path):
    draw, pose = random.Random(5), (2.0, 1.0, 0.3)
    with open(path, "w") as out:
        print("PARAM robot_frontlaser_offset 0.1 nohost 0", file=out)
        print("ODOM", *pose, "0 0 0 1 host 1", file=out)
        for scan in range(SCANS):
            for part in (1, 2):
                pose = compose(pose, STEP)
                print("ODOM", *pose, f"0.2 0.1 0 {2 * scan + part + 1} host {2 * scan + part + 1}", file=out)
            pose = compose(pose, (draw.uniform(-0.1, 0.1), 0.02, 0.03))  # corrected
            ranges = [81.83 if draw.random() < 0.1 else round(draw.uniform(0.5, 12), 2) for _ in range(BEAMS)]
            print("FLASER", BEAMS, *ranges, *pose, *pose, f"{2 * scan + 3} host {2 * scan + 3}", file=out)
            print("ODOM", *pose, "0 0 0 0 host 0", file=out)


def read(path):
    lines = [line.split() for line in open(path)]
    scans = [tuple(map(float, line[2:6] + line[9:-15])) for line in lines if line[0] == "ROBOTLASER1"]
    return scans, [tuple(map(float, line[1:4])) for line in lines if line[0] == "ODOM"]


def check(folder):
    def law(holds, text):
        holds or print("not true:", text)

    (all_, odometry), (cut, _), (mixed, _) = (read(f"{folder}/{name}.log") for name in ("unchanged", "cut", "random"))
    raw = (0.0, 0.0, 0.0)
    for pose in odometry[1:]:
        raw = compose(raw, STEP)
        law(math.dist(pose, raw) < 1e-9, "the odometry is composed of its increments")
    law(len(odometry) == 2 * SCANS + 1, "lines that repeat the pose of a scan are dropped")
    even, odd = (open(f"{folder}/{name}.log").read().splitlines() for name in ("even", "odd"))
    unchanged = open(f"{folder}/unchanged.log").read().splitlines()
    scans_of = lambda lines: [line for line in lines if line.startswith("ROBOTLASER1")]
    law(scans_of(unchanged)[0::2] == scans_of(even) and scans_of(unchanged)[1::2] == scans_of(odd), "even and odd hold all scans")
    law([line for line in even if line[:4] == "ODOM"] == [line for line in unchanged if line[:4] == "ODOM"],
        "the odometry of scans that are left out stays")
    mirrored, mirrored_odometry = read(f"{folder}/mirrored.log")
    law(all(a[4:] == b[:3:-1] for a, b in zip(all_, mirrored)), "mirrored beams are those of the log from the other end")
    law(all(abs(b[0] + a[0] + (BEAMS - 1) * a[2]) < 1e-8 for a, b in zip(all_, mirrored)), "the first beam is the mirrored last one")
    law(all((x, -y, -h) == pose for (x, y, h), pose in zip(odometry, mirrored_odometry)), "y and heading are negated")
    farthest = max(r for scan in all_ for r in scan[4:] if r < 30)
    for was, now in zip(all_, mixed):
        changed = [b for a, b in zip(was[4:], now[4:]) if a != b]
        law(was[:4] == now[:4] and BEAMS // 10 - 1 <= len(changed) <= BEAMS // 10, f"a tenth of the beams is random ({len(changed)})")
        law(all(0 <= r <= farthest for r in changed), "random ranges lie within the scanner's")
    for was, now in zip(all_, cut):
        law(now[3] == 4 and max(now[4:]) <= 4, "a cut scan holds nothing beyond")
        law(all(a == b for a, b in zip(was[4:], now[4:]) if a < 4), "what is nearer stays")


write(sys.argv[2]) if sys.argv[1] == "write" else check(sys.argv[2])
PYTHON
python3 laws.py write corrected.log
printf '3 7 1 2 0 0.1 0.2 0.3\n3 5 1 2 0 0 0 0.5\n' >some.relations
change corrected.log v --relations some.relations
laws=$(python3 laws.py check v 2>&1) || true
[[ -z $laws ]] || fail "$(sort <<<"$laws" | uniq -c)"
change v/mirrored.log twice
cmp -s v/unchanged.log twice/mirrored.log || fail "mirrored twice is another log"
[[ $(cat v/mirrored.relations) == $'3 7 1 -2.0 0 -0.1 0.2 -0.3\n3 5 1 -2.0 0 -0.0 0 -0.5' ]] || fail "relations are not mirrored"
[[ $(cat v/even.relations) == '3 7 1 2 0 0.1 0.2 0.3' && ! -s v/odd.relations ]] || fail "relations of scans that are left out"
change corrected.log again --seed 1
change corrected.log other --seed 2
cmp -s v/random.log again/random.log || fail "the same seed draws other ranges"
cmp -s v/random.log other/random.log && fail "another seed draws the same ranges"
for name in unchanged mirrored; do
  "$rubble" map v/$name.log --out map-$name >/dev/null || fail "$name.log cannot be mapped"
  json_holds map-$name/score.json "j['scans'] == 21 and j['ate_matched'] == 21"
done
python3 - <<'PYTHON' || fail "the reference is not mirrored"
plain, mirrored = ([list(map(float, line.split())) for line in open(f"map-{name}/truth.tum")] for name in ("unchanged", "mirrored"))
raise SystemExit(any(abs(a[1] - b[1]) + abs(a[2] + b[2]) > 1e-5 for a, b in zip(plain, mirrored)) or len(plain) != len(mirrored))
PYTHON

# Our own log keeps every byte that is not changed, and a mirrored sweep runs the other way.
small_scenario s.yaml
"$rubble" run s.yaml --out run --set time_limit_s=12 --set explorer.return_home=false >/dev/null || fail "run ended with $?"
change run/log.rlog own --range 2
scans=$(sed -n 's/^own.unchanged.rlog: \([0-9]*\) scans$/\1/p' out.txt)
cmp -s run/log.rlog own/unchanged.rlog || fail "an own log that is not changed is another one"
change own/mirrored.rlog own-twice
cmp -s run/log.rlog own-twice/mirrored.rlog || fail "an own log mirrored twice is another one"
for name in mirrored even; do
  "$rubble" map own/$name.rlog --out own-$name >/dev/null || fail "$name.rlog cannot be mapped"
done
json_holds own-even/score.json "j['scans'] == ($scans + 1) // 2 > 10"
"$rubble" score own-mirrored/estimate.tum own/mirrored.tum --json >score.json || fail "mirrored.tum cannot be compared"
json_holds score.json "j['ate_aligned_m'] < 0.02"
printf 'FLASER 3 1 1\n' >torn.log
python3 "$source/bench/changed_logs.py" torn.log torn 2>err.txt && fail "a torn line is read"
grep -q 'line 1: is no whole FLASER line' err.txt || fail "does not name the torn line: $(tail -1 err.txt)"
finish
