#!/usr/bin/env bash
# Hand in this commit: tag it, push branch and tag to origin, show what origin
# then holds. All of it happens or none of it.
#   make submit HW=hw2           the first time
#   make submit HW=hw2 FORCE=1   again: moves the tag to this commit
# Environment: HW, FORCE; SUBMIT_TEST is what must pass (for test_submit.sh).
set -euo pipefail

HW=${HW:-}
FORCE=${FORCE:-}
TESTS="make test_nodes test_edges && ./test_nodes && ./test_edges"

refuse() {  # say why, a line an argument
  printf 'submit: '
  printf '%s\n' "$@"
  exit 1
} >&2

# The id that a reference has on origin, from $remote; nothing if it is not
# there. REF^{} is the commit that an annotated tag points to.
on_origin() { awk -v ref="$1" '$2 == ref { print $1 }' <<<"$remote"; }
ask_origin() {
  remote=$(git ls-remote "$url" "$branch_ref" "$tag_ref" "$tag_ref^{}" \
    "refs/heads/$HW") || return 1
  remote_branch=$(on_origin "$branch_ref")
  remote_tag=$(on_origin "$tag_ref")
  remote_commit=$(on_origin "$tag_ref^{}")
  remote_commit=${remote_commit:-$remote_tag}  # a tag without a message
}
show_origin() {
  echo "submit: origin holds"
  echo "  branch $branch  $remote_branch"
  echo "  tag    $HW  $remote_commit"
  [ "$remote_branch$remote_commit" = "$head$head" ] || refuse \
    "but this commit is $head: somebody else pushes there, too. Look at" \
    "origin and run this again."
  echo "Both are this commit: $(git log -1 --format='%h %s' "$head")"
}

# ---- What is handed in, and may it be?
reserved() {  # by git, or the usual name of a branch; whatever the case
  shopt -s nocasematch
  [[ $HW =~ ^(.*_)?head$|^main$|^master$ ]]
}
name='^[A-Za-z0-9][A-Za-z0-9._-]*$'
if ! [[ $HW =~ $name ]] || ! git check-ref-format "refs/tags/$HW"; then
  refuse "'$HW' is not a tag name: letters, digits, '.', '_' and '-', as in" \
    "make submit HW=hw2"
fi
! (reserved) || refuse \
  "'$HW' names a branch or a commit to git, so no tag may: make submit HW=hw2"
[ "$(git rev-parse --is-inside-work-tree)" = true ] || refuse \
  "this folder is not in a git repository (git's reason is above)."
branch_ref=$(git symbolic-ref -q HEAD) || refuse \
  "HEAD is detached: this commit is on no branch, so none can be pushed." \
  "Go to your branch (git switch main), or make one: git switch -c NAME"
branch=${branch_ref#refs/heads/}
tag_ref=refs/tags/$HW
head=$(git rev-parse -q --verify 'HEAD^{commit}') || refuse \
  "there is no commit yet: git add your files, then git commit."
changes=$(git status --porcelain --untracked-files=all)
[ -z "$changes" ] || refuse \
  "these changes are not committed, so they would not be handed in:" \
  "$changes" "Commit them (git add, git commit) or remove them."
# h, S or s: git does not look at such a file.
unseen=$(git ls-files -v --full-name :/ | sed -n 's/^[a-zS] //p')
[ -z "$unseen" ] || refuse \
  "git is told not to look at these files, so what they hold here would not be" \
  "handed in:" "$unseen" "Tell it to look, and run this again:" \
  "git update-index --no-assume-unchanged FILE" \
  "git update-index --no-skip-worktree FILE"
url=$(git remote get-url --push origin) || refuse \
  "there is no remote 'origin' to push to: git remote add origin URL"
ask_origin || refuse \
  "origin cannot be read (git's reason is above): look at the network and" \
  "at: git remote -v. Nothing was tagged or pushed."

if git rev-parse -q --verify "refs/heads/$HW" >/dev/null ||
  [ -n "$(on_origin "refs/heads/$HW")" ]; then
  refuse "'$HW' is the name of a branch, and a tag of that name would be" \
    "mistaken for it: choose another, as in make submit HW=hw2"
fi

if [ "$remote_branch$remote_commit" = "$head$head" ]; then
  echo "submit: this commit is handed in already as $HW; nothing to do."
  show_origin
  exit 0
fi

[ -z "$remote_branch" ] ||
  git merge-base --is-ancestor "$remote_branch" "$head" 2>/dev/null || refuse \
  "branch $branch on origin has commits that are not here. Bring them in" \
  "and run this again: git pull --rebase origin $branch"

# An existing tag stays, unless it names this commit already or may be moved.
local_tag=$(git rev-parse -q --verify "$tag_ref") || local_tag=""
local_commit=$(git rev-parse -q --verify "$tag_ref^{commit}") || local_commit=""
for commit in $remote_commit $local_commit; do
  [ "$commit" = "$head" ] || [ "$FORCE" = 1 ] || refuse \
    "tag $HW is on another commit already: $commit" \
    "To move it to this commit: make submit HW=$HW FORCE=1"
done

bash -c "${SUBMIT_TEST:-$TESTS}" || refuse \
  "the tests fail. Nothing was tagged or pushed."
now="$(git symbolic-ref -q HEAD || true) $(git rev-parse HEAD)"
now+=$(git status --porcelain --untracked-files=no)
[ "$now" = "$branch_ref $head" ] || refuse \
  "there was a commit or a change while the tests ran, so they did not test" \
  "what is here now. Nothing was tagged or pushed; run this again."

# ---- Hand in. Until origin has accepted both, the tag here is put back.
put_back() {
  if [ -n "$local_tag" ]; then
    git update-ref "$tag_ref" "$local_tag"
  else
    git update-ref -d "$tag_ref"
  fi
}
trap put_back EXIT
git tag -a -f -m "$HW" "$HW" "$head" >/dev/null || refuse \
  "git could not make the tag (its reason is above). Nothing was pushed."
# One push that replaces the tag, but only the tag that was seen above. Both
# names of each reference, or remote.origin.push would say where it goes.
git push --quiet --atomic --no-follow-tags \
  --force-with-lease="$tag_ref:$remote_tag" \
  origin "$head:$branch_ref" "$tag_ref:$tag_ref" || refuse \
  "origin did not accept the push (git's reason is above). Nothing was" \
  "handed in; tag $HW here is as it was before. Run this again."
trap - EXIT

ask_origin || refuse "pushed, but origin cannot be read to show it."
show_origin
