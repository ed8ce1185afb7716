# shellcheck shell=bash
# For the tests of this folder, which source it. A case runs something, says
# what it expects, and ends with `ok NAME`, which shows $out if that failed.
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
passed=0 failed=0 why="" out="" status=0
# git without anybody's settings.
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
export GIT_AUTHOR_NAME=Me GIT_AUTHOR_EMAIL=me@example.org
export GIT_COMMITTER_NAME=Me GIT_COMMITTER_EMAIL=me@example.org

attempt() { status=0; out=$("$@" 2>&1) || status=$?; }
same()    { [ "$2" = "$3" ] || why+=" $1 is $2, not $3;"; }
expect()  { same status "$status" "$1"; }
says()    { [[ $out == *"$1"* ]] || why+=" does not say '$1';"; }
not_say() { [[ $out != *"$1"* ]] || why+=" says '$1';"; }
ok() {  # NAME
  if [ -z "$why" ]; then
    echo "ok    $1"; passed=$((passed + 1))
  else
    printf 'FAIL  %s:%s\n%s\n' "$1" "$why" "$out"; failed=$((failed + 1))
  fi
  why=""
}
all_passed() { echo "$passed passed, $failed failed"; [ "$failed" = 0 ]; }
