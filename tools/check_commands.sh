#!/usr/bin/env bash
# Run the commands of a page: tools/check_commands.sh PAGE. In blocks marked sh
# each line has to end with status 0, or with N if "# status N" stands behind
# it. A quotation (lines that begin with >) has to be in what the commands of
# the block before it said; "..." stands for any words. What is built, is built
# in build/check, and run from there. How blanks and lines part words is no
# matter.
set -euo pipefail
cd "$(dirname "$0")/.."

page=$1 passed=0 failed=0
said="" quote="" block=""

check() {  # WHAT ok|FAIL
  case $2 in ok) passed=$((passed + 1)) ;; *) failed=$((failed + 1)) ;; esac
  printf '%-5s %s\n' "$2" "$1"
}
in_check() {  # COMMAND, of a user
  sed -E 's#(^|[ (;|&])\./(cloth|mass_spring|test_|example_)#\1build/check/\2#g
    s#(^|[ (;|&])build/([a-z]+_[a-z_]+)( |$)#\1build/check/\2\3#g
    s#(^|[ (;|&])make #\1make O=build/check/ B=build/check #g' <<<"$1"
}
run() {  # COMMAND
  local want=0 status=0 verdict=ok out
  [[ $1 =~ '# status '([0-9]+) ]] && want=${BASH_REMATCH[1]}
  out=$(env -u DISPLAY -u WAYLAND_DISPLAY bash -c "$(in_check "$1")" 2>&1 \
    </dev/null) || status=$?
  [ "$status" = "$want" ] || { verdict=FAIL; echo "$out"; echo "status $status"; }
  check "$1" "$verdict"
  said+=$(tr -s ' \n' ' ' <<<"$out")
}
look_up() {  # in said, for the quotation
  local part rest=${quote# } verdict=ok
  while [ -n "$rest" ]; do
    part=${rest%%" ... "*}
    [ "$part" = "$rest" ] && rest="" || rest=${rest#*" ... "}
    [[ $said == *"$part"* ]] || { verdict=FAIL; echo "not said: $part"; }
  done
  check "> ${quote# }" "$verdict"
  quote=""
}

while IFS= read -r line; do
  if [[ $line == '>'* ]]; then quote+=" ${line#> }"; continue; fi
  [ -z "$quote" ] || look_up
  case $line in
    '```sh') block=sh said="" ;;
    '```'*) block=$([ -n "$block" ] || echo other) ;;
    'make check' | 'make check-full' | 'make quick') ;;  # what runs this
    *) [ "$block" != sh ] || run "$line" ;;
  esac
done < <(cat "$page"; echo)

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
