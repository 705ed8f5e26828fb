#!/usr/bin/env bash
# check_container.sh PROGRAM: do the packages that packaging/Containerfile installs beside the program have every library that
# it is linked with? (Those that are essential in Debian, such as libc6, are there anyway.) Also that `sh` of Debian can run
# what the file's build step does with scripts/environment.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
program=$1
listed=$(sed -n '/apt-get install/,/rm -rf/p' packaging/Containerfile | tr -s ' \\&' '\n')
failed=0 libraries=0
for library in $(objdump -p "$program" | awk '$1 == "NEEDED" { print $2 }'); do
  path=$(ldd "$program" | awk -v name="$library" '$1 == name { print $3 }')
  [ -n "$path" ] || continue # the loader itself
  file=$(readlink -f "$path") # some packages name it as it was before /lib became /usr/lib
  package=$({ dpkg-query -S "$file" 2>/dev/null || dpkg-query -S "${file#/usr}"; } | head -1 | cut -d: -f1)
  libraries=$((libraries + 1))
  case "$package" in libc6 | libgcc-s1) continue ;; esac
  grep -qx "$package" <<<"$listed" || { echo "packaging/Containerfile does not install $package, which has $library" >&2; failed=1; }
done
[ "$libraries" -gt 5 ] || { echo "$program is linked with $libraries libraries only: is it the program?" >&2; failed=1; }
for package in $(grep -E '^(lib|ca-|proj-)' <<<"$listed"); do
  apt-cache show "$package" >/dev/null 2>&1 || dpkg-query -W "$package" >/dev/null 2>&1 || {
    echo "Debian has no package $package, which packaging/Containerfile installs" >&2
    failed=1
  }
done
sh -c '. scripts/environment.sh && command -v configure_and_build >/dev/null' || { echo "sh can't read scripts/environment.sh" >&2; failed=1; }
exit $failed
