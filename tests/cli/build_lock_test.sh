#!/bin/bash
# Two ./rubble at once in a fresh clone, as the two terminals of a first drive: one builds, the other waits and says so.
source "$(dirname "$0")/lib.sh"

mkdir clone tools
cp "$source/rubble" clone/
echo bash >clone/packages.txt
# What stands in for the build: it fails when another one is under way, and takes its time.
cat >tools/cmake <<'SH'
#!/bin/bash
touch build/release/build.ninja
SH
cat >tools/ninja <<'SH'
#!/bin/bash
mkdir build/release/busy || exit 1
sleep 4
printf '#!/bin/bash\necho ran; exec sleep "$1"\n' >build/release/rubble
chmod +x build/release/rubble
rmdir build/release/busy
SH
chmod +x tools/*
export PATH=$work/tools:$PATH

clone/rubble 0 >first.txt 2>first_err.txt &
first=$!
sleep 0.5
clone/rubble 0 >second.txt 2>second_err.txt
[[ $? == 0 && $(cat second.txt) == ran ]] || fail "the second one: $(cat second.txt second_err.txt)"
wait $first
[[ $? == 0 && $(cat first.txt) == ran ]] || fail "the first one: $(cat first.txt first_err.txt)"
[[ $(grep -c "another build is under way: waits" second_err.txt) == 1 ]] || fail "the second one says: $(cat second_err.txt)"
! grep -q waits first_err.txt || fail "the first one says: $(cat first_err.txt)"
# What a first build waits for and how long that takes is told, on a terminal too; later there is nothing to tell.
for one in first second; do
  grep -q "the first one, from nothing, takes some .* minutes" ${one}_err.txt || fail "how long it takes is not told: $(cat ${one}_err.txt)"
done
grep -q "^rubble: building (.*: progress is in $work/clone/build/release/build.log$" first_err.txt || fail "the first one says: $(cat first_err.txt)"
clone/rubble 0 >first.txt 2>first_err.txt
[[ ! -s first_err.txt ]] || fail "a later one says: $(cat first_err.txt)"
rm clone/build/release/rubble
script -qec "clone/rubble 0" /dev/null </dev/null >first.txt 2>&1
grep -q "^rubble: building (.* minutes.*: \[steps done/all\]" first.txt || fail "on a terminal the first one says: $(cat first.txt)"

# What runs holds nobody up.
sed -i 's/^sleep 4/sleep 0/' tools/ninja
clone/rubble 30 >first.txt 2>/dev/null &
first=$!
for _ in $(seq 100); do
  [[ -s first.txt ]] && break
  sleep 0.1
done
timeout 20 clone/rubble 0 >second.txt 2>second_err.txt
[[ $? == 0 ]] && ! grep -q waits second_err.txt || fail "a program that runs holds up the next: $(cat second_err.txt)"
kill $first

# A build that fails without the word "error", as on a full disk: the end of its log, and the exit code of a failure.
rm -f clone/build/release/rubble
cat >tools/ninja <<'SH'
#!/bin/bash
echo "ninja: writing to the disk: No space left on device"
exit 1
SH
clone/rubble 0 >first.txt 2>first_err.txt
code=$?
[[ $code == 4 ]] || fail "a build that failed ends with $code"
grep -q "No space left" first_err.txt && grep -q "the build failed" first_err.txt || fail "a failed build says: $(cat first_err.txt)"

# Interrupted: 130, and no word of a failure.
sed -i 's/^exit 1$/exit 2/' tools/ninja
clone/rubble 0 >first.txt 2>first_err.txt
code=$?
[[ $code == 130 ]] && grep -q "interrupted" first_err.txt && ! grep -q "failed" first_err.txt || fail "an interrupted build ends with $code: $(cat first_err.txt)"
finish
