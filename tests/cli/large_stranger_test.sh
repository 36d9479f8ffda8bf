# Large noisy maps of somewhere else are refused in bounded time, and the refusal says why.
. "$(dirname "$0")/lib.sh"

"$rubble" arena generate --cells 7x6 --seed 5 --out . >/dev/null || fail "no arena"
"$rubble" arena generate --cells 14x12 --seed 5 --out large >/dev/null || fail "no large arena"

# Walls of 1 to 5 m, one on each 10 m^2, and 1 % of single cells.
python3 - <<'PY'
import random
for n in (1000, 2000):
    rng = random.Random(7)
    image = bytearray(b"\xff" * (n * n))
    for _ in range(n * n // 4000):
        x, y, length = rng.randrange(n), rng.randrange(n - 1), rng.randrange(20, 100)
        if rng.random() < 0.5:
            end = min(n, x + length)
            for row in (y, y + 1):
                image[row * n + x : row * n + end] = bytes(end - x)
        else:
            for row in range(y, min(n, y + length)):
                image[row * n + x] = 0
    for _ in range(n * n // 100):
        image[rng.randrange(n * n)] = 0
    open("lines%d.pgm" % n, "wb").write(b"P5 %d %d 255\n" % (n, n) + bytes(image))
PY

# refused MAP TRUTH "text in the reason"
refused() {
  timeout 60 "$rubble" score "$1" "$2" --resolution 0.05 >table.txt 2>err.txt || fail "$1 on $2 ended with $?"
  grep -q "^not aligned .*$3" table.txt || fail "$1 on $2: no '$3' in $(cat table.txt err.txt)"
}
refused lines1000.pgm ./*-truth.tif '[a-z]'
refused lines2000.pgm ./*-truth.tif 'times as wide as the truth'
refused lines2000.pgm large/*-truth.tif '[a-z]'
finish
