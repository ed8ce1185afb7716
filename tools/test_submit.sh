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
# Hand in, or try to; each is a case.
accepted() {  # NAME HW [FORCE [TESTS]]
  submit "${@:2}"; expect_status 0; holds "$2"; ok "$1"
}
already() {  # NAME HW [FORCE]
  local before; before=$(refs); submit "$2" "${3:-}" false
  expect_status 0; says "handed in already as $2"; unchanged "$before"; ok "$1"
}
refused() {  # NAME MESSAGE HW [FORCE [TESTS]]
  local before; before=$(refs); submit "${@:3}"
  expect_status 1; says "$2"; unchanged "$before"
  [ $# -gt 4 ] || not_say "the tests run"
  ok "$1"
}

scene; accepted "first submission" hw2
handed_in; already "the same commit again" hw2
handed_in; already "the same commit again with FORCE=1" hw2 1
scene; git tag hw2; git push -q origin main hw2
already "the same commit again, by a plain tag" hw2

force="make submit HW=hw2 FORCE=1"
scene; git tag hw2; git push -q origin main hw2; git tag -d hw2 >/dev/null
commit second; refused "resubmission, a plain tag on origin" "$force" hw2
handed_in; commit second
refused "resubmission" "already: $(git rev-parse HEAD~)" hw2
refused "FORCE=0 is not FORCE=1" "$force" hw2 0
git tag -d hw2 >/dev/null
refused "resubmission, the tag only on origin" "$force" hw2
scene; git tag hw2; commit second
refused "resubmission, the tag only here" "$force" hw2

handed_in; commit second; accepted "resubmission with FORCE=1" hw2 1
handed_in; commit second; git tag -d hw2 >/dev/null
accepted "resubmission with FORCE=1, the tag only on origin" hw2 1
handed_in; first=$(git rev-parse HEAD); commit second; submit hw3
expect_status 0; holds hw3
same "hw2 on origin" "$(remote_id 'refs/tags/hw2^{commit}')" "$first"
ok "the next homework leaves the last one alone"
scene; git tag hw2; accepted "a plain tag here becomes an annotated one" hw2
scene; git tag -a -m x hw2; git push -q origin hw2
accepted "only the tag is on origin already" hw2

scene; git switch -qc feature; commit second; submit hw2
expect_status 0; says "branch feature  $(git rev-parse HEAD)"
same "main on origin" "$(remote_id refs/heads/main)" none
same "feature" "$(remote_id refs/heads/feature)" "$(git rev-parse HEAD)"
ok "another branch than main"

for name in HEAD main Main; do
  scene; refused "a name that git takes for something else: $name" \
    "'$name' names a branch or a commit to git" "$name" 1
done
for name in "" "hw 2" "-f" "hw..2" "hw/2" $'hw2\nx'; do
  scene; refused "not a tag name: '${name//$'\n'/\\n}'" \
    "'$name' is not a tag name" "$name"
done
scene; git branch hw2
refused "a branch of the tag's name" "'hw2' is the name of a branch" hw2
scene; git push -q origin main:hw2
refused "that branch only on origin" "'hw2' is the name of a branch" hw2

scene; git config remote.origin.push 'refs/heads/*:refs/heads/elsewhere/*'
git config push.followTags true; git tag -a -m own own; submit hw2
expect_status 0; holds hw2
same "a branch elsewhere" "$(remote_id refs/heads/elsewhere/main)" none
same "a tag of one's own" "$(remote_id refs/tags/own)" none
ok "the branch goes to its own name, and no other tag, whatever is configured"

# ---- Refusing before anything is done
scene; echo more >>notes.txt; refused "a modified file" " M notes.txt" hw2
scene; mkdir new; touch new/a.hpp; git config status.showUntrackedFiles no
refused "an untracked file" "?? new/a.hpp" hw2
scene; echo more >>notes.txt; git add notes.txt
refused "staged, not committed" "M  notes.txt" hw2
scene; echo built >.gitignore; git add .gitignore; git commit -qm ignore
touch built; accepted "an ignored file is no change" hw2
for flag in assume-unchanged skip-worktree; do
  scene; git update-index --$flag notes.txt; echo more >>notes.txt
  refused "a changed file that is marked $flag" \
    "git update-index --no-$flag FILE" hw2
done
for change in "git commit -q --allow-empty -m meanwhile" "git switch -qc other" \
  "echo more >>notes.txt" "git switch -q --detach"; do
  scene; submit hw2 "" "$change"
  expect_status 1; says "a commit or a change while the tests ran"
  same "branch on origin" "$(remote_id refs/heads/main)" none
  same "tag here" "$(local_id refs/tags/hw2)" none
  ok "while the tests run: $change"
done
scene; accepted "a file that the tests leave is no change" hw2 "" "touch leftover"
scene; refused "a failing test" "the tests fail" hw2 "" "echo 2 failed; false"
scene; rm -rf .git; submit hw2
expect_status 1; says "not in a git repository"; ok "not in a git repository"
scene; git switch -q --detach; refused "HEAD is detached" "git switch -c NAME" hw2
scene; rm -rf .git; git init -q -b main; git remote add origin "$tmp/origin.git"
refused "no commits" "no commit yet" hw2
scene; git remote remove origin
refused "no remote" "git remote add origin URL" hw2
scene; git remote set-url origin "$tmp/nowhere.git"
refused "origin cannot be reached" "Nothing was tagged or pushed" hw2

handed_in; git clone -q "$tmp/origin.git" "$tmp/other"
(cd "$tmp/other"; commit other; git push -q origin main)
commit second
refused "origin has other commits" "git pull --rebase origin main" hw3
refused "FORCE=1 never forces the branch" "has commits that are not here" hw2 1

# ---- Failing in the push: all is put back
hook() {  # NAME TEXT: of origin
  printf '#!/bin/sh\n%s\n' "$2" >"$tmp/origin.git/hooks/$1"
  chmod +x "$tmp/origin.git/hooks/$1"
}
scene; hook pre-receive 'echo not today >&2; exit 1'
refused "push refused: no tag stays behind" "not today" hw2 "" true
handed_in; commit second; hook pre-receive 'exit 1'
refused "push refused with FORCE=1: the old tag is back" \
  "did not accept the push" hw2 1 true
# shellcheck disable=SC2016  # for the hook to expand
handed_in; commit second; hook update 'case $1 in refs/tags/*) exit 1;; esac'
refused "origin takes the branch but not the tag: neither is pushed" \
  "did not accept the push" hw2 1 true
handed_in; commit second
submit hw2 1 "git clone -q '$tmp/origin.git' '$tmp/other' && cd '$tmp/other' &&
  git tag -f -am other hw2 2>&1 && git push -qf origin hw2"
expect_status 1; says "did not accept the push"
same "tag here" "$(local_id 'hw2^{commit}')" "$(git rev-parse HEAD~)"
ok "somebody else moves the tag meanwhile: theirs stays"

# ---- The Makefile hands on what it was given: it expands nothing, and no shell
# reads it.
# shellcheck disable=SC2016  # not to be expanded is what is tested
for name in hw3 "x'; touch $tmp/PWNED; '" '$(touch PWNED)' 'x$$HOME' \
  "\$(shell touch $tmp/PWNED)" "\`touch $tmp/PWNED\`" 'a b' '#' '"'; do
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

echo
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
