#!/usr/bin/env bash
# Test tools/submit.sh against bare repositories in a temporary folder.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
# shellcheck source=tools/cases.sh
. "$root/tools/cases.sh"

unset HW FORCE MAKEFLAGS MAKEOVERRIDES
export LC_ALL=C GIT_TERMINAL_PROMPT=0 GIT_CEILING_DIRECTORIES=$tmp

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
handed_in() {  # a scene where hw2 has been handed in, and a new commit
  scene
  git tag -a -m hw2 hw2
  git push -q origin main hw2
  commit second
}
submit() {  # HW [FORCE [COMMAND]], which stands for the tests
  attempt env HW="$1" FORCE="${2:-}" SUBMIT_TEST="${3:-echo the tests run}" \
    bash "$root/tools/submit.sh"
}
# All references of work/ and of origin.git, to see that nothing changed.
refs() { git for-each-ref; git ls-remote "$tmp/origin.git"; }
id() { git "${@:2}" rev-parse -q --verify "$1" || echo none; }
on_origin() { id "$1" --git-dir="$tmp/origin.git"; }

# Hand in, or try to; each is a case.
accepted() {  # NAME HW [FORCE [TESTS]]: origin and work/ have the tag, on HEAD
  local head; head=$(git rev-parse HEAD)
  submit "${@:2}"; expect 0
  same "the branch on origin" "$(on_origin refs/heads/main)" "$head"
  same "the tag on origin" "$(on_origin "refs/tags/$2^{commit}")" "$head"
  same "the tag here" "$(id "refs/tags/$2")" "$(on_origin "refs/tags/$2")"
  same "its kind" "$(git cat-file -t "refs/tags/$2" 2>&1)" tag
  says "branch main  $head"$'\n'"  tag    $2  $head"
  says "Both are this commit: $(git log -1 --format='%h %s')"
  ok "$1"
}
refused() {  # NAME MESSAGE HW [FORCE [TESTS]]: and nothing changed
  local before; before=$(refs); submit "${@:3}"
  expect 1; says "$2"; same "all that refers" "$(refs)" "$before"
  [ $# -gt 4 ] || not_say "the tests run"
  ok "$1"
}

# ---- Handing in
scene; accepted "first submission" hw2
before=$(refs); submit hw2 1 false
expect 0; says "handed in already as hw2"; same refs "$(refs)" "$before"
ok "the same commit again"
handed_in; first=$(git rev-parse HEAD~); accepted "the next homework" hw3
same "hw2 on origin" "$(on_origin 'refs/tags/hw2^{commit}')" "$first"
ok "it leaves the last one alone"

force="make submit HW=hw2 FORCE=1"
handed_in; refused "resubmission" "already: $(git rev-parse HEAD~)" hw2
git tag -d hw2 >/dev/null
refused "resubmission, the tag only on origin" "$force" hw2 0
accepted "with FORCE=1" hw2 1
scene; git tag hw2; commit second
refused "resubmission, the tag only here" "$force" hw2
scene; git tag hw2; accepted "a plain tag here becomes an annotated one" hw2

for name in HEAD Main "" "hw 2" -f hw..2 hw/2 $'hw2\nx'; do
  scene; refused "no tag name: '${name//$'\n'/\\n}'" "'$name'" "$name" 1
done
scene; git push -q origin main:hw2
refused "a branch of the tag's name" "'hw2' is the name of a branch" hw2
scene; git config remote.origin.push 'refs/heads/*:refs/heads/elsewhere/*'
git config push.followTags true; git tag -a -m own own
accepted "the branch goes to its own name, whatever is configured" hw2
same "another tag" "$(on_origin refs/tags/own)" none
ok "and no other tag"

# ---- Refusing before anything is done
scene; echo more >>notes.txt; refused "a modified file" " M notes.txt" hw2
git add notes.txt; refused "staged, not committed" "M  notes.txt" hw2
scene; mkdir new; touch new/a.hpp; git config status.showUntrackedFiles no
refused "an untracked file" "?? new/a.hpp" hw2
scene; git update-index --skip-worktree notes.txt; echo more >>notes.txt
refused "a changed file that git ignores" "--no-skip-worktree FILE" hw2
for change in "git commit -q --allow-empty -m meanwhile" \
  "echo more >>notes.txt" "git switch -q --detach"; do
  scene; submit hw2 "" "$change"
  expect 1; says "a commit or a change while the tests ran"
  same "the branch on origin" "$(on_origin refs/heads/main)" none
  same "the tag here" "$(id refs/tags/hw2)" none
  ok "while the tests run: $change"
done
scene; refused "a failing test" "the tests fail" hw2 "" "echo 2 failed; false"
git switch -q --detach; refused "HEAD is detached" "git switch -c NAME" hw2
git switch -q main; git remote set-url origin "$tmp/nowhere.git"
refused "origin cannot be reached" "Nothing was tagged or pushed" hw2
git remote remove origin; refused "no remote" "git remote add origin URL" hw2
rm -rf .git; submit hw2
expect 1; says "not in a git repository"; ok "not in a git repository"
git init -q -b main; refused "no commits" "no commit yet" hw2

handed_in; git clone -q "$tmp/origin.git" "$tmp/other"
(cd "$tmp/other"; commit other; git push -q origin main)
refused "origin has other commits" "git pull --rebase origin main" hw3
refused "FORCE=1 never forces the branch" "has commits that are not here" hw2 1

# ---- Failing in the push: all is put back
handed_in; hook=$tmp/origin.git/hooks/update
# shellcheck disable=SC2016  # for the hook to expand
printf '#!/bin/sh\ncase $1 in refs/tags/*) echo not today; exit 1;; esac' >"$hook"
chmod +x "$hook"; refused "push refused: no tag stays behind" "not today" hw3 "" true
refused "origin takes the branch but not the tag: the old one is back" \
  "did not accept the push" hw2 1 true
handed_in
submit hw2 1 "git clone -q '$tmp/origin.git' '$tmp/other' && cd '$tmp/other' &&
  git tag -f -am other hw2 2>&1 && git push -qf origin hw2"
expect 1; says "did not accept the push"
same "the tag here" "$(id 'hw2^{commit}')" "$(git rev-parse HEAD~)"
ok "somebody else moves the tag meanwhile: theirs stays"

# ---- The Makefile hands on what it was given: no make and no shell reads it.
# shellcheck disable=SC2016  # not to be expanded is what is tested
names=("x'; touch PWNED; '" '$(shell touch PWNED)$$HOME' '`touch PWNED` #"')
scene; mkdir tools
printf '#!/bin/sh\nprintf "<%%s> <%%s>" "$HW" "$FORCE"\n' >tools/submit.sh
chmod +x tools/submit.sh
for name in "${names[@]}"; do
  attempt make -sI "$root" -f "$root/Makefile" submit HW="$name" FORCE="$name"
  expect 0; same "what arrives" "$out" "<$name> <$name>"
  same "what was made" "$(ls)" $'notes.txt\ntools'; ok "make submit: $name"
done
all_passed
