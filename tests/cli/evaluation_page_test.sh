# Scoring at a given pose, and the page whose live figures must be those of the program.
. "$(dirname "$0")/lib.sh"
"$rubble" arena generate --cells 5x4 --seed 4 --out a >/dev/null || fail "no arena"
"$rubble" arena generate --cells 5x4 --seed 5 --resolution 0.03 --out b >/dev/null || fail "no second arena"
map=$(echo b/*truth.tif) truth=$(echo a/*truth.tif)
expect_exit 2 '--pose 1,2' "$rubble" score "$truth" "$truth" --pose 1,2
expect_exit 2 '--pose 1,2,x' "$rubble" score "$truth" "$truth" --pose 1,2,x
expect_exit 2 '0.1 to 10' "$rubble" score "$truth" "$truth" --pose 1,2,3,0
expect_exit 2 '--pose goes without --align and --start' "$rubble" score "$truth" "$truth" --pose=0,0,0 --align walls
expect_exit 2 '--pose goes without --align and --start' "$rubble" score "$truth" "$truth" --pose=0,0,0 --start=0,0,0
expect_exit 2 'truth is required' "$rubble" score "$truth"
"$rubble" score "$truth" "$truth" --pose=0,0,0 --json >same.json || fail "a map at its own pose"
json_holds same.json "j['score'] == 1 and j['psi_m'] == 0 and j['known'] == 1"
"$rubble" score "$truth" "$truth" --pose=0.3,0,0 --json >moved.json || fail "a moved map"
json_holds moved.json "0 < j['overlap'] < 1 and j['score'] < 0.5 and j['psi_m'] > 0"
"$rubble" score "$truth" "$truth" --pose=0.1,0,0 --json >near.json || fail "a map moved a little"
json_holds near.json "0.5 < j['score'] < 1 and j['psi_m'] > 0"
"$rubble" score "$truth" "$truth" --html same.html >/dev/null 2>&1 || fail "no page"
sed 's/src="data:image[^"]*"//g' same.html | grep -qE "(src|href)=|https?://|import |fetch\(" && fail "the page needs other files"
[[ $(grep -o 'src="data:image/png;base64,' same.html | wc -l) == 3 ]] && grep -q '<b>1.000</b>' same.html ||
  fail "the page lacks the score or the pictures of the pose and of lines of sight at start"
# Of a refused map: not trusted and why, score 0, the score at the best pose.
"$rubble" score "$map" "$truth" --html refused.html --json >refused.json 2>/dev/null || fail "no page of another arena"
json_holds refused.json "not j['aligned'] and j['align_note'].startswith('not aligned: ') and 'probably another arena' in j['align_note']"
python3 - <<'PY' || fail "the page of a refused map begins otherwise"
import json
page, j = open('refused.html').read(), json.load(open('refused.json'))
first, second = page.index('<b>0.000</b> <span>score</span>'), page.index('<b>%.3f</b> <span>score there</span>' % j['score_at_best_pose'])
assert page.index('id="warning"') < first < second < page.index('id="figure-overlap"')
assert '"warning":"%s"' % j['align_note'].removeprefix('not aligned: ') in page
PY
mkdir 'two words' && cp "$truth" "two words/it's.tif"
"$rubble" score "two words/it's.tif" "$truth" --html words.html >/dev/null 2>&1 || fail "a name of two words"
grep -qF "rubble score 'two words/it'\\u005c''s.tif' a/" words.html || fail "the command is not quoted: $(grep -o 'command":"[^"]*' words.html)"
printf 'name,x,y\nv,1,1\n' >'my victims.csv'
"$rubble" score "$truth" "$truth" --pois 'my victims.csv' --victims 'my victims.csv' --html listed.html >/dev/null 2>&1 ||
  fail "a page with lists of victims"
grep -qF -- "--pois 'my victims.csv' --victims 'my victims.csv'" listed.html ||
  fail "the command gives other victims than the page: $(grep -o 'command":"[^"]*' listed.html)"
expect_exit 4 '/proc/page.html' "$rubble" score "$truth" "$truth" --html /proc/page.html
((failures == 0)) || finish

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
[[ -n $browser ]] || { echo "no chromium here: the page itself was not tried"; exit 77; }
# dom PAGE#HASH: the page as the browser has it after its script ran.
dom() {
  timeout 120 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" \
    --virtual-time-budget=10000 --dump-dom "file://$work/$1" 2>/dev/null
}
"$rubble" score "$map" "$truth" --pose=0,0,0 --html page.html --json >/dev/null 2>&1 || fail "no page of two maps"
dom page.html >dom.html
if ! grep -q 'data-ready' dom.html; then
  grep -q 'figures' dom.html || { echo "the browser does not run here"; exit 77; }
  fail "the page's script did not finish"
fi
for pose in 0,0,0 0.31,-0.22,4.5 -0.7,1.1,-170 1.5,2.5,91,1.25 0.1,0.2,33,0.8 40,0,0; do
  "$rubble" score "$map" "$truth" --pose=$pose --json >cpp.json
  dom "page.html#pose=$pose" >dom.html
  python3 - "$pose" <<'PY' || fail "page and program differ at $pose"
import json, re, sys
cpp = json.load(open('cpp.json'))
page = dict(re.findall(r'id="figure-(\w+)" data-value="([^"]*)"', open('dom.html').read()))
assert len(page) == 8, page
for key, value in page.items():
    if abs(float(value) - cpp[key]) > 1e-5: sys.exit(f'{key}: page {value}, program {cpp[key]}')
PY
done

# Keys and mouse change the pose as the page says. A headless browser draws no frames, so a timer stands in for them.
sed 's|<head>|<head><script>requestAnimationFrame = (f) => setTimeout(f, 10); cancelAnimationFrame = clearTimeout;</script>|
s|</body>|<script>{\
const view = document.getElementById("view"), box = view.getBoundingClientRect();\
const at = (dx, dy, more) => ({clientX: box.left + box.width / 2 + dx, clientY: box.top + box.height / 2 + dy, pointerId: 1, bubbles: true, ...more});\
view.setPointerCapture = () => {};\
const key = (k, more) => dispatchEvent(Object.assign(new KeyboardEvent("keydown", {key: k, ...more})));\
const note = () => new Promise((done) => setTimeout(() => done(["x", "y", "deg", "s"].map((i) => document.getElementById(i).value).join(",")), 400));\
(async () => {\
const out = [];\
document.body.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowRight", shiftKey: true, bubbles: true})); out.push(await note());\
document.body.dispatchEvent(new KeyboardEvent("keydown", {key: "r", bubbles: true})); out.push(await note());\
view.dispatchEvent(new PointerEvent("pointerdown", at(0, 0))); view.dispatchEvent(new PointerEvent("pointermove", at(0, -80))); view.dispatchEvent(new PointerEvent("pointerup", at(0, -80))); out.push(await note());\
document.getElementById("start").click(); out.push(await note());\
view.dispatchEvent(new WheelEvent("wheel", at(0, 0, {deltaY: -1000, ctrlKey: true, cancelable: true}))); out.push(await note());\
document.getElementById("turn").value = 10; document.getElementById("turn").dispatchEvent(new Event("input")); out.push(await note());\
const end = document.createElement("pre"); end.id = "log"; end.textContent = out.join(" ; "); document.body.append(end);\
})(); }</script></body>|' page.html >driven.html
dom driven.html | grep -oP '(?<=<pre id="log">)[^<]*' >log.txt
python3 - <<'PY' || fail "mouse and keys do not do what the page says: $(cat log.txt)"
steps = [tuple(float(v) for v in s.split(',')) for s in open('log.txt').read().split(';')]
arrow, reset, drag, start, wheel, turn = steps
assert arrow == (0.5, 0, 0, 1), arrow
assert reset == (0, 0, 0, 1) == start, reset
assert drag[0] == 0 and drag[1] > 0.1 and drag[2:] == (0, 1), drag
assert abs(wheel[3] - 1.2214) < 1e-3 and wheel[2] == 0, wheel
assert turn[2] == 10 and abs(turn[3] - 1.2214) < 1e-3, turn
PY
finish
