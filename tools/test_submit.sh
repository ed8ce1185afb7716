#!/usr/bin/env bash
# Test tools/submit.sh against bare repositories in a temporary folder.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
script=${SUBMIT_SCRIPT:-$(cd "$(dirname "$0")" && pwd)/submit.sh}
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0

unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE HW FORCE MAKEFLAGS MAKEOVERRIDES
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1 LC_ALL=C
export GIT_TERMINAL_PROMPT=0 GIT_CEILING_DIRECTORIES=$tmp
export GIT_AUTHOR_NAME=Student GIT_AUTHOR_EMAIL=student@example.org
export GIT_COMMITTER_NAME=Student GIT_COMMITTER_EMAIL=student@example.org

# ---- The scene of a case: work/ with one commit, and origin.git, empty.
scene() {
  rm -rf "${tmp:?}"/*
  git init -q --bare -b main "$tmp/origin.git"
  git init -q -b main "$tmp/work"
  cd "$tmp/work"
  git remote add origin "$tmp/origin.git"
  commit first
}
commit() { echo "$1" >>notes.txt; git add notes.txt; git commit -qm "$1"; }
handed_in() {  # a scene where hw2 has been handed in
  scene
  git tag -a -m hw2 hw2
  git push -q origin main hw2
}
submit() {  # HW, FORCE, and a command for the tests; sets out, status
  status=0
  out=$(HW=$1 FORCE=${2:-} SUBMIT_TEST=${3:-echo the tests run} \
        bash "$script" 2>&1) || status=$?
}
# All references of work/ and of origin.git, to see that nothing changed.
refs() { git for-each-ref; echo; git ls-remote "$tmp/origin.git"; }
local_id()  { git rev-parse -q --verify "$1" || echo none; }
remote_id() { git --git-dir="$tmp/origin.git" rev-parse -q --verify "$1" ||
                echo none; }

# ---- Checks of a case; `ok NAME` ends it.
why=""
expect_status() { [ "$status" = "$1" ] || why+=" status is $status, not $1;"; }
says()    { grep -qF -- "$1" <<<"$out" || why+=" does not say '$1';"; }
not_say() { ! grep -qF -- "$1" <<<"$out" || why+=" says '$1';"; }
same()    { [ "$2" = "$3" ] || why+=" $1: $2, not $3;"; }
unchanged() { [ "$(refs)" = "$1" ] || why+=" references changed;"; }
holds() {  # origin and work/ both hold tag $1, annotated, and main, on HEAD
  local head; head=$(git rev-parse HEAD)
  same "branch on origin" "$(remote_id refs/heads/main)" "$head"
  same "tag on origin" "$(remote_id "refs/tags/$1^{commit}")" "$head"
  same "tag here" "$(local_id "refs/tags/$1")" "$(remote_id "refs/tags/$1")"
  same "kind of tag" "$(git cat-file -t "refs/tags/$1" 2>&1)" tag
  says "origin holds"
  says "branch main  $head"
  says "tag    $1  $head"
  says "Both are this commit: $(git log -1 --format='%h %s')"
}
ok() {
  if [ -z "$why" ]; then
    echo "ok    $1"; passed=$((passed + 1))
  else
    printf 'FAIL  %s:%s\n%s\n' "$1" "$why" "$out"
    failed=$((failed + 1))
  fi
  why=""
}

# ---- Handing in
scene; submit hw2
expect_status 0; says "the tests run"; holds hw2
ok "first submission"

handed_in; before=$(refs); submit hw2 "" false
expect_status 0; says "handed in already as hw2"; unchanged "$before"; holds hw2
ok "the same commit again: says so, changes nothing"

handed_in; before=$(refs); submit hw2 1 false
expect_status 0; says "handed in already as hw2"; unchanged "$before"
ok "the same commit again with FORCE=1"

handed_in; git tag -d hw2 >/dev/null; submit hw2
expect_status 0; says "handed in already as hw2"
ok "the same commit again, the tag only on origin"

scene; git tag hw2; git push -q origin main hw2; before=$(refs); submit hw2
expect_status 0; says "handed in already as hw2"; unchanged "$before"
ok "the same commit again, by a plain tag"

scene; git tag hw2; git push -q origin main hw2; git tag -d hw2 >/dev/null
commit second; before=$(refs); submit hw2
expect_status 1; says "make submit HW=hw2 FORCE=1"; unchanged "$before"
ok "resubmission is refused, a plain tag on origin"

handed_in; commit second; before=$(refs); submit hw2
expect_status 1; says "already: $(git rev-parse HEAD~)"
says "make submit HW=hw2 FORCE=1"; unchanged "$before"; not_say "the tests run"
ok "resubmission is refused"

handed_in; commit second; git tag -d hw2 >/dev/null; before=$(refs); submit hw2
expect_status 1; says "make submit HW=hw2 FORCE=1"; unchanged "$before"
ok "resubmission is refused, the tag only on origin"

scene; git tag hw2; commit second; before=$(refs); submit hw2
expect_status 1; says "make submit HW=hw2 FORCE=1"; unchanged "$before"
ok "resubmission is refused, the tag only here"

handed_in; commit second; before=$(refs); submit hw2 0
expect_status 1; says "make submit HW=hw2 FORCE=1"; unchanged "$before"
ok "FORCE=0 is not FORCE=1"

handed_in; commit second; submit hw2 1
expect_status 0; says "the tests run"; holds hw2
ok "resubmission with FORCE=1"

handed_in; commit second; git tag -d hw2 >/dev/null; submit hw2 1
expect_status 0; holds hw2
ok "resubmission with FORCE=1, the tag only on origin"

handed_in; first=$(git rev-parse HEAD); commit second; submit hw3
expect_status 0; holds hw3
same "hw2 on origin" "$(remote_id 'refs/tags/hw2^{commit}')" "$first"
ok "the next homework leaves the last one alone"

scene; git tag hw2; submit hw2
expect_status 0; holds hw2
ok "a plain tag here on this commit becomes an annotated one"

scene; git push -q origin main; submit hw2
expect_status 0; holds hw2
ok "the branch is on origin already"

scene; git tag -a -m x hw2; git push -q origin hw2; submit hw2
expect_status 0; holds hw2
ok "only the tag is on origin already"

scene; git switch -qc feature; commit second; submit hw2
expect_status 0; says "branch feature  $(git rev-parse HEAD)"
same "main on origin" "$(remote_id refs/heads/main)" none
same "feature" "$(remote_id refs/heads/feature)" "$(git rev-parse HEAD)"
ok "another branch than main"

for name in HEAD main master FETCH_HEAD head Main; do
  scene; before=$(refs); submit "$name" 1
  expect_status 1; says "'$name' names a branch or a commit to git"
  unchanged "$before"; not_say "the tests run"
  ok "a name that git takes for something else: $name"
done

scene; git branch hw2; before=$(refs); submit hw2
expect_status 1; says "'hw2' is the name of a branch"; unchanged "$before"
ok "a branch of the tag's name"

scene; git push -q origin main:hw2; before=$(refs); submit hw2
expect_status 1; says "'hw2' is the name of a branch"; unchanged "$before"
ok "a branch of the tag's name, only on origin"

scene; git config remote.origin.push 'refs/heads/*:refs/heads/elsewhere/*'
git config push.followTags true; git tag -a -m own own; submit hw2
expect_status 0; holds hw2
same "a branch elsewhere" "$(remote_id refs/heads/elsewhere/main)" none
same "a tag of one's own" "$(remote_id refs/tags/own)" none
ok "the branch goes to its own name, and no other tag, whatever is configured"

# ---- Refusing before anything is done
scene; echo more >>notes.txt; before=$(refs); submit hw2
expect_status 1; says " M notes.txt"; says "not committed"; unchanged "$before"
ok "dirty tree: a modified file"

scene; mkdir new; touch new/a.hpp new/b.hpp; before=$(refs)
git config status.showUntrackedFiles no; submit hw2
expect_status 1; says "?? new/a.hpp"; says "?? new/b.hpp"; unchanged "$before"
ok "dirty tree: untracked files"

scene; echo more >>notes.txt; git add notes.txt; before=$(refs); submit hw2
expect_status 1; says "M  notes.txt"; unchanged "$before"
ok "dirty tree: staged, not committed"

scene; echo built >.gitignore; git add .gitignore; git commit -qm ignore
touch built; submit hw2
expect_status 0; holds hw2
ok "an ignored file is no change"

for flag in assume-unchanged skip-worktree; do
  scene; git update-index --$flag notes.txt; echo more >>notes.txt
  before=$(refs); mkdir sub; (cd sub; submit hw2; unchanged "$before"
    echo "$status"; echo "$why$out") >"$tmp/said"
  { read -r status; out=$(cat); } <"$tmp/said"
  expect_status 1; says "notes.txt"; not_say "the tests run"
  says "git update-index --no-$flag FILE"; not_say "references changed"
  git update-index --no-$flag notes.txt
  submit hw2; expect_status 1; says " M notes.txt"
  ok "dirty tree: a changed file that is marked $flag"
done

for change in "git commit -q --allow-empty -m meanwhile" "git switch -qc other" \
  "echo more >>notes.txt" "git switch -q --detach"; do
  scene; submit hw2 "" "$change"
  expect_status 1; says "a commit or a change while the tests ran"
  same "branch on origin" "$(remote_id refs/heads/main)" none
  same "tag here" "$(local_id refs/tags/hw2)" none
  ok "while the tests run: $change"
done

scene; submit hw2 "" "touch leftover"
expect_status 0; holds hw2
ok "a file that the tests leave is no change"

scene; before=$(refs); submit hw2 "" "echo 2 tests failed; false"
expect_status 1; says "2 tests failed"; says "the tests fail"
unchanged "$before"
ok "a failing test"

scene; before=$(refs)
status=0; out=$(HW=hw2 bash "$script" 2>&1) || status=$?
expect_status 1; says "test_nodes"; says "the tests fail"; unchanged "$before"
ok "without SUBMIT_TEST it is make that runs the tests"

for name in "" "hw 2" "-f" "hw..2" "hw2.lock" "a:b" "hw/2" $'hw2\nx'; do
  scene; before=$(refs); submit "$name"
  expect_status 1; says "'$name' is not a tag name"; unchanged "$before"
  ok "not a tag name: '${name//$'\n'/\\n}'"
done

scene; rm -rf .git; submit hw2
expect_status 1; says "not in a git repository"
ok "not in a git repository"

scene; git switch -q --detach; before=$(refs); submit hw2
expect_status 1; says "HEAD is detached"; says "git switch -c NAME"
unchanged "$before"
ok "HEAD is detached"

scene; rm -rf .git; git init -q -b main; git remote add origin "$tmp/origin.git"
before=$(refs); submit hw2
expect_status 1; says "no commit yet"; unchanged "$before"
ok "no commits"

scene; git remote remove origin; before=$(refs); submit hw2
expect_status 1; says "no remote 'origin'"; says "git remote add origin URL"
unchanged "$before"
ok "no remote"

scene; git remote set-url origin "$tmp/nowhere.git"; before=$(refs); submit hw2
expect_status 1; says "origin cannot be read"; says "nowhere.git"
says "Nothing was tagged or pushed"; unchanged "$before"; not_say "the tests run"
ok "origin cannot be reached"

diverge() {  # somebody else pushes to origin's main
  git clone -q "$tmp/origin.git" "$tmp/other"
  (cd "$tmp/other"; commit other; git push -q origin main)
}
handed_in; diverge; commit second; before=$(refs); submit hw3
expect_status 1; says "has commits that are not here"
says "git pull --rebase origin main"; unchanged "$before"
ok "origin has other commits"

handed_in; diverge; commit second; before=$(refs); submit hw2 1
expect_status 1; says "has commits that are not here"; unchanged "$before"
ok "origin has other commits: FORCE=1 never forces the branch"

# ---- Failing in the push: all is put back
hook() {  # origin refuses, by a hook of this name
  printf '#!/bin/sh\necho not today >&2; exit 1\n' >"$tmp/origin.git/hooks/$1"
  chmod +x "$tmp/origin.git/hooks/$1"
}
scene; hook pre-receive; before=$(refs); submit hw2
expect_status 1; says "not today"; says "did not accept the push"
unchanged "$before"
ok "push refused: no tag stays behind"

handed_in; commit second; hook pre-receive; before=$(refs); submit hw2 1
expect_status 1; says "did not accept the push"; unchanged "$before"
ok "push refused with FORCE=1: the old tag is back, here and there"

handed_in; commit second; before=$(refs)
# shellcheck disable=SC2016  # for the hook to expand
printf '#!/bin/sh\ncase $1 in refs/tags/*) exit 1;; esac\n' \
  >"$tmp/origin.git/hooks/update"; chmod +x "$tmp/origin.git/hooks/update"
submit hw2 1
expect_status 1; unchanged "$before"
ok "origin takes the branch but not the tag: neither is pushed"

handed_in; commit second; before=$(refs)
submit hw3 "" "mv '$tmp/origin.git' '$tmp/gone.git'"
[ ! -e "$tmp/gone.git" ] || mv "$tmp/gone.git" "$tmp/origin.git"
expect_status 1; says "did not accept the push"; unchanged "$before"
ok "the network fails after the tests"

handed_in; commit second
submit hw2 1 "git clone -q '$tmp/origin.git' '$tmp/other' && cd '$tmp/other' &&
  git tag -f -am other hw2 2>&1 && git push -qf origin hw2"
expect_status 1; says "did not accept the push"
same "tag here" "$(local_id 'hw2^{commit}')" "$(git rev-parse HEAD~)"
ok "somebody else moves the tag meanwhile: theirs stays"

scene; git config user.useConfigOnly true; before=$(refs)
status=0; out=$(unset GIT_AUTHOR_NAME GIT_AUTHOR_EMAIL GIT_COMMITTER_NAME \
  GIT_COMMITTER_EMAIL; HW=hw2 SUBMIT_TEST=true bash "$script" 2>&1) || status=$?
expect_status 1; says "git could not make the tag"; unchanged "$before"
ok "git does not know who tags"

# ---- The Makefile hands on what it was given: it expands nothing, and no shell
# reads it.
# shellcheck disable=SC2016  # not to be expanded is what is tested
for name in hw3 "x'; touch $tmp/PWNED; '" '$(touch PWNED)' 'x$$HOME' \
  "\$(shell touch $tmp/PWNED)" "\$\$(shell touch $tmp/PWNED)" \
  "\`touch $tmp/PWNED\`" '${eval $(shell touch PWNED)}' "a b" '#' '"'; do
  for way in argument environment; do
    scene; mkdir tools
    printf '#!/bin/sh\nprintf "<%%s> <%%s>" "$HW" "$FORCE"\n' >tools/submit.sh
    chmod +x tools/submit.sh
    given=("HW=$name" "FORCE=$name")
    by=(env "${given[@]}" make)
    [ $way = environment ] || by=(make "${given[@]}")
    status=0
    out=$("${by[@]}" -sI "$root" -f "$root/Makefile" submit 2>&1) || status=$?
    expect_status 0; same "what arrives" "$out" "<$name> <$name>"
    [ ! -e "$tmp/PWNED" ] && [ ! -e PWNED ] || why+=" it was run;"
    ok "make submit by $way: $name"
  done
done
out=$(env -u HW make -sI "$root" -f "$root/Makefile" submit)
same "what arrives" "$out" "<hw2> <>"
ok "make submit without a name is hw2"

echo
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
