# Sourced by the other scripts, from the root of the project: the environment in which everything is built.
export NODE_PATH=/usr/share/nodejs # Debian's Emscripten looks for its JavaScript modules here
[ -x build/tools/node/bin/node ] && export PATH="$PWD/build/tools/node/bin:$PATH"
# Objects that were compiled before are taken from the cache, also by a build in a new folder.
export CCACHE_BASEDIR="$PWD" CCACHE_NOHASHDIR=1
command -v ccache >/dev/null && export EM_COMPILER_WRAPPER=ccache # what Emscripten's driver calls; the driver itself is a script that the cache can't see through
jobs=$(nproc)

# configure_and_build PRESET [TARGET...]: quiet when there is nothing to do.
configure_and_build() {
  local preset=$1 launcher=ccache
  shift
  [ "$preset" = wasm ] && launcher=
  mkdir -p build
  [ -e "build/$preset/build.ninja" ] || cmake --preset "$preset" -DCMAKE_CXX_COMPILER_LAUNCHER=$launcher \
    >"build/$preset.configure.log" 2>&1 || {
    cat "build/$preset.configure.log" >&2
    return 1
  }
  ninja -C "build/$preset" -j "$jobs" --quiet "$@"
}
