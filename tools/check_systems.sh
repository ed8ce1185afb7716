#!/usr/bin/env bash
# Type a new user's commands on bare systems: tools/check_systems.sh [SYSTEM...]
# Makes a root of each by debootstrap in $ROOTS, by default build/roots, and
# runs there as a new user with sudo. Prints a table of commands and seconds;
# the logs are $ROOTS/SYSTEM.N.log. Needs root, network and 15 minutes; what it
# can't have is skipped. The mirror is that of this system's apt.
set -euo pipefail
cd "$(dirname "$0")/.."
roots=${ROOTS:-build/roots}
[ $# != 0 ] || set -- bookworm trixie noble
skip() { echo "skipped: $1"; exit 0; }
[ "$(id -u)" = 0 ] || skip "bare systems: only root can make them"
command -v debootstrap >/dev/null ||
  skip "bare systems: apt-get install debootstrap"
mkdir -p "$roots"

# Each command as it is typed, after those above it.
commands=(
  "make demo"
  "make web-deps web"
  "make grade DIR=."
  "make starter OUT=../starter"
  "cd ../starter && make deps"
  "cd ../starter && make run STAGE=problem1"
  "cd ../starter && make test SECTION=3.1"
  "make deps && make test_nodes test_edges && ./test_nodes && ./test_edges"
  "make cloth"
  "./cloth --config data/scenes/curtain.toml --headless --t-end 0.1"
  "make python-deps && python3 -m venv --system-site-packages build/venv"
  "build/venv/bin/pip install --no-build-isolation ."
  "cd /tmp && ~/mass_spring/build/venv/bin/python -m mypy.stubtest mass_spring"
)
# The log's words, beside status 0.
expected() {
  case $1 in
    *grade*) grep -q '100/100' ;;
    *test\ SECTION*) grep -q 'FAILED' ;;  # there is no code yet
    *) ! grep -i 'warning:' ;;
  esac
}

in_root() {  # ROOT COMMAND...
  # shellcheck disable=SC2016  # for the inner shell
  unshare --mount bash -c 'mount --bind /proc "$1/proc"
    mount --rbind /dev "$1/dev"; exec chroot "$@"' - "$@"
}
make_root() {  # SYSTEM ROOT
  local mirror script="" keys=()
  mirror=$(apt-get indextargets --format '$(SITE)' | sort -u |
    grep "/$(case $1 in noble) echo ubuntu ;; *) echo debian ;; esac)/\?$" |
    head -n 1 || true)
  if [ "$1" = noble ]; then
    # Older debootstraps do not know it; the keys are a package of Debian, too.
    [ -e /usr/share/debootstrap/scripts/noble ] || script=gutsy
    keys=(/usr/share/keyrings/ubuntu-archive-keyring.gpg)
    [ -e "${keys[0]}" ] || {
      in_root "$roots/trixie" apt-get install -qq ubuntu-keyring
      keys=("$roots/trixie/${keys[0]}")
    }
    keys=("--components=main,universe" --keyring="${keys[0]}")
  fi
  debootstrap --variant=minbase "${keys[@]}" "$1" "$2" "$mirror" $script &&
    in_root "$2" sh -ec 'useradd -m -s /bin/bash student
      echo "127.0.0.1 localhost $(hostname)" >/etc/hosts
      apt-get update
      apt-get install -y --no-install-recommends sudo git make ca-certificates
      echo "student ALL=NOPASSWD: ALL" >/etc/sudoers.d/student'
}

failed=0 table="| system | command | result |"$'\n'"|---|---|---|"
for system; do
  root=$roots/$system number=0
  rm -rf "$root"
  make_root "$system" "$root" >"$root.log" 2>&1 ||
    { echo "skipped: $system: its archive does not answer ($root.log)"; continue; }
  home=$root/home/student/mass_spring
  mkdir -p "$home"
  git archive HEAD | tar x -C "$home"
  in_root "$root" chown -R student: /home/student
  for command in "${commands[@]}"; do
    number=$((number + 1)) from=$SECONDS log=$root.$number.log result=ok
    status=0
    in_root "$root" su - student -c "cd mass_spring && $command" \
      >"$log" 2>&1 </dev/null || status=$?
    case $command in *test\ SECTION*) [ $status != 2 ] || status=0 ;; esac
    [ $status = 0 ] && expected "$command" <"$log" >/dev/null ||
      { result="FAILED: $log"; failed=$((failed + 1)); tail -n 20 "$log"; }
    echo "$system: $command: $result, $((SECONDS - from)) s"
    table+=$'\n'"| $system | \`$command\` | $result, $((SECONDS - from)) s |"
  done
done
echo "$table"
[ "$failed" = 0 ]
