#!/usr/bin/env bash
# Installs what building and testing need and this machine lacks: Debian packages (with sudo if not root), and
# a Node.js that is new enough for the page's build (from npm, under build/tools, if Debian's is too old).
# Idempotent; does nothing and takes well under a second when everything is there.
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
  g++ cmake ninja-build ccache pkg-config clang-format git ca-certificates
  libboost1.81-dev libssl-dev openssl prometheus-cpp-dev libzstd-dev nlohmann-json3-dev libcli11-dev libfmt-dev libspdlog-dev libtbb-dev
  libproj-dev proj-data libgeotiff-dev libpugixml-dev libpng-dev libwebp-dev libegl-dev libgles-dev libegl1 libgles2 libgl1-mesa-dri
  catch2 emscripten chromium zstd
)
# The fuzzers are built with clang; scripts/fuzz.sh asks for them.
[ "${1:-}" = --with-fuzzing ] && packages+=(clang libclang-rt-14-dev)
# scripts/bench_server.sh compares with nginx.
[ "${1:-}" = --with-server-bench ] && packages+=(wrk nginx openssl)
# scripts/test_firefox.sh and scripts/test_webkit.sh run the page in other browsers.
[ "${1:-}" = --with-firefox ] && packages+=(firefox-esr xvfb xauth)
[ "${1:-}" = --with-webkit ] && packages+=(webkit2gtk-driver xvfb xauth)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
# Node.js may come from elsewhere than Debian; only its absence asks for Debian's.
command -v node >/dev/null || missing+=(nodejs)
command -v npm >/dev/null || missing+=(npm)

if [ ${#missing[@]} -gt 0 ]; then
  echo "installing: ${missing[*]}"
  as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || {
      echo "these packages are missing and neither root nor sudo is at hand: ${missing[*]}" >&2
      exit 1
    }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    "${missing[@]}" >/dev/null
fi

# Vite needs Node.js 20.19 or later; Debian 12 has 18. scripts/environment.sh puts the newer one first.
node_is_new_enough() {
  "$1" -e 'const [a, b] = process.versions.node.split(".").map(Number);
           process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)' 2>/dev/null
}
if ! node_is_new_enough node && ! node_is_new_enough build/tools/node/bin/node; then
  version=22.12.0
  case "$(uname -m)" in
    x86_64) architecture=x64 ;;
    aarch64) architecture=arm64 ;;
    *) echo "no Node.js $version for $(uname -m); install Node.js 20.19 or later" >&2; exit 1 ;;
  esac
  echo "installing Node.js $version under build/tools"
  mkdir -p build/tools && rm -rf build/tools/node build/tools/package
  (cd build/tools && npm pack --loglevel=error "node-linux-$architecture@$version" >/dev/null &&
    tar xzf "node-linux-$architecture-$version.tgz" && mv package node && rm -f ./*.tgz && chmod +x node/bin/node)
fi
