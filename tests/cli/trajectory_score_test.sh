# rubble score on trajectories: ATE, RPE and relations of a run whose errors are known.
. "$(dirname "$0")/lib.sh"
# 41 poses along a straight line, 0.5 m a second; the estimate goes 10 % too far.
python3 - <<'PY'
for name, step in (('truth', 0.5), ('far', 0.55)):
    with open(name + '.tum', 'w') as f:
        for i in range(41): f.write(f'{i}.0 {i * step} 0 0 0 0 0 1\n')
open('run.relations', 'w').write('# from to x y z roll pitch yaw\n0 10 5 0 0 0 0 0\n10 20 5 0 0 0 0 0.1\n0 99 5 0 0 0 0 0\n')
PY
"$rubble" score truth.tum truth.tum --json >same.json || fail "a run against itself"
json_holds same.json "j['ate_matched'] == 41 and j['ate_aligned_m'] < 1e-9 and j['rpe_1m_m'] < 1e-9 and j['relation_m'] < 1e-9"
"$rubble" score far.tum truth.tum --json --out judged >far.json || fail "a run against another"
json_holds far.json "abs(j['rpe_frame_m'] - 0.05) < 1e-9 and abs(j['rpe_1m_m'] - 0.1) < 1e-9 and j['rpe_1m_pairs'] == 19"
json_holds far.json "abs(j['relation_m'] - 0.1) < 1e-9 and j['rpe_frame_deg'] < 1e-9"
cmp -s far.json judged/trajectory.json || fail "--out and --json differ"
"$rubble" score far.tum run.relations --json >relations.json || fail "a run against relations"
json_holds relations.json "j['relations'] == 2 and j['relations_missing'] == 1 and abs(j['relation_m'] - 0.5) < 1e-9"
expect_exit 2 'compared with' "$rubble" score far.tum map.tif
expect_exit 3 'nothing.tum' "$rubble" score nothing.tum truth.tum
printf '100.0 0 0 0 0 0 0 1\n' >later.tum
expect_exit 3 'same clock' "$rubble" score later.tum truth.tum
printf '0 1 2 3\n' >short.relations
expect_exit 3 'short.relations:1:1' "$rubble" score far.tum short.relations

# Relations of another log compare nothing: that is no error of 0.
printf '900001.0 900002.0 1 0 0 0 0 0\n' >other.relations
printf '1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0 1\n3.0 2 0 0 0 0 0 1\n' >way.tum
expect_exit 3 'none of its relations' "$rubble" score way.tum other.relations
finish
